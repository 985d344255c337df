#: robot
#: at 0 0 1.5708

import math

import rclpy
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
from rclpy.node import Node
from tf_transformations import euler_from_quaternion


class TurnLeft(Node):
    def __init__(self):
        super().__init__("turn_left")
        self.pub = self.create_publisher(Twist, "cmd_vel", 10)
        self.create_subscription(Odometry, "odom", self.on_odom, 10)
        self.yaw = None

    def on_odom(self, msg):
        q = msg.pose.pose.orientation
        _, _, self.yaw = euler_from_quaternion([q.x, q.y, q.z, q.w])


def main():
    rclpy.init()
    node = TurnLeft()
    while rclpy.ok() and node.yaw is None:
        rclpy.spin_once(node, timeout_sec=0.1)
    goal = node.yaw + math.pi / 2
    while rclpy.ok():
        rclpy.spin_once(node, timeout_sec=0.05)
        error = math.atan2(math.sin(goal - node.yaw), math.cos(goal - node.yaw))
        if abs(error) < 0.01:
            break
        cmd = Twist()
        cmd.angular.z = max(-0.6, min(0.6, 1.5 * error))
        node.pub.publish(cmd)
    node.pub.publish(Twist())
    node.destroy_node()
    rclpy.shutdown()


if __name__ == "__main__":
    main()
