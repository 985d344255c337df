#: 1.5 0.2 0 | - 0 0

import rclpy
from geometry_msgs.msg import Twist
from rclpy.clock import Clock, ClockType
from rclpy.duration import Duration

rclpy.init()
node = rclpy.create_node("sleeper")
pub = node.create_publisher(Twist, "cmd_vel", 10)
msg = Twist()
msg.linear.x = 0.2
pub.publish(msg)
Clock(clock_type=ClockType.STEADY_TIME).sleep_for(Duration(seconds=1, nanoseconds=500_000_000))
pub.publish(Twist())
rclpy.shutdown()
