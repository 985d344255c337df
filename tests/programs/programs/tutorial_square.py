#: 3 0.2 0 | 2 0 1.0 | 3 0.2 0 | 2 0 1.0 | 3 0.2 0 | 2 0 1.0 | 3 0.2 0 | 2 0 1.0 | - 0 0
#: lasts 21

import time

import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node


class SquareMove(Node):
    def __init__(self):
        super().__init__("square_move")
        self.pub = self.create_publisher(Twist, "/cmd_vel", 10)
        self.twist = Twist()

    def move(self):
        for _ in range(4):
            self.twist.linear.x = 0.2
            self.twist.angular.z = 0.0
            self.pub.publish(self.twist)
            time.sleep(3)
            self.twist.linear.x = 0.0
            self.twist.angular.z = 1.0
            self.pub.publish(self.twist)
            time.sleep(2)
        self.twist.linear.x = 0.0
        self.twist.angular.z = 0.0
        self.pub.publish(self.twist)
        time.sleep(1)


def main(args=None):
    rclpy.init(args=args)
    square_move = SquareMove()
    square_move.move()
    square_move.destroy_node()
    rclpy.shutdown()


if __name__ == "__main__":
    main()
