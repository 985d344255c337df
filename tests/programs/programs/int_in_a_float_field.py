#: -
#: raises AssertionError The 'x' field must be of type 'float'
#: humble

import rclpy
from geometry_msgs.msg import Twist

rclpy.init()
node = rclpy.create_node("ints")
pub = node.create_publisher(Twist, "cmd_vel", 10)
msg = Twist()
msg.linear.x = 1
pub.publish(msg)
