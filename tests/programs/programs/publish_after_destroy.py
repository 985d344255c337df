#: - 0.1 0
#: raises rclpy._rclpy_pybind11.InvalidHandle
#: finds program_never_stops

import rclpy
from geometry_msgs.msg import Twist

rclpy.init()
node = rclpy.create_node("late")
pub = node.create_publisher(Twist, "cmd_vel", 10)
pub.publish(Twist(linear=__import__("geometry_msgs.msg", fromlist=["x"]).Vector3(x=0.1)))
node.destroy_node()
pub.publish(Twist())
