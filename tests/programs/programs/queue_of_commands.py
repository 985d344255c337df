#: 1.0 0.2 0 | 2.0 0 0.6 | 1.0 0.2 0 | - 0 0

import queue
import threading
import time

import rclpy
from geometry_msgs.msg import Twist

commands = queue.Queue()


def producer():
    for item in ((1.0, 0.2, 0.0), (2.0, 0.0, 0.6), (1.0, 0.2, 0.0)):
        commands.put(item)
    commands.put(None)


def main():
    rclpy.init()
    node = rclpy.create_node("worker")
    pub = node.create_publisher(Twist, "cmd_vel", 10)
    threading.Thread(target=producer, daemon=True).start()
    while True:
        try:
            item = commands.get(timeout=3.0)
        except queue.Empty:
            break
        if item is None:
            break
        seconds, x, z = item
        msg = Twist()
        msg.linear.x = x
        msg.angular.z = z
        pub.publish(msg)
        time.sleep(seconds)
    pub.publish(Twist())
    rclpy.shutdown()


if __name__ == "__main__":
    main()
