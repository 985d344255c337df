#: 6.0 0 0.5 | - 0 0
#: ends exit

import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node


class Rotate(Node):
    def __init__(self):
        super().__init__("rotate")
        self.publisher = self.create_publisher(Twist, "cmd_vel", 10)
        self.timer = self.create_timer(0.1, self.timer_callback)
        self.start_time = None

    def timer_callback(self):
        now = self.get_clock().now()
        if self.start_time is None:
            self.start_time = now
        elapsed = (now - self.start_time).nanoseconds / 1e9
        msg = Twist()
        if elapsed < 6.0:
            msg.angular.z = 0.5
            self.publisher.publish(msg)
        else:
            self.publisher.publish(msg)
            self.get_logger().info("Rotation finished")
            raise SystemExit


def main():
    rclpy.init()
    node = Rotate()
    try:
        rclpy.spin(node)
    finally:
        node.destroy_node()
        rclpy.shutdown()


if __name__ == "__main__":
    main()
