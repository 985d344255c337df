#: at 0 0.4 0

import time

import rclpy
from geometry_msgs.msg import Twist

rclpy.init()
node = rclpy.create_node("crab")
pub = node.create_publisher(Twist, "cmd_vel", 10)
msg = Twist()
msg.linear.y = 0.2
pub.publish(msg)
time.sleep(2)
pub.publish(Twist())
rclpy.shutdown()
