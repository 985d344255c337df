"""A program in the box, from "yes" to its first velocity, and a typed stop to the zero: python -m bench.program_stop

In real time, at a subscriber in another process: console, Motion, guard, robot, warm server and program are six others.
"""

from __future__ import annotations

import os
import tempfile
import time
from pathlib import Path

from tests.processes import RunningRobot

from bench import line
from chatrobot.programs.library import KeptProgram, Library

REPETITIONS = 20
SOURCE = """\
import time

import rclpy
from geometry_msgs.msg import Twist

rclpy.init()
node = rclpy.create_node('bench')
publisher = node.create_publisher(Twist, 'cmd_vel', 10)
twist = Twist()
twist.linear.x = 0.2
for _ in range(300):
    publisher.publish(twist)
    time.sleep(0.1)
publisher.publish(Twist())
"""


def main() -> None:
    print(f"load {os.getloadavg()[0]:.1f}; median and 99th percentile of {REPETITIONS}")
    starts, stops = [], []
    with tempfile.TemporaryDirectory() as folder:
        Library(Path(folder) / "config").keep(KeptProgram("bench", SOURCE))
        robot = RunningRobot(Path(folder), ("--json", "--world", "empty", "--approve"))
        try:
            for _ in range(REPETITIONS):
                robot.say("run the bench program")
                robot.wait_for_event("rehearsed", needs_approval=True)
                said_s = robot.say('{"approve": true}')
                starts.append(robot.velocities.wait_for_motion(said_s) - said_s)
                said_s = robot.say("stop")
                stops.append(robot.velocities.wait_for_zero(said_s) - said_s)
                robot.wait_for_event("result", outcome="stopped")
                time.sleep(0.5)  # new motion waits until the robot has been seen standing
        finally:
            robot.close()
    line("yes → first velocity of the program", starts)
    line("typed stop while a program runs → zero", stops)


if __name__ == "__main__":
    main()
