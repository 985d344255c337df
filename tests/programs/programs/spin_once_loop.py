#: 4.0 0.1 0.2 | - 0 0

import time

import rclpy
from geometry_msgs.msg import Twist

rclpy.init()
node = rclpy.create_node("arc")
pub = node.create_publisher(Twist, "cmd_vel", 10)
t0 = time.time()
while rclpy.ok():
    m = Twist()
    if time.time() - t0 >= 4.0:
        pub.publish(m)
        break
    m.linear.x = 0.1
    m.angular.z = 0.2
    pub.publish(m)
    rclpy.spin_once(node, timeout_sec=0.1)
node.destroy_node()
rclpy.shutdown()
