#: 3.0 0.2 0 | - 0 0

import threading

import rclpy
from geometry_msgs.msg import Twist


def main():
    rclpy.init()
    node = rclpy.create_node("rate_driver")
    thread = threading.Thread(target=rclpy.spin, args=(node,), daemon=True)
    thread.start()
    pub = node.create_publisher(Twist, "cmd_vel", 10)
    rate = node.create_rate(10)
    msg = Twist()
    msg.linear.x = 0.2
    for _ in range(30):
        pub.publish(msg)
        rate.sleep()
    pub.publish(Twist())
    node.destroy_node()


main()
