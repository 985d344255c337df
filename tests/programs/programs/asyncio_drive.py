#: 1.0 0.2 0 | 1.5 0 0.5 | - 0 0
#: prints beat 4

import asyncio

import rclpy
from geometry_msgs.msg import Twist


async def drive(pub, x, z, seconds):
    msg = Twist()
    msg.linear.x, msg.angular.z = x, z
    pub.publish(msg)
    await asyncio.sleep(seconds)


async def heart(name):
    beat = 0
    while True:
        await asyncio.sleep(0.5)
        beat += 1
        print(name, beat)


async def main():
    node = rclpy.create_node("awaiting")
    pub = node.create_publisher(Twist, "cmd_vel", 10)
    task = asyncio.create_task(heart("beat"))
    await drive(pub, 0.2, 0.0, 1.0)
    await asyncio.wait_for(drive(pub, 0.0, 0.5, 1.5), timeout=3.0)
    task.cancel()
    pub.publish(Twist())
    node.destroy_node()


rclpy.init()
asyncio.run(main())
rclpy.shutdown()
