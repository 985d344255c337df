"""What a program of `programs/` is expected to do, as the lines `#:` at its top say.

#: 3 0.2 0 | 2 0 1.0 | - 0 0    phases: seconds, m/s forward, rad/s; the last one has no end. `-`: it drives nothing
#: ends exit                    how it ends: returned (where nothing is said), exit, horizon, stuck
#: raises TypeError Expected    ends by that exception, whose message contains that
#: lasts 21                     seconds from its start to its end
#: at 1.0 0 0                   where the robot stands afterwards (x m, y m, yaw rad; ? is anywhere), within 5 cm
#: drives 0.3                   at least so many metres
#: prints TEXT                  its log or output contains that
#: finds CODE,CODE              what rehearsal has to say besides
#: robot [WORLD]                it needs a robot that answers; in that world
#: box | humble                 only so in the box; only so on Humble
"""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

from chatrobot.core.geometry import Twist

FOLDER = Path(__file__).parent / "programs"
Phase = tuple[float, float, float]
"""Seconds, m/s, rad/s."""


@dataclass
class Expected:
    name: str
    source: str
    phases: list[Phase] | None = None
    ends: str = "returned"
    raises: tuple[str, str] | None = None
    lasts_s: float | None = None
    at: tuple[float | None, ...] | None = None
    drives_m: float = 0.0
    prints: list[str] = field(default_factory=list)
    finds: list[str] = field(default_factory=list)
    robot: str | None = None
    only: str = ""


def all_programs() -> list[Expected]:
    return [_read(path) for path in sorted(FOLDER.glob("*.py"))]


def _read(path: Path) -> Expected:
    source = path.read_text(encoding="utf-8")
    expected = Expected(path.stem, source)
    for line in source.splitlines():
        if line.startswith("#: "):
            _take(expected, line[3:].strip())
    return expected


def _take(expected: Expected, line: str) -> None:
    word, _, rest = line.partition(" ")
    if word == "ends":
        expected.ends = rest
    elif word == "raises":
        kind, _, text = rest.partition(" ")
        expected.raises = (kind, text)
    elif word == "lasts":
        expected.lasts_s = float(rest)
    elif word == "at":
        expected.at = tuple(None if value == "?" else float(value) for value in rest.split())
    elif word == "drives":
        expected.drives_m = float(rest)
    elif word == "prints":
        expected.prints.append(rest)
    elif word == "finds":
        expected.finds = rest.split(",")
    elif word == "robot":
        expected.robot = rest or "empty"
    elif word in ("box", "humble"):
        expected.only = word
    else:
        expected.phases = [_phase(text) for text in line.split("|")] if line != "-" else []


def _phase(text: str) -> Phase:
    seconds, speed, rate = text.split()
    return (float("inf") if seconds == "-" else float(seconds), float(speed), float(rate))


def phases_of(cmd_vel: list[tuple[float, Twist]]) -> list[Phase]:
    """A stream of (seconds, velocity) as phases: equal neighbours are one, the last one has no end."""
    merged: list[tuple[float, Twist]] = []
    for t_s, twist in cmd_vel:
        if not merged or merged[-1][1] != twist:
            merged.append((t_s, twist))
    ends = [t_s for t_s, _ in merged[1:]] + [float("inf")]
    return [(end - t_s, twist.vx_mps, twist.wz_radps) for (t_s, twist), end in zip(merged, ends)]


def is_alike(found: list[Phase], expected: list[Phase], within_s: float) -> bool:
    """The same velocities in the same order, each for as long, give or take `within_s`."""
    return len(found) == len(expected) and all(
        (a[0] == b[0] or abs(a[0] - b[0]) <= within_s) and abs(a[1] - b[1]) < 1e-6 and abs(a[2] - b[2]) < 1e-6
        for a, b in zip(found, expected)
    )
