#: -
#: raises RuntimeError

import rclpy

rclpy.init()
rclpy.init()
