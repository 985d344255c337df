"""What understanding and rehearsing cost, in this process. Run: python -m bench.thinking

Ratios are to one control period of 20 ms, in which all of it should fit.
"""

from __future__ import annotations

import statistics
import time
from collections.abc import Callable

from chatrobot.core.clock import TICK_S
from chatrobot.core.geometry import ORIGIN
from chatrobot.language.context import Context
from chatrobot.language.interpreter import OfflineInterpreter
from chatrobot.motion.planner import Planner
from chatrobot.robots.load import load_profile
from chatrobot.sim.load import load_world

RUNS = 100
SENTENCES = {
    "understand one step": "forward 1 m",
    "understand one step, Chinese": "前进一米",
    "understand three clauses": "go forward one and a half metres, turn left 90 degrees, then back up 20 cm",
}
TWENTY_SECONDS = (
    "drive 1 m\nturn left 90 deg\narc left 90 deg radius 0.5 m\ndrive 1 m\nturn right 90 deg\ndrive 0.5 m"
)


def measured(name: str, work: Callable[[], object]) -> None:
    """Median and worst of many runs after a warm-up."""
    work()
    took = []
    for _ in range(RUNS):
        began_s = time.perf_counter()
        work()
        took.append(time.perf_counter() - began_s)
    median = statistics.median(took)
    print(f"{name:32s} {median * 1e3:7.2f} ms {max(took) * 1e3:7.2f} ms {median / TICK_S:7.3f} x")


def main() -> None:
    print(f"{'':32s} {'median':>10s} {'max':>10s} {'x 20 ms':>9s}")
    profile, world = load_profile("wheeltec_mini_mec"), load_world("home")
    interpreter = OfflineInterpreter(profile)
    for name, sentence in SENTENCES.items():
        measured(name, lambda sentence=sentence: interpreter.interpret(sentence, Context()))  # type: ignore[misc]
    planner = Planner(profile, world)
    planned = planner.plan(1, TWENTY_SECONDS, ORIGIN)
    measured(
        f"rehearse {planned.duration_s:.0f} s in the flat", lambda: planner.plan(1, TWENTY_SECONDS, ORIGIN)
    )


if __name__ == "__main__":
    main()
