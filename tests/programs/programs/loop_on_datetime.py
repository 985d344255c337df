#: 3.0 0 0.5 | - 0 0

import time
from datetime import datetime, timedelta

import rclpy
from geometry_msgs.msg import Twist

rclpy.init(args=None)
node = rclpy.create_node("dated")
pub = node.create_publisher(Twist, "cmd_vel", 10)
end = datetime.now() + timedelta(seconds=3)
msg = Twist()
msg.angular.z = 0.5
while datetime.now() < end:
    pub.publish(msg)
    time.sleep(0.02)
pub.publish(Twist())
rclpy.shutdown()
