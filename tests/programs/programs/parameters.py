#: 2.0 0.25 0 | - 0 0

import time

import rclpy
from geometry_msgs.msg import Twist
from rcl_interfaces.msg import ParameterDescriptor, SetParametersResult
from rclpy.node import Node
from rclpy.parameter import Parameter


class Configured(Node):
    def __init__(self):
        super().__init__("configured")
        self.declare_parameter("speed", 0.1, ParameterDescriptor(description="m/s"))
        self.declare_parameters("", [("seconds", 2.0), ("topic", "cmd_vel")])
        self.add_on_set_parameters_callback(self.check)

    def check(self, params):
        ok = all(p.value <= 0.3 for p in params if p.name == "speed")
        return SetParametersResult(successful=ok, reason="" if ok else "too fast")

    def run(self):
        accepted = self.set_parameters([Parameter("speed", Parameter.Type.DOUBLE, 0.25)])[0]
        refused = self.set_parameters([Parameter("speed", value=5.0)])[0]
        assert accepted.successful and not refused.successful and refused.reason == "too fast"
        topic = self.get_parameter("topic").get_parameter_value().string_value
        pub = self.create_publisher(Twist, topic, 10)
        msg = Twist()
        msg.linear.x = self.get_parameter("speed").value
        pub.publish(msg)
        time.sleep(self.get_parameter("seconds").value)
        pub.publish(Twist())


rclpy.init()
node = Configured()
node.run()
node.destroy_node()
rclpy.shutdown()
