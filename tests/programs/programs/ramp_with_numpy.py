#: 0.5 0.05 0 | 0.5 0.1 0 | 0.5 0.15 0 | 0.5 0.2 0 | - 0 0

import time

import numpy as np
import rclpy
from geometry_msgs.msg import Twist

rclpy.init()
node = rclpy.create_node("ramp")
pub = node.create_publisher(Twist, "cmd_vel", 10)
for speed in np.linspace(0.05, 0.2, 4):
    msg = Twist()
    msg.linear.x = float(np.round(speed, 3))
    pub.publish(msg)
    time.sleep(0.5)
pub.publish(Twist())
rclpy.shutdown()
