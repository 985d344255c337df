#: 6.0 0 0.5 | - 0 0

import time

import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node


class CarRotation(Node):
    def __init__(self):
        super().__init__("car_rotation")
        self.publisher_ = self.create_publisher(Twist, "/cmd_vel", 10)

    def rotate(self):
        twist = Twist()
        twist.linear.x = 0.0
        twist.angular.z = 0.5
        start_time = time.time()
        while time.time() - start_time < 6.0:
            self.publisher_.publish(twist)
            time.sleep(0.1)
        twist.angular.z = 0.0
        self.publisher_.publish(twist)


def main(args=None):
    rclpy.init(args=args)
    node = CarRotation()
    node.rotate()
    node.destroy_node()
    rclpy.shutdown()


if __name__ == "__main__":
    main()
