#: 1.0 0 0.4 | - 0 0
#: prints turned

import threading
import time

import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node
from std_srvs.srv import Trigger


class Turner(Node):
    def __init__(self):
        super().__init__("turner")
        self.pub = self.create_publisher(Twist, "cmd_vel", 10)
        self.create_service(Trigger, "~/turn", self.turn)

    def turn(self, request, response):
        msg = Twist()
        msg.angular.z = 0.4
        self.pub.publish(msg)
        time.sleep(1.0)
        self.pub.publish(Twist())
        response.success = True
        response.message = "turned"
        return response


rclpy.init()
node = Turner()
threading.Thread(target=rclpy.spin, args=(node,), daemon=True).start()
client = node.create_client(Trigger, "/turner/turn")
client.wait_for_service()
done = threading.Event()
future = client.call_async(Trigger.Request())
future.add_done_callback(lambda f: done.set())
done.wait()
print(future.result().message)
