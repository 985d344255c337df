#: 1.0 0.2 0 | - 0 0
#: prints True started
#: prints True stopped

import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node
from std_srvs.srv import SetBool


class Switch(Node):
    def __init__(self):
        super().__init__("switch")
        self.pub = self.create_publisher(Twist, "cmd_vel", 10)
        self.srv = self.create_service(SetBool, "drive", self.on_request)

    def on_request(self, request, response):
        msg = Twist()
        msg.linear.x = 0.2 if request.data else 0.0
        self.pub.publish(msg)
        response.success = True
        response.message = "started" if request.data else "stopped"
        return response


def ask(node, client, executor, value):
    request = SetBool.Request()
    request.data = value
    future = client.call_async(request)
    rclpy.spin_until_future_complete(node, future, executor)
    print(future.result().success, future.result().message)


def main():
    rclpy.init()
    switch = Switch()
    node = rclpy.create_node("finger")
    executor = rclpy.executors.SingleThreadedExecutor()
    executor.add_node(switch)
    client = node.create_client(SetBool, "drive")
    assert client.wait_for_service(timeout_sec=1.0)
    ask(node, client, executor, True)
    end = node.get_clock().now() + rclpy.duration.Duration(seconds=1.0)
    while node.get_clock().now() < end:
        executor.spin_once(timeout_sec=0.1)
    ask(node, client, executor, False)
    rclpy.shutdown()


import rclpy.duration
import rclpy.executors

main()
