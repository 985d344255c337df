#: -
#: raises TypeError create_publisher() missing 1 required positional argument: 'qos_profile'

import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node


class NoQos(Node):
    def __init__(self):
        super().__init__("no_qos")
        self.pub = self.create_publisher(Twist, "cmd_vel")


rclpy.init()
NoQos()
