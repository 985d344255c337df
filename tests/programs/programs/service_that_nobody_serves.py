#: -
#: prints not there
#: lasts 2
#: finds program_moves_nothing

import rclpy
from std_srvs.srv import Empty

rclpy.init()
node = rclpy.create_node("asker")
client = node.create_client(Empty, "reset_odometry")
if not client.wait_for_service(timeout_sec=2.0):
    node.get_logger().error("not there")
rclpy.shutdown()
