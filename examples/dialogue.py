"""A dialogue: every turn knows what was said and done before. What cannot be done is a value, not an exception."""

import math
import sys

import chatrobot

TURNS = [
    "remember this place as home",
    "forward 1 m",
    "again",
    "fly to the moon",
    "where are you?",
    "go back home",
]

with chatrobot.connect(world="empty", fast="--fast" in sys.argv) as robot:
    for text in TURNS:
        result = robot.do(text)
        print(f"{text!r}: {result.outcome}: {result.reply}")
    print(f"{math.hypot(robot.pose.x_m, robot.pose.y_m):.2f} m from home")
