#: 1.0 0.1 0 | 1.0 0.2 0 | - 0 0

import time
from concurrent.futures import ThreadPoolExecutor

import rclpy
from geometry_msgs.msg import Twist

rclpy.init()
node = rclpy.create_node("pool")
pub = node.create_publisher(Twist, "cmd_vel", 10)


def drive(speed):
    msg = Twist()
    msg.linear.x = speed
    pub.publish(msg)
    time.sleep(1.0)
    return speed


with ThreadPoolExecutor(max_workers=1) as pool:
    speeds = list(pool.map(drive, [0.1, 0.2]))
assert speeds == [0.1, 0.2]
pub.publish(Twist())
rclpy.shutdown()
