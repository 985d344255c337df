#: 1.0 0.2 0 | - 0 0
#: prints enough

import rclpy
from geometry_msgs.msg import Twist
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.node import Node
from rclpy.task import Future


class Async(Node):
    def __init__(self):
        super().__init__("async_node")
        self.pub = self.create_publisher(Twist, "cmd_vel", 10)
        self.elapsed = Future()
        self.starter = self.create_timer(0.5, self.start, ReentrantCallbackGroup())
        self.alarm = self.create_timer(1.5, lambda: self.elapsed.set_result("enough"))

    async def start(self):
        self.starter.cancel()
        msg = Twist()
        msg.linear.x = 0.2
        self.pub.publish(msg)
        word = await self.elapsed
        self.pub.publish(Twist())
        self.get_logger().info(word)
        rclpy.shutdown()


rclpy.init()
rclpy.spin(Async())
