#: robot
#: at 0 0 -1.5708

import math

import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node
from rclpy.time import Time
from sensor_msgs.msg import Imu


class GyroTurn(Node):
    def __init__(self):
        super().__init__("gyro_turn")
        self.pub = self.create_publisher(Twist, "cmd_vel", 10)
        self.turned = 0.0
        self.last = None
        self.create_subscription(Imu, "imu", self.on_imu, 50)

    def on_imu(self, msg):
        stamp = Time.from_msg(msg.header.stamp)
        if self.last is not None:
            self.turned += msg.angular_velocity.z * (stamp - self.last).nanoseconds * 1e-9
        self.last = stamp
        cmd = Twist()
        if self.turned > -math.pi / 2 + 0.05:
            cmd.angular.z = -0.4
        self.pub.publish(cmd)
        if cmd.angular.z == 0.0:
            rclpy.shutdown()


rclpy.init()
rclpy.spin(GyroTurn())
