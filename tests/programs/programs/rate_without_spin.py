#: - 0.2 0
#: ends stuck
#: finds program_waits_for_ever

import rclpy
from geometry_msgs.msg import Twist

rclpy.init()
node = rclpy.create_node("stuck")
pub = node.create_publisher(Twist, "cmd_vel", 10)
rate = node.create_rate(10)
msg = Twist()
msg.linear.x = 0.2
while rclpy.ok():
    pub.publish(msg)
    rate.sleep()
