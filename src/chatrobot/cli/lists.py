"""Commands that list what there is: `chatrobot robots`, `worlds`, `usage` and `schema`."""

from __future__ import annotations

import argparse
from collections.abc import Iterator
from dataclasses import asdict
from typing import TYPE_CHECKING

from chatrobot.cli.folders import config_folder, profile_folders
from chatrobot.cli.json_lines import json_line
from chatrobot.core.errors import ProfileError
from chatrobot.core.reason import printable
from chatrobot.robots.load import ProfileEntry, list_profiles
from chatrobot.robots.profile import RobotProfile

if TYPE_CHECKING:
    from chatrobot.models.usage import Total

_NAME_COLUMNS, _TITLE_COLUMNS = 21, 30


def robots(args: argparse.Namespace) -> int:
    """List the robots that there is a profile for; 1 where one cannot be used: it is listed with what is wrong."""
    is_any_broken = False
    for entry in list_profiles(profile_folders(args)):
        try:
            profile = entry.load()
        except ProfileError as error:
            is_any_broken = True
            about: dict[str, object] = {"problem": str(error)}
            line = f"cannot be used: {error}"
        else:
            about, line = _robot_facts(profile), _robot_line(entry, profile)
        if args.json:
            said = {"event": "robot", "name": entry.name, "origin": entry.origin, "file": str(entry.file)}
            print(json_line({**said, **about}), end="")
        else:
            print(printable(f"{entry.name:<{_NAME_COLUMNS}}{line}"))
    return 1 if is_any_broken else 0


def robot_titles(args: argparse.Namespace) -> Iterator[tuple[str, str]]:
    """Every profile's name and the robot's title; "" where the profile cannot be used."""
    for entry in list_profiles(profile_folders(args)):
        try:
            yield entry.name, entry.load().title
        except ProfileError:
            yield entry.name, ""


def _robot_facts(profile: RobotProfile) -> dict[str, object]:
    return {
        "title": profile.title,
        "kinematics": profile.kinematics,
        "max_speed_mps": profile.limits.max_speed_mps,
        "max_rate_radps": profile.limits.max_rate_radps,
        "has_lidar": profile.lidar is not None,
    }


def _robot_line(entry: ProfileEntry, profile: RobotProfile) -> str:
    limits = profile.limits
    parts = [profile.kinematics, f"{limits.max_speed_mps:g} m/s", f"{limits.max_rate_radps:g} rad/s"]
    if profile.lidar is not None:
        parts.append("lidar")
    if entry.origin != "built-in":
        parts.append(f"yours: {entry.file}" if entry.origin == "user" else "from a package")
    return f"{profile.title:<{_TITLE_COLUMNS}}{', '.join(parts)}"


def worlds(args: argparse.Namespace) -> int:
    """List the worlds for the simulated robot. Always 0."""
    from chatrobot.cli.world import list_worlds

    return list_worlds(args)


def usage(args: argparse.Namespace) -> int:
    """Add up tokens and cost of language models, by session, model or day. Always 0."""
    from chatrobot.models.usage import Total, check_prices, totals

    folder = config_folder(args)
    check_prices(folder)
    found = totals(folder, args.by)
    if args.json:
        for name, total in found.items():
            print(json_line({"event": "usage", args.by: name, **asdict(total)}), end="")
        return 0
    if not found:
        print("no language model has been asked yet")
        return 0
    print(f"{args.by:<30} {'calls':>6} {'prompt':>9} {'cached':>9} {'reply':>9} {'cost':>12}")
    whole = Total()
    for name, total in found.items():
        print(_usage_row(name, total))
        whole.join(total)
    print(_usage_row("all", whole))
    print("tokens; US dollars at the list prices known when each call was made (“?”: a price is unknown)")
    return 0


def _usage_row(name: str, total: Total) -> str:
    counts = f"{total.calls:6d} {total.prompt_tokens:9d} {total.cached_tokens:9d} {total.reply_tokens:9d}"
    cost = f"{total.cost_usd:.4f}{' +?' if total.unpriced else ''}"
    return f"{name or '?':<30} {counts} {'?' if total.unpriced == total.calls else cost:>12}"


def schema(_: argparse.Namespace) -> int:
    """Print the JSON schema of plans, for tools and models. Always 0."""
    import json

    from chatrobot.plan.json_form import plan_schema

    print(json.dumps(plan_schema(), indent=2, ensure_ascii=False))
    return 0
