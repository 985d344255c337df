#: -
#: raises rclpy.exceptions.NotInitializedException rclpy.init() has not been called.

import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node


class Forgetful(Node):
    def __init__(self):
        super().__init__("forgetful")
        self.pub = self.create_publisher(Twist, "cmd_vel", 10)


node = Forgetful()
rclpy.spin(node)
