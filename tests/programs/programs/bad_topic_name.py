#: -
#: raises rclpy.exceptions.InvalidTopicNameException

import rclpy
from geometry_msgs.msg import Twist

rclpy.init()
node = rclpy.create_node("namer")
node.create_publisher(Twist, "cmd vel", 10)
