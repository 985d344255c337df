#: robot
#: at 1.0 0 0
#: ends exit
#: prints arrived after 1.0

import math

import rclpy
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
from rclpy.node import Node


class OneMetre(Node):
    def __init__(self):
        super().__init__("one_metre")
        self.pub = self.create_publisher(Twist, "/cmd_vel", 10)
        self.sub = self.create_subscription(Odometry, "/odom", self.on_odom, 10)
        self.start = None

    def on_odom(self, msg):
        p = msg.pose.pose.position
        if self.start is None:
            self.start = (p.x, p.y)
        travelled = math.hypot(p.x - self.start[0], p.y - self.start[1])
        cmd = Twist()
        if travelled < 1.0:
            cmd.linear.x = 0.2
        self.pub.publish(cmd)
        if travelled >= 1.0:
            self.get_logger().info("arrived after %.2f m" % travelled)
            raise SystemExit


rclpy.init()
rclpy.spin(OneMetre())
