#: -
#: finds program_moves_nothing

import rclpy
from std_msgs.msg import String

rclpy.init()
node = rclpy.create_node("talker")
pub = node.create_publisher(String, "cmd_vel", 10)
pub.publish(String(data="forward"))
rclpy.shutdown()
