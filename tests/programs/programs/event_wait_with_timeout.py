#: 2.0 0 -0.5 | - 0 0

import threading

import rclpy
from geometry_msgs.msg import Twist


def main():
    rclpy.init()
    node = rclpy.create_node("waiter")
    pub = node.create_publisher(Twist, "cmd_vel", 10)
    msg = Twist()
    msg.angular.z = -0.5
    pub.publish(msg)
    cancelled = threading.Event().wait(timeout=2.0)
    if not cancelled:
        pub.publish(Twist())
    rclpy.shutdown()


main()
