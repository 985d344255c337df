#: 2.0 0 0.3 | - 0 0

import time

import rclpy
from geometry_msgs.msg import Twist

rclpy.init()
node = rclpy.create_node("busy")
pub = node.create_publisher(Twist, "cmd_vel", 10)
turn = Twist()
turn.angular.z = 0.3
start = time.time()
while time.time() - start < 2.0:
    pub.publish(turn)
pub.publish(Twist())
rclpy.shutdown()
