#: -
#: raises AttributeError

import rclpy
from rclpy.node import Node


class Shadow(Node):
    def __init__(self):
        super().__init__("shadow")
        self.publishers = []


rclpy.init()
Shadow()
