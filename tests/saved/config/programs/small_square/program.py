"""Small square.

Asked for: drive a square of 30 cm
"""

import math
import time

import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node
from rclpy.signals import SignalHandlerOptions

PERIOD = 0.1  # s


class SmallSquare(Node):
    def __init__(self):
        super().__init__("small_square")
        self.publisher = self.create_publisher(Twist, "cmd_vel", 10)

    def run(self):
        for _ in range(4):
            self.move(linear_x=0.2, seconds=0.3 / 0.3)  # 0.3 m
            self.rest()
            self.move(angular_z=0.6, seconds=math.radians(90.0) / 0.6)
            self.rest()

    def move(self, linear_x=0.0, angular_z=0.0, *, seconds):
        """Hold a velocity for so long, telling it again and again: many bases stop when they hear nothing."""
        end = time.monotonic() + seconds
        while rclpy.ok() and time.monotonic() < end:
            self.publish(linear_x, angular_z)
            self.pause(min(PERIOD, end - time.monotonic()))

    def rest(self):
        """Stand between two motions: what comes next then begins from rest."""
        self.move(seconds=0.5)

    def pause(self, seconds):
        time.sleep(max(0.0, seconds))

    def publish(self, linear_x=0.0, angular_z=0.0):
        twist = Twist()
        twist.linear.x = linear_x
        twist.angular.z = angular_z
        self.publisher.publish(twist)

    def stop(self):
        """Change every velocity to zero, and rest so that the robot really stands."""
        self.publish()
        time.sleep(1.0)


def main(args=None):
    # Ctrl-C must not close the context before the robot has been told to stop.
    rclpy.init(args=args, signal_handler_options=SignalHandlerOptions.NO)
    node = SmallSquare()
    try:
        node.run()
    except KeyboardInterrupt:
        pass
    finally:
        node.stop()
        node.destroy_node()
        rclpy.shutdown()


if __name__ == "__main__":
    main()
