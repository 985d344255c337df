#: 2.0 0.2 0 | - 0 0
#: prints Stopping

import time

import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node


class Careful(Node):
    def __init__(self):
        super().__init__("careful")
        self.pub = self.create_publisher(Twist, "cmd_vel", 10)

    def run(self):
        msg = Twist()
        msg.linear.x = 0.2
        for _ in range(20):
            self.pub.publish(msg)
            time.sleep(0.1)


def main():
    rclpy.init()
    node = Careful()
    try:
        node.run()
    except KeyboardInterrupt:
        node.get_logger().info("Interrupted")
    finally:
        node.get_logger().info("Stopping")
        node.pub.publish(Twist())
        node.destroy_node()
        if rclpy.ok():
            rclpy.shutdown()


if __name__ == "__main__":
    main()
