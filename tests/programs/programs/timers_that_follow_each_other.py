#: 1.5 0.1 0 | 1.0 0 -0.4 | - 0 0
#: ends exit

import sys

import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node


class Sequence(Node):
    def __init__(self):
        super().__init__("sequence")
        self.pub = self.create_publisher(Twist, "cmd_vel", 10)
        self.send(0.1, 0.0)
        self.timer = self.create_timer(1.5, self.turn)

    def send(self, x, z):
        t = Twist()
        t.linear.x = x
        t.angular.z = z
        self.pub.publish(t)

    def turn(self):
        self.timer.cancel()
        self.send(0.0, -0.4)
        self.timer = self.create_timer(1.0, self.stop)

    def stop(self):
        self.timer.cancel()
        self.send(0.0, 0.0)
        sys.exit(0)


def main():
    rclpy.init()
    rclpy.spin(Sequence())


if __name__ == "__main__":
    main()
