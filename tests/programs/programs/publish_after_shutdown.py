#: - 0.1 0
#: raises rclpy._rclpy_pybind11.RCLError

import time

import rclpy
from geometry_msgs.msg import Twist

rclpy.init()
node = rclpy.create_node("too_late")
pub = node.create_publisher(Twist, "cmd_vel", 10)
msg = Twist()
msg.linear.x = 0.1
pub.publish(msg)
time.sleep(1.0)
rclpy.shutdown()
pub.publish(Twist())
