#: -
#: raises TypeError

import time

import rclpy
from geometry_msgs.msg import Twist

with rclpy.init():
    node = rclpy.create_node("managed")
    pub = node.create_publisher(Twist, "cmd_vel", 10)
    msg = Twist()
    msg.linear.x = 0.2
    pub.publish(msg)
    time.sleep(1.0)
    pub.publish(Twist())
assert not rclpy.ok()
