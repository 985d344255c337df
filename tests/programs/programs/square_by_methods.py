#: 5 0.2 0 | 3.14159 0 0.5 | 5 0.2 0 | 3.14159 0 0.5 | 5 0.2 0 | 3.14159 0 0.5 | 5 0.2 0 | 3.14159 0 0.5 | - 0 0

import math
import time

import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node

LINEAR_SPEED = 0.2
ANGULAR_SPEED = 0.5


class SquareDriver(Node):
    def __init__(self):
        super().__init__("square_driver")
        self.cmd_pub = self.create_publisher(Twist, "/cmd_vel", 10)

    def publish_for(self, linear, angular, duration):
        msg = Twist()
        msg.linear.x = linear
        msg.angular.z = angular
        end = time.monotonic() + duration
        while time.monotonic() < end:
            self.cmd_pub.publish(msg)
            time.sleep(0.05)

    def forward(self, distance):
        self.publish_for(LINEAR_SPEED, 0.0, distance / LINEAR_SPEED)

    def turn(self, angle):
        self.publish_for(0.0, ANGULAR_SPEED, angle / ANGULAR_SPEED)

    def stop(self):
        self.cmd_pub.publish(Twist())


def main(args=None):
    rclpy.init(args=args)
    driver = SquareDriver()
    for side in range(4):
        driver.get_logger().info(f"Side {side + 1}")
        driver.forward(1.0)
        driver.turn(math.pi / 2)
    driver.stop()
    driver.destroy_node()
    rclpy.shutdown()


if __name__ == "__main__":
    main()
