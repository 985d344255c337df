#: 1.0 0.2 0 | 1.0 -0.2 0 | - 0 0
#: prints I heard: backward

import rclpy
from geometry_msgs.msg import Twist
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from std_msgs.msg import String

SPEEDS = {"forward": 0.2, "backward": -0.2, "stop": 0.0}


class Commander(Node):
    def __init__(self):
        super().__init__("commander")
        self.pub = self.create_publisher(String, "command", 10)
        self.words = iter(["forward", "backward", "stop"])
        self.create_timer(1.0, self.say)

    def say(self):
        word = next(self.words, None)
        if word is None:
            rclpy.shutdown()
            return
        self.pub.publish(String(data=word))


class Driver(Node):
    def __init__(self):
        super().__init__("driver")
        self.pub = self.create_publisher(Twist, "cmd_vel", 10)
        self.create_subscription(String, "command", self.obey, 10)

    def obey(self, msg):
        self.get_logger().info(f"I heard: {msg.data}")
        cmd = Twist()
        cmd.linear.x = SPEEDS[msg.data]
        self.pub.publish(cmd)


def main():
    rclpy.init()
    executor = SingleThreadedExecutor()
    executor.add_node(Commander())
    executor.add_node(Driver())
    executor.spin()


main()
