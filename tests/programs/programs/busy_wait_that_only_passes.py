#: 1.5 -0.1 0 | - 0 0

import time

import rclpy
from geometry_msgs.msg import Twist

rclpy.init()
node = rclpy.create_node("back")
pub = node.create_publisher(Twist, "cmd_vel", 10)
back = Twist()
back.linear.x = -0.1
pub.publish(back)
until = time.monotonic() + 1.5
while time.monotonic() < until:
    pass
pub.publish(Twist())
