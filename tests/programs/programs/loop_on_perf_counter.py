#: 1.0 0.2 0 | 1.0 0.1 0 | - 0 0

from time import perf_counter, sleep

import rclpy
from geometry_msgs.msg import Twist

rclpy.init()
node = rclpy.create_node("stepwise")
pub = node.create_publisher(Twist, "cmd_vel", 10)
began = perf_counter()
msg = Twist()
while (elapsed := perf_counter() - began) < 2.0:
    msg.linear.x = 0.2 if elapsed < 1.0 else 0.1
    pub.publish(msg)
    sleep(0.05)
msg.linear.x = 0.0
pub.publish(msg)
rclpy.shutdown()
