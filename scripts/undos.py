"""Undo turns that were stopped, and measure how far from its start each one ends: 20 plans, each stopped at 20 moments.

    make undos
    make undos UNDOS='--robot turtlebot3_burger --moments 5 --sim noise=on,seed=1'

Every plan is stopped in its course on simulated time, in the empty world; then `undo` is said. Printed are the
distances between the true pose before the turn and the true pose after the undo, and the same for the pose that the
robot tells. It ends with 1 where one of the true ones is beyond 2 cm or 1 degree. A plan that the robot refuses (a
sideways drive on two wheels) is left out.
"""

from __future__ import annotations

import argparse
import math
import sys
from collections.abc import Sequence
from typing import NamedTuple

from chatrobot.compose import Setup, connect
from chatrobot.core.events import Event, Rehearsed, Result, Started, TruePose
from chatrobot.core.geometry import Pose
from chatrobot.robots.load import DEFAULT_PROFILE

PLANS = (
    "drive 2 m",
    "drive 5 m at 0.8 m/s",
    "drive 1.5 m back at 0.2 m/s",
    "drive 2 m left",
    "drive 1.5 m toward 30 deg",
    "drive 6 s",
    "turn left 90 deg",
    "turn right 720 deg at 1.2 rad/s",
    "turn left 4 s",
    "arc left 270 deg radius 0.5 m",
    "arc back right 90 deg radius 2 m",
    "twist 0.3 0.1 0.4 for 8 s",
    "drive 2 m\nturn left 90 deg\ndrive 1 m",
    "turn right 60 deg\ndrive 3 m at 0.6 m/s\nturn left 150 deg\ndrive 1 m back",
    "repeat 4\n  drive 1 m\n  turn left 90 deg\nend",
    "repeat 3\n  repeat 2\n    drive 0.4 m right\n    wait 0.5 s\n  end\n  turn left 120 deg\nend",
    "drive 1 m\nwait 2 s\narc left 180 deg radius 0.4 m\nwait 1 s\ndrive 1 m",
    'go to 2 1 facing 90 deg\nsay "there"\ndrive 1 m',
    "face 120 deg\ndrive 2 m\nface 0 deg\ndrive 1 m",
    "drive 1 m\ngo to 0 0.5 from start facing 0 deg",
)
MOST_M, MOST_DEG = 0.02, 1.0


class Off(NamedTuple):
    """How far two poses are apart."""

    metres: float
    degrees: float

    @property
    def is_far(self) -> bool:
        return self.metres > MOST_M or self.degrees > MOST_DEG


class Undone(NamedTuple):
    """One plan that was stopped and undone: how the undo ended, and how far from where the turn began."""

    outcome: str
    told: Off
    true: Off


class Talk:
    """A session on simulated time."""

    def __init__(self, robot: str = DEFAULT_PROFILE, sim: str = "") -> None:
        self.true = Pose()
        self._now_s = 0.0
        self._began_s = math.inf
        self._duration_s = 0.0
        setup = Setup(world="empty", fast=True, trace=True, robot=robot, sim=sim)
        self.connection = connect(setup, self._hear)
        self.session = self.connection.session

    def _hear(self, event: Event) -> None:
        if isinstance(event, TruePose):
            self.true, self._now_s = Pose(event.x_m, event.y_m, event.yaw_rad), event.t_s
        elif isinstance(event, Rehearsed):
            self._duration_s = event.duration_s
        elif isinstance(event, Started):
            self._began_s = self._now_s

    def stop_at(self, plan_text: str, share: float) -> Result:
        """Drive a plan until that share of the time it takes has passed, stop, and see the robot stand."""
        self._began_s = math.inf
        turn = self.session.say_plan(plan_text)
        while turn not in self.session.results and self._now_s - self._began_s < share * self._duration_s:
            self.session.pump(0.02)
        self.session.say("stop")
        while turn not in self.session.results:
            self.session.pump(0.02)
        self.stand()
        return self.session.results[turn]

    def do(self, text: str) -> Result:
        """Say it, and see the robot stand."""
        result = self.session.do(text)
        self.stand()
        return result

    def stand(self) -> None:
        """Let half a second pass."""
        since_s = self._now_s
        while self._now_s - since_s < 0.5:
            self.session.pump(0.02)

    @property
    def told(self) -> Pose:
        return self.session.understanding.pose

    def undo_after(self, plan_text: str, share: float) -> Undone | None:
        """Drive a plan, stop it at that share of its time, undo it; None where the robot refuses the plan."""
        told, true = self.told, self.true
        if self.stop_at(plan_text, share).outcome == "refused":
            return None
        outcome = self.do("undo").outcome
        return Undone(outcome, apart(told, self.told), apart(true, self.true))


def apart(pose: Pose, other: Pose) -> Off:
    """How far they are apart; whole turns do not count."""
    off_rad = math.remainder(pose.yaw_rad - other.yaw_rad, 2.0 * math.pi)
    return Off(pose.distance_to(other), abs(math.degrees(off_rad)))


def main(arguments: Sequence[str] | None = None) -> int:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--robot", default=DEFAULT_PROFILE)
    parser.add_argument("--sim", default="", help="how the simulated robot lies, as for chatrobot do")
    parser.add_argument("--moments", type=int, default=20)
    options = parser.parse_args(arguments)
    everything: list[Undone] = []
    for plan_text in PLANS:
        talk = Talk(options.robot, options.sim)
        talk.stand()
        shares = [(k + 0.5) / options.moments for k in range(options.moments)]
        found = [undone for share in shares if (undone := talk.undo_after(plan_text, share)) is not None]
        everything += found
        figures = _figures(found) if found else "refused"
        print(f"{figures}   {'; '.join(map(str.strip, plan_text.splitlines()))}", flush=True)
    missed = [undone for undone in everything if undone.outcome != "completed" or undone.true.is_far]
    print(
        f"{_figures(everything)}   all {len(everything)}, {len(missed)} beyond {MOST_M * 100:g} cm or {MOST_DEG:g}°"
    )
    return 1 if missed else 0


def _figures(found: Sequence[Undone]) -> str:
    ended = sum(undone.outcome == "completed" for undone in found)
    true_mm = max(undone.true.metres for undone in found) * 1000
    true_deg = max(undone.true.degrees for undone in found)
    told_mm = max(undone.told.metres for undone in found) * 1000
    told_deg = max(undone.told.degrees for undone in found)
    worst = f"worst: true {true_mm:5.1f} mm {true_deg:5.2f}°, told {told_mm:5.1f} mm {told_deg:5.2f}°"
    return f"{ended}/{len(found)} undone, {worst}"


if __name__ == "__main__":
    sys.exit(main())
