#: 6.2832 0.3 1.0 | 6.2832 0.3 -1.0 | - 0 0

import math
import time

import rclpy
from geometry_msgs.msg import Twist, Vector3

rclpy.init()
node = rclpy.create_node("eight")
pub = node.create_publisher(Twist, "cmd_vel", 10)
for sign in (1.0, -1.0):
    pub.publish(Twist(linear=Vector3(x=0.3), angular=Vector3(z=sign)))
    time.sleep(2 * math.pi)
pub.publish(Twist())
