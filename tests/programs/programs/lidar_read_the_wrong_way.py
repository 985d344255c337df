#: robot home
#: ends horizon
#: finds would_collide,program_endless
#: drives 2.0

import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node
from sensor_msgs.msg import LaserScan


class Wander(Node):
    def __init__(self):
        super().__init__("wander")
        self.publisher = self.create_publisher(Twist, "/cmd_vel", 10)
        self.create_subscription(LaserScan, "/scan", self.scan_callback, 10)
        self.create_timer(0.1, self.drive)
        self.blocked = False

    def scan_callback(self, msg):
        # Beam 0 looks ahead on some lidars; on this one it looks back.
        n = len(msg.ranges)
        middle = list(msg.ranges[: n // 5]) + list(msg.ranges[-n // 5 :])
        valid = [r for r in middle if msg.range_min < r < msg.range_max]
        self.blocked = bool(valid) and min(valid) < 0.8

    def drive(self):
        cmd = Twist()
        if self.blocked:
            cmd.angular.z = 0.6
        else:
            cmd.linear.x = 0.2
        self.publisher.publish(cmd)


def main(args=None):
    rclpy.init(args=args)
    node = Wander()
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        pass
    finally:
        node.publisher.publish(Twist())
        node.destroy_node()
        rclpy.shutdown()


if __name__ == "__main__":
    main()
