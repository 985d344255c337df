"""The text of a profile to a `RobotProfile`: which fields there are, and which values each may have alone.

What must hold between fields is in `rules`. The format is described in docs/robots.md.
"""

from __future__ import annotations

import dataclasses
import math
import re
import sys
from typing import Any

from chatrobot.robots.fields import Range, Source, Table
from chatrobot.robots.profile import (
    Calibration,
    Circle,
    Defaults,
    Lidar,
    Limits,
    MotionBudget,
    Point,
    RobotProfile,
    Safety,
    Wiring,
)
from chatrobot.robots.rules import check

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

# Wide enough for any robot that fits through a door, narrow enough to catch mm/s and degrees.
LIMIT_RANGES = {
    "max_speed_mps": Range(0.0, 10.0, "m/s"),
    "max_sideways_mps": Range(0.0, 10.0, "m/s", with_low=True),
    "max_rate_radps": Range(0.0, 20.0, "rad/s"),
    "acceleration_mps2": Range(0.0, 50.0, "m/s²"),
    "angular_acceleration_radps2": Range(0.0, 200.0, "rad/s²"),
    "deceleration_mps2": Range(0.0, 50.0, "m/s²"),
    "latency_s": Range(0.0, 2.0, "s", with_low=True),
    "min_turning_radius_m": Range(0.0, 20.0, "m", with_low=True),
    "max_wheel_speed_mps": Range(0.0, 20.0, "m/s"),
    "wheel_reach_m": Range(0.0, 5.0, "m"),
    "jerk_mps3": Range(0.0, 1000.0, "m/s³"),
    "angular_jerk_radps3": Range(0.0, 4000.0, "rad/s³"),
}
DEFAULT_RANGES = {
    "speed_mps": Range(0.0, 10.0, "m/s"),
    "rate_radps": Range(0.0, 20.0, "rad/s"),
    "distance_m": Range(0.0, 100.0, "m"),
    "turn_rad": Range(0.0, 2.0 * math.pi, "rad"),
}
LIDAR_RANGES = {
    "x_m": Range(-5.0, 5.0, "m", with_low=True),
    "y_m": Range(-5.0, 5.0, "m", with_low=True),
    "yaw_rad": Range(-2.0 * math.pi, 2.0 * math.pi, "rad", with_low=True),
    "min_range_m": Range(0.0, 100.0, "m", with_low=True),
    "max_range_m": Range(0.0, 1000.0, "m"),
    "rate_hz": Range(0.0, 1000.0, "Hz"),
}
CIRCLE_RANGES = {
    "x_m": Range(-1000.0, 1000.0, "m", with_low=True),
    "y_m": Range(-1000.0, 1000.0, "m", with_low=True),
    "radius_m": Range(0.0, 1000.0, "m"),
}
CALIBRATION_RANGES = {
    "distance_scale": Range(0.2, 5.0, "", with_low=True),
    "turn_scale": Range(0.2, 5.0, "", with_low=True),
}
FENCE_RANGE = Range(-1000.0, 1000.0, "m", with_low=True)
BLIND_RANGE = Range(0.0, 10.0, "m/s", with_low=True)
PERCENT_RANGE = Range(0.0, 100.0, "%", with_low=True)
BUDGET_RANGES = {
    "max_distance_m": Range(0.0, 1e6, 'm, or "none"'),
    "max_time_s": Range(0.0, 1e6, 's, or "none"'),
}
SENSORS = ("odom", "scan", "imu")
TIMEOUT_RANGE = Range(0.0, 60.0, 's, or "forever"')
FOOTPRINT_RANGE = Range(-5.0, 5.0, "m", with_low=True)
WIRING_CHOICES = {
    "cmd_vel_type": ("Twist", "TwistStamped"),
    "odom_type": ("Odometry", "turtlesim/Pose"),
    "camera_type": ("Image", "CompressedImage"),
}
FOREVER = "forever"

SOURCE_MEANING = "where the number comes from: a document, a measurement, or that it is a cautious guess"
OPTIONAL_LIMITS = frozenset(
    {"min_turning_radius_m", "max_wheel_speed_mps", "wheel_reach_m", "jerk_mps3", "angular_jerk_radps3"}
)
_TOP = (
    "title",
    "kinematics",
    "approval",
    "footprint",
    "limits",
    "defaults",
    "lidar",
    "safety",
    "wiring",
    "calibration",
)
_LINE = re.compile(r"at line (\d+)")


