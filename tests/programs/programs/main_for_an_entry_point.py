#: 1.0 0.2 0 | - 0 0
#: box

import time

import rclpy
from geometry_msgs.msg import Twist


def main(args=None):
    rclpy.init(args=args)
    node = rclpy.create_node("entry")
    pub = node.create_publisher(Twist, "cmd_vel", 10)
    msg = Twist()
    msg.linear.x = 0.2
    pub.publish(msg)
    time.sleep(1.0)
    pub.publish(Twist())
    rclpy.shutdown()
