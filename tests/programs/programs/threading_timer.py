#: 2.0 0.2 0 | - 0 0

import threading

import rclpy
from geometry_msgs.msg import Twist

rclpy.init()
node = rclpy.create_node("timed")
pub = node.create_publisher(Twist, "cmd_vel", 10)
stopped = threading.Event()


def stop():
    pub.publish(Twist())
    stopped.set()


msg = Twist()
msg.linear.x = 0.2
pub.publish(msg)
threading.Timer(2.0, stop).start()
stopped.wait()
rclpy.shutdown()
