#: 2.0 0.1 0 | - 0 0

import rclpy
from geometry_msgs.msg import Twist
from rclpy.duration import Duration
from rclpy.node import Node


class Busy(Node):
    def __init__(self):
        super().__init__("busy")
        self.pub = self.create_publisher(Twist, "cmd_vel", 10)

    def drive(self, seconds):
        msg = Twist()
        msg.linear.x = 0.1
        end = self.get_clock().now() + Duration(seconds=seconds)
        while rclpy.ok() and self.get_clock().now() < end:
            self.pub.publish(msg)
        self.pub.publish(Twist())


rclpy.init()
Busy().drive(2.0)
rclpy.shutdown()
