#: 1.0 0.1 0 | - 0 0

import time

import rclpy
from geometry_msgs.msg import Twist

rclpy.init()
node = rclpy.create_node("leaver")
pub = node.create_publisher(Twist, "cmd_vel", 10)
msg = Twist()
msg.linear.x = 0.1
pub.publish(msg)
time.sleep(1)
pub.publish(Twist())
