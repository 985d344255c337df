#: - 0.1 0
#: finds program_never_stops

import threading

import rclpy
from geometry_msgs.msg import Twist

rclpy.init()
node = rclpy.create_node("pulled_away")
pub = node.create_publisher(Twist, "cmd_vel", 10)
msg = Twist()
msg.linear.x = 0.1
pub.publish(msg)
threading.Timer(1.0, rclpy.shutdown).start()
rclpy.spin(node)
