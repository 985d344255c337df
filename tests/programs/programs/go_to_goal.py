#: robot
#: at 1.0 0.5 ?

import math

import rclpy
from geometry_msgs.msg import Point, Twist
from nav_msgs.msg import Odometry
from rclpy.node import Node


class GoToGoal(Node):
    def __init__(self, x, y):
        super().__init__("go_to_goal")
        self.goal = Point(x=x, y=y)
        self.pub = self.create_publisher(Twist, "cmd_vel", 10)
        self.odom = None
        self.reached = False
        self.create_subscription(Odometry, "odom", self.save, 10)
        self.create_timer(0.05, self.control)

    def save(self, msg):
        self.odom = msg.pose.pose

    def control(self):
        if self.odom is None or self.reached:
            return
        dx = self.goal.x - self.odom.position.x
        dy = self.goal.y - self.odom.position.y
        q = self.odom.orientation
        yaw = math.atan2(2 * (q.w * q.z + q.x * q.y), 1 - 2 * (q.y**2 + q.z**2))
        distance = math.hypot(dx, dy)
        error = math.atan2(dy, dx) - yaw
        error = math.atan2(math.sin(error), math.cos(error))
        cmd = Twist()
        if distance < 0.03:
            self.reached = True
        else:
            cmd.angular.z = max(-1.0, min(1.0, 2.0 * error))
            if abs(error) < 0.3:
                cmd.linear.x = min(0.3, 0.8 * distance)
        self.pub.publish(cmd)


def main():
    rclpy.init()
    node = GoToGoal(1.0, 0.5)
    while rclpy.ok() and not node.reached:
        rclpy.spin_once(node)
    node.destroy_node()
    rclpy.shutdown()


main()
