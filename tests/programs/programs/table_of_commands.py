#: 1.0 0.2 0 | 0.5 0 0.5 | 1.0 0.2 0 | 0.5 0 -0.5 | - 0 0
#: prints zigzag 0

import time
from dataclasses import dataclass
from typing import List

import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node


@dataclass
class Step:
    seconds: float
    x: float = 0.0
    z: float = 0.0


class Zigzag(Node):
    def __init__(self, steps: List[Step]) -> None:
        super().__init__("zigzag")
        self._publisher = self.create_publisher(Twist, "cmd_vel", 10)
        self._steps = steps

    def run(self) -> None:
        for number, step in enumerate(self._steps):
            self.get_logger().info(f"zigzag {number}", once=True)
            msg = Twist()
            msg.linear.x = step.x
            msg.angular.z = step.z
            until = self.get_clock().now().nanoseconds + int(step.seconds * 1e9)
            while self.get_clock().now().nanoseconds < until:
                self._publisher.publish(msg)
                rclpy.spin_once(self, timeout_sec=0.02)
        self._publisher.publish(Twist())


rclpy.init()
node = Zigzag([Step(1.0, x=0.2), Step(0.5, z=0.5), Step(1.0, x=0.2), Step(0.5, z=-0.5)])
node.run()
node.destroy_node()
rclpy.shutdown()
