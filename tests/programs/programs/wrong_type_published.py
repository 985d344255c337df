#: -
#: raises TypeError Expected <class 'geometry_msgs.msg._twist.Twist'>, got <class 'str'>

import rclpy
from geometry_msgs.msg import Twist

rclpy.init()
node = rclpy.create_node("texter")
node.create_publisher(Twist, "cmd_vel", 10).publish("forward")
