#: robot home
#: ends exit
#: prints obstacle at
#: drives 0.3

import math

import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node
from rclpy.qos import QoSProfile, ReliabilityPolicy, qos_profile_sensor_data
from sensor_msgs.msg import LaserScan


class StopBeforeWall(Node):
    def __init__(self):
        super().__init__("stop_before_wall")
        self.pub = self.create_publisher(
            Twist, "cmd_vel", QoSProfile(depth=10, reliability=ReliabilityPolicy.RELIABLE)
        )
        self.create_subscription(LaserScan, "scan", self.on_scan, qos_profile_sensor_data)

    def on_scan(self, scan):
        ahead = []
        for i, r in enumerate(scan.ranges):
            angle = scan.angle_min + i * scan.angle_increment
            angle = math.atan2(math.sin(angle), math.cos(angle))
            if abs(angle) < math.radians(20) and scan.range_min < r < scan.range_max:
                ahead.append(r)
        nearest = min(ahead) if ahead else float("inf")
        cmd = Twist()
        if nearest > 0.8:
            cmd.linear.x = 0.2
            self.pub.publish(cmd)
        else:
            self.pub.publish(cmd)
            self.get_logger().info(f"obstacle at {nearest:.2f} m")
            raise SystemExit


rclpy.init()
rclpy.spin(StopBeforeWall())
