#: 2.0 0.1 0 | - 0 0

import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node


class Mover(Node):
    def __init__(self):
        super().__init__("mover")
        self.pub = self.create_publisher(Twist, "/cmd_vel", 10)
        self.count = 0
        self.done = False
        self.create_timer(0.1, self.tick)

    def tick(self):
        msg = Twist()
        if self.count < 20:
            msg.linear.x = 0.1
        else:
            self.done = True
        self.pub.publish(msg)
        self.count += 1


def main():
    rclpy.init()
    node = Mover()
    while rclpy.ok() and not node.done:
        rclpy.spin_once(node)
    node.destroy_node()
    rclpy.shutdown()


main()
