"""The shortest program: connect, say something, read what came of it."""

import sys

import chatrobot

with chatrobot.connect(fast="--fast" in sys.argv) as robot:
    result = robot.do("forward 1 m, then turn left 90 degrees")
    print(result.outcome, result.pose)
