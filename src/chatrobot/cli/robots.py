"""`chatrobot robots`: the robots that there is a profile for, a line each."""

from __future__ import annotations

import argparse
from collections.abc import Iterator

from chatrobot.cli.folders import profile_folders
from chatrobot.cli.json_lines import json_line
from chatrobot.core.errors import ProfileError
from chatrobot.robots.load import ProfileEntry, list_profiles
from chatrobot.robots.profile import RobotProfile

_NAME_COLUMNS, _TITLE_COLUMNS = 21, 30


def run(args: argparse.Namespace) -> int:
    """0, or 1 where a profile cannot be used: it is listed with what is wrong."""
    is_any_broken = False
    for entry in list_profiles(profile_folders(args)):
        try:
            profile = entry.load()
        except ProfileError as error:
            is_any_broken = True
            about: dict[str, object] = {"problem": str(error)}
            line = f"cannot be used: {error}"
        else:
            about, line = _facts(profile), _line(entry, profile)
        if args.json:
            said = {"event": "robot", "name": entry.name, "origin": entry.origin, "file": str(entry.file)}
            print(json_line({**said, **about}), end="")
        else:
            print(f"{entry.name:<{_NAME_COLUMNS}}{line}")
    return 1 if is_any_broken else 0


def entries(args: argparse.Namespace) -> Iterator[tuple[ProfileEntry, str]]:
    """Every profile and the robot's title; "" where the profile cannot be used."""
    for entry in list_profiles(profile_folders(args)):
        try:
            yield entry, entry.load().title
        except ProfileError:
            yield entry, ""


def _facts(profile: RobotProfile) -> dict[str, object]:
    return {
        "title": profile.title,
        "kinematics": profile.kinematics,
        "max_speed_mps": profile.limits.max_speed_mps,
        "max_rate_radps": profile.limits.max_rate_radps,
        "has_lidar": profile.lidar is not None,
    }


def _line(entry: ProfileEntry, profile: RobotProfile) -> str:
    limits = profile.limits
    parts = [profile.kinematics, f"{limits.max_speed_mps:g} m/s", f"{limits.max_rate_radps:g} rad/s"]
    if profile.lidar is not None:
        parts.append("lidar")
    if entry.origin != "built-in":
        parts.append(f"yours: {entry.file}" if entry.origin == "user" else "from a package")
    return f"{profile.title:<{_TITLE_COLUMNS}}{', '.join(parts)}"
