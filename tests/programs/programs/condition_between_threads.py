#: 1.0 0.1 0 | 1.0 0.2 0 | 1.0 0.3 0 | - 0 0

import threading
import time

import rclpy
from geometry_msgs.msg import Twist

rclpy.init()
node = rclpy.create_node("gears")
pub = node.create_publisher(Twist, "cmd_vel", 10)
changed = threading.Condition()
gear = 0.0


def shift_gears():
    global gear
    for speed in (0.1, 0.2, 0.3, None):
        with changed:
            gear = speed
            changed.notify()
        time.sleep(1.0)


thread = threading.Thread(target=shift_gears)
with changed:
    thread.start()
    while changed.wait(timeout=5.0):
        msg = Twist()
        if gear is None:
            pub.publish(msg)
            break
        msg.linear.x = gear
        pub.publish(msg)
thread.join()
