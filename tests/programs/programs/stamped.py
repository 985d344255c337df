#: 2.0 0.2 0 | - 0 0

import time

import rclpy
from geometry_msgs.msg import TwistStamped

rclpy.init()
node = rclpy.create_node("stamped")
pub = node.create_publisher(TwistStamped, "cmd_vel", 10)
msg = TwistStamped()
msg.header.frame_id = "base_link"
end = time.time() + 2.0
while time.time() < end:
    msg.header.stamp = node.get_clock().now().to_msg()
    msg.twist.linear.x = 0.2
    pub.publish(msg)
    time.sleep(0.1)
msg.twist.linear.x = 0.0
pub.publish(msg)
rclpy.shutdown()
