#: 3.0 0.2 0 | - 0 0
#: prints left spin

import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node


class DriveThenQuit(Node):
    def __init__(self):
        super().__init__("drive_then_quit")
        self.pub = self.create_publisher(Twist, "cmd_vel", 1)
        self.begun = self.get_clock().now()
        msg = Twist()
        msg.linear.x = 0.2
        self.pub.publish(msg)
        self.create_timer(3.0, self.finish)

    def finish(self):
        self.pub.publish(Twist())
        self.get_logger().warning("time is up")
        rclpy.shutdown()


rclpy.init()
rclpy.spin(DriveThenQuit())
print("left spin")
