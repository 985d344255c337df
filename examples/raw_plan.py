"""A plan instead of words: rehearsed, limited and measured like everything else."""

import math
import sys

import chatrobot

SQUARE = """
repeat 4
  drive 1 m at 0.4 m/s
  turn left 90 deg
end
"""

with chatrobot.connect(world="empty", fast="--fast" in sys.argv) as robot:
    result = robot.run(SQUARE)
    print(f"{result.outcome}: {result.path_m:.2f} m, {math.degrees(result.turned_rad):.0f} degrees")
    print(f"ended {math.hypot(result.pose.x_m, result.pose.y_m):.3f} m from where it began")
