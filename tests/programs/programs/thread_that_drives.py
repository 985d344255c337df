#: 2.0 0.2 0 | - 0 0
#: prints done after 2.0 s

import threading
import time

import rclpy
from geometry_msgs.msg import Twist


class Driver(threading.Thread):
    def __init__(self, pub):
        super().__init__()
        self.pub = pub
        self.running = True

    def run(self):
        msg = Twist()
        msg.linear.x = 0.2
        while self.running:
            self.pub.publish(msg)
            time.sleep(0.1)
        self.pub.publish(Twist())


rclpy.init()
node = rclpy.create_node("threaded")
began = time.monotonic()
driver = Driver(node.create_publisher(Twist, "cmd_vel", 10))
driver.start()
time.sleep(1.95)
driver.running = False
driver.join(timeout=5.0)
assert not driver.is_alive()
print(f"done after {time.monotonic() - began:.1f} s")
rclpy.shutdown()
