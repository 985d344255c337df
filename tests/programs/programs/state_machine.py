#: 2.0 0.2 0 | 1.5 0 0.8 | 2.0 0.2 0 | - 0 0

from enum import Enum, auto

import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node


class State(Enum):
    FORWARD = auto()
    TURN = auto()
    AGAIN = auto()
    STOP = auto()


PLAN = {
    State.FORWARD: (2.0, 0.2, 0.0, State.TURN),
    State.TURN: (1.5, 0.0, 0.8, State.AGAIN),
    State.AGAIN: (2.0, 0.2, 0.0, State.STOP),
}


class Machine(Node):
    def __init__(self):
        super().__init__("machine")
        self.pub = self.create_publisher(Twist, "cmd_vel", 10)
        self.state = State.FORWARD
        self.entered = self.get_clock().now()
        self.timer = self.create_timer(0.05, self.step)

    def step(self):
        if self.state is State.STOP:
            self.pub.publish(Twist())
            self.timer.cancel()
            rclpy.shutdown()
            return
        duration, x, z, following = PLAN[self.state]
        msg = Twist()
        msg.linear.x, msg.angular.z = x, z
        self.pub.publish(msg)
        if (self.get_clock().now() - self.entered).nanoseconds >= duration * 1e9 - 1e6:
            self.state = following
            self.entered = self.get_clock().now()


def main():
    rclpy.init()
    node = Machine()
    rclpy.spin(node)
    node.destroy_node()


if __name__ == "__main__":
    main()
