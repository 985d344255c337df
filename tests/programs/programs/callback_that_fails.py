#: - 0.2 0
#: raises KeyError 'speed'
#: finds program_never_stops

import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node


class Failing(Node):
    def __init__(self):
        super().__init__("failing")
        self.pub = self.create_publisher(Twist, "cmd_vel", 10)
        msg = Twist()
        msg.linear.x = 0.2
        self.pub.publish(msg)
        self.settings = {}
        self.create_timer(1.0, self.tick)

    def tick(self):
        msg = Twist()
        msg.linear.x = self.settings["speed"]
        self.pub.publish(msg)


rclpy.init()
rclpy.spin(Failing())