def parse_profile(text: str, name: str, file: str = "") -> RobotProfile:
    """The profile called `name` in TOML `text`; `file` is what errors call it (`name` if empty).

    Raises ProfileError: no TOML, a field missing, unknown, of the wrong kind or out of range, or fields that
    contradict each other.
    """
    source = Source(file or name, text)
    top = Table(_toml(source), source)
    top.only(_TOP)
    limits, sources = _limits(top.table("limits"))
    profile = RobotProfile(
        name=name,
        title=top.text("title", "a name that people read"),
        kinematics=_literal(top.choice("kinematics", ("differential", "mecanum", "ackermann"))),
        limits=limits,
        defaults=Defaults(**_numbers(top.table("defaults"), DEFAULT_RANGES)),
        footprint=top.points("footprint", FOOTPRINT_RANGE),
        wiring=_wiring(top.table("wiring")) if "wiring" in top else Wiring(),
        lidar=_lidar(top.table("lidar")) if "lidar" in top else None,
        safety=_safety(top.table("safety")) if "safety" in top else Safety(),
        calibration=_calibration(top.table("calibration")) if "calibration" in top else Calibration(),
        approval=_literal(top.choice("approval", ("plan", "stream"))) if "approval" in top else "plan",
        sources=sources,
    )
    check(profile, source.fail)
    return profile


def _literal(choice: str) -> Any:
    """A checked choice as the Literal it is: the type checker cannot follow the check."""
    return choice


def _toml(source: Source) -> dict[str, Any]:
    try:
        return tomllib.loads(source.text)
    except ValueError as error:
        line = _LINE.search(str(error))
        where = dataclasses.replace(source, file=f"{source.file}:{line[1]}") if line else source
        where.fail("", f"this is not TOML: {error}", "see docs/robots.md and the built-in profiles")


def _numbers(table: Table, ranges: dict[str, Range]) -> dict[str, float]:
    table.only(tuple(ranges))
    return {key: table.number(key, allowed) for key, allowed in ranges.items()}


def _limits(table: Table) -> tuple[Limits, dict[str, str]]:
    table.only(tuple(LIMIT_RANGES))
    values: dict[str, float] = {}
    sources: dict[str, str] = {}
    for key, allowed in LIMIT_RANGES.items():
        if key in OPTIONAL_LIMITS and key not in table:
            continue
        limit = table.table(key)
        limit.only(("value", "source"))
        values[key] = limit.number("value", allowed)
        sources[key] = limit.text("source", SOURCE_MEANING)
    return Limits(**values), sources


def _lidar(table: Table) -> Lidar:
    table.only((*LIDAR_RANGES, "beams"))
    numbers = {key: table.number(key, allowed) for key, allowed in LIDAR_RANGES.items()}
    return Lidar(**numbers, beams=table.integer("beams", 1, 100_000))


def _safety(table: Table) -> Safety:
    known = [field.name for field in dataclasses.fields(Safety) if field.name != "budget"]
    table.only((*known, *BUDGET_RANGES))
    values: dict[str, Any] = {"budget": MotionBudget(**_budget(table))}
    if "fence" in table:
        values["fence"] = _fence(table)
    if "requires" in table:
        values["requires"] = table.choices("requires", SENSORS)
    if "blind_speed_mps" in table:
        values["blind_speed_mps"] = table.number("blind_speed_mps", BLIND_RANGE)
    if "battery_low_percent" in table:
        values["battery_low_percent"] = table.number("battery_low_percent", PERCENT_RANGE)
    return Safety(**values)


def _budget(table: Table) -> dict[str, float]:
    return {
        key: math.inf if table.is_none(key) else table.number(key, allowed)
        for key, allowed in BUDGET_RANGES.items()
        if key in table
    }


def _calibration(table: Table) -> Calibration:
    table.only((*CALIBRATION_RANGES, "source"))
    scales = {key: table.number(key, allowed) for key, allowed in CALIBRATION_RANGES.items()}
    return Calibration(**scales, source=table.text("source", SOURCE_MEANING))


def _fence(table: Table) -> Circle | tuple[Point, ...]:
    if table.is_table("fence"):
        circle = table.table("fence")
        return Circle(**_numbers(circle, CIRCLE_RANGES))
    return table.points("fence", FENCE_RANGE)


def _wiring(table: Table) -> Wiring:
    known = tuple(field.name for field in dataclasses.fields(Wiring))
    table.only(known)
    values: dict[str, Any] = {}
    for key in known:
        if key not in table:
            continue
        if key == "base_timeout_s":
            values[key] = None if table.is_text(key, FOREVER) else table.number(key, TIMEOUT_RANGE)
        elif key == "odom_topic" and table.is_none(key):
            values[key] = ""
        elif key == "namespace":
            values[key] = table.topic(key).strip("/")
        elif key in WIRING_CHOICES:
            values[key] = table.choice(key, WIRING_CHOICES[key])
        else:
            values[key] = table.topic(key)
    return Wiring(**values)
