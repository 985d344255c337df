#: -
#: raises rclpy.exceptions.InvalidNodeNameException

import rclpy

rclpy.init()
rclpy.create_node("my-robot")
