#: 0.7 0.1 0 | 0.7 0.2 0 | - 0 0

import time

import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node


class Slow(Node):
    """Its callback takes longer than its period: ticks are missed, and the later ones stay on the grid."""

    def __init__(self):
        super().__init__("slow")
        self.pub = self.create_publisher(Twist, "cmd_vel", 10)
        self.speeds = [0.1, 0.2, 0.0]
        self.create_timer(0.5, self.tick)

    def tick(self):
        msg = Twist()
        msg.linear.x = self.speeds.pop(0)
        self.pub.publish(msg)
        if not self.speeds:
            rclpy.shutdown()
        time.sleep(0.7)


rclpy.init()
rclpy.spin(Slow())
