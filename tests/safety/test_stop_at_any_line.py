"""A stop from another thread may come between any two lines of ours. Here it does: at every so manieth line that a
critical moment runs through, from the same thread, which is the worst that a thread can do."""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path
from types import FrameType
from typing import Any

import pytest

from chatrobot.core.reason import Reason
from chatrobot.wire.messages import TwistMessage
from tests.safety.test_who_drives import Crowd

OURS = ("/motion/", "/link/", "/governor/", "/transports/", "/execution/")
STRIDE = 211
"""Prime, so that it falls into step with no loop. With 1 every single line is tried, which takes minutes."""


def strike(line: int, act: Callable[[], object], stop: Callable[[], object]) -> bool:
    """Have `stop` happen before that line of ours while `act` runs; False where it has fewer lines."""
    seen = 0
    before = sys.gettrace()

    def on_line(frame: FrameType, event: str, argument: Any) -> Any:  # noqa: ARG001 - the interpreter's
        nonlocal seen
        seen += event == "line"
        if event == "line" and seen == line:
            sys.settrace(before)
            stop()
        return on_line if seen < line else None

    def on_call(frame: FrameType, event: str, argument: Any) -> Any:  # noqa: ARG001 - the interpreter's
        name = frame.f_code.co_filename
        return (
            on_line if seen < line and "/chatrobot/" in name and any(ours in name for ours in OURS) else None
        )

    sys.settrace(on_call)
    try:
        act()
    finally:
        sys.settrace(before)
    return seen >= line


def launch(crowd: Crowd) -> None:
    crowd.say("console", "plan", 1, plan_text="drive 5 m")


def yes(crowd: Crowd) -> None:
    crowd.say("console", "plan", 1, plan_text="drive 5 m", approve=True)
    crowd.live(0.1)
    crowd.say("console", "approve", 1, yes=True)


def hand_over(crowd: Crowd) -> None:
    crowd.say("agent", "plan", 1, plan_text="drive 5 m")
    crowd.live(0.6)
    crowd.say("console", "plan", 2, plan_text="turn left 90 deg")


def replace(crowd: Crowd) -> None:
    launch(crowd)
    crowd.live(0.6)
    crowd.say("console", "plan", 2, plan_text="drive 1 m back", mode="replace")


def end_by_a_fault(crowd: Crowd) -> None:
    launch(crowd)
    crowd.say("console", "plan", 2, plan_text="drive 1 m")
    crowd.live(0.6)
    crowd.motion.sensors.estimator.fault = Reason("odometry_jumped", {"jump_m": 1.0})


def others(crowd: Crowd) -> None:
    crowd.rig.robot._wire.publish("chatrobot/cmd_vel", TwistMessage(0.3, 0.0, 0.0))  # type: ignore[union-attr]


def joystick(crowd: Crowd) -> None:
    launch(crowd)
    crowd.live(0.6)
    crowd.rig.robot._wire.publish("chatrobot/joystick", TwistMessage(0.0, 0.0, 0.5))  # type: ignore[union-attr]


@pytest.mark.parametrize("moment", [launch, yes, hand_over, replace, end_by_a_fault, others, joystick])
def test_wherever_a_stop_falls_nothing_moves_after_it(
    tmp_path: Path, moment: Callable[[Crowd], None]
) -> None:
    line = 1
    while True:
        crowd = Crowd(tmp_path, "console", "agent")
        moment(crowd)
        sent = crowd.rig.velocities
        stopped_at: list[int] = []

        def stop(crowd: Crowd = crowd, stopped_at: list[int] = stopped_at) -> None:
            stopped_at.append(len(crowd.rig.velocities))
            crowd.motion.halt(Reason("stopped"))

        if not strike(line, lambda crowd=crowd: crowd.live(0.04), stop):  # type: ignore[misc]
            break
        crowd.live(0.4)
        after = sent[stopped_at[0] :]
        moving = [number for number, velocity in enumerate(after) if any(velocity)]
        # What was on its way to the wire at this very line is taken back with the next message.
        taken_back = len(moving) == 1 and moving[0] <= 1 and not any(after[moving[0] + 1])
        assert not moving or taken_back, f"line {line}: {after[:5]}"
        assert not crowd.is_moving
        line += STRIDE
    assert line > 3 * STRIDE, "it runs through more lines than that"
