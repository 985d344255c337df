#: 2.0 0.1 0 | - 0 0

import time

import rclpy
from geometry_msgs.msg import Twist
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup, ReentrantCallbackGroup
from rclpy.executors import MultiThreadedExecutor
from rclpy.node import Node


class Parallel(Node):
    def __init__(self):
        super().__init__("parallel")
        self.pub = self.create_publisher(Twist, "cmd_vel", 10)
        self.driving = True
        self.create_timer(0.05, self.drive, callback_group=ReentrantCallbackGroup())
        self.slow = self.create_timer(0.05, self.work, callback_group=MutuallyExclusiveCallbackGroup())

    def drive(self):
        if self.driving:
            msg = Twist()
            msg.linear.x = 0.1
            self.pub.publish(msg)

    def work(self):
        self.slow.cancel()
        time.sleep(2.0)
        self.driving = False
        self.pub.publish(Twist())
        rclpy.shutdown()


def main():
    rclpy.init()
    node = Parallel()
    executor = MultiThreadedExecutor(num_threads=3)
    executor.add_node(node)
    try:
        executor.spin()
    finally:
        executor.shutdown()
        node.destroy_node()


if __name__ == "__main__":
    main()
