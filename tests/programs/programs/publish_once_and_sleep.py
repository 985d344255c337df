#: 2.5 0.15 0 | - 0 0

from time import sleep

import rclpy
from geometry_msgs.msg import Twist

rclpy.init()
node = rclpy.create_node("simple_move")
publisher = node.create_publisher(Twist, "/cmd_vel", 10)
cmd = Twist()
cmd.linear.x = 0.15
publisher.publish(cmd)
sleep(2.5)
publisher.publish(Twist())
node.destroy_node()
rclpy.shutdown()
