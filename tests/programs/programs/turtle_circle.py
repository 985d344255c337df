#: -
#: ends horizon
#: finds program_other_topic

import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node


class TurtleCircle(Node):
    def __init__(self):
        super().__init__("turtle_circle")
        self.publisher_ = self.create_publisher(Twist, "/turtle1/cmd_vel", 10)
        self.timer = self.create_timer(0.5, self.move)

    def move(self):
        msg = Twist()
        msg.linear.x = 2.0
        msg.angular.z = 1.0
        self.publisher_.publish(msg)


def main(args=None):
    rclpy.init(args=args)
    rclpy.spin(TurtleCircle())


if __name__ == "__main__":
    main()
