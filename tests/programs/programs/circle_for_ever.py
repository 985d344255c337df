#: - 0.2 0.5
#: ends horizon
#: finds program_endless

import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node


class Circle(Node):
    def __init__(self):
        super().__init__("circle")
        self.pub = self.create_publisher(Twist, "/cmd_vel", 10)
        self.create_timer(0.1, self.publish)

    def publish(self):
        msg = Twist()
        msg.linear.x = 0.2
        msg.angular.z = 0.5
        self.pub.publish(msg)


def main():
    rclpy.init()
    node = Circle()
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        pass
    node.destroy_node()
    rclpy.shutdown()


if __name__ == "__main__":
    main()
