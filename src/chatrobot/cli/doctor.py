"""`chatrobot doctor`: what works here, measured where it can be, and how to get the rest."""

from __future__ import annotations

import argparse
import os
import platform
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING, Literal

from chatrobot import __version__
from chatrobot.cli.folders import config_folder, profile_folders
from chatrobot.core.errors import ChatRobotError
from chatrobot.options import DEFAULT_ROBOT

if TYPE_CHECKING:
    from chatrobot.compose import Setup

DISCOVERY_S = 0.6
State = Literal["ok", "missing", "later"]
_MARKS = {"ok": "✓", "missing": "✗", "later": "–"}


@dataclass(frozen=True)
class Check:
    """One line: `later` is what this version cannot do yet, `missing` what is wrong here and can be mended."""

    name: str
    state: State
    text: str


def run(args: argparse.Namespace) -> int:
    """Return 0 where the simulated robot works, 1 where something has to be mended."""
    checks: list[Check] = []
    for check in _checks(args):
        if args.json:
            from chatrobot.cli.json_lines import json_line

            print(json_line({"event": "check", **asdict(check)}), end="", flush=True)
        else:
            print(f"{_MARKS[check.state]} {check.name:<18}{_told_once(check, checks)}", flush=True)
        checks.append(check)
    return 1 if any(check.state == "missing" for check in checks) else 0


def _told_once(check: Check, before: Sequence[Check]) -> str:
    """Say what was found; where it is what an earlier check has found, which."""
    same = next((each.name for each in before if each.text == check.text), "")
    return f"as above: {same}" if same else check.text


def _checks(args: argparse.Namespace) -> Iterator[Check]:
    yield Check(
        "chatrobot", "ok", f"{__version__} on Python {platform.python_version()}, {platform.machine()}"
    )
    settings = _try("settings folder", lambda: _settings(args))
    yield settings
    if settings.state == "missing":
        return  # everything else looks there first
    places = _try("remembered places, words", lambda: _places(args))
    if places.state == "missing":
        yield places
    profile = _try("robot profile", lambda: _profile(args))
    yield profile
    if profile.state == "missing":
        args.robot = DEFAULT_ROBOT  # what else works is worth knowing
    yield _try("simulated robot", lambda: _simulated_robot(args))
    yield _try("in real time", lambda: _in_real_time(args))
    yield _ros(args)
    yield _dds(args)
    yield _model(args)
    yield _box()


def _try(name: str, check: Callable[[], str]) -> Check:
    try:
        return Check(name, "ok", check())
    except (ChatRobotError, OSError) as error:
        return Check(name, "missing", str(error))


def _settings(args: argparse.Namespace) -> str:
    folder = config_folder(args)
    there = next(path for path in (folder, *folder.absolute().parents) if path.exists())
    if not (there.is_dir() and os.access(there, os.W_OK)):
        raise ChatRobotError(f"{folder} cannot be written: choose another with --config-dir")
    return str(folder) if there == folder else f"{folder} (made when there is something to keep)"


def _places(args: argparse.Namespace) -> str:
    from chatrobot.dialogue.places import Places
    from chatrobot.dialogue.words import Words
    from chatrobot.language.phrases import render_reason

    kept = (kind(config_folder(args), args.robot, "") for kind in (Places, Words))
    unkept = next(filter(None, (one.take_unkept() for one in kept)), None)
    if unkept is not None:
        raise ChatRobotError(render_reason(unkept, "en"))
    return "kept"


def _profile(args: argparse.Namespace) -> str:
    from chatrobot.robots.load import load_profile

    return f"{args.robot}: {load_profile(args.robot, profile_folders(args)).title}"


def _setup(args: argparse.Namespace, *, fast: bool) -> Setup:
    """Return the simulated robot in an empty world."""
    from chatrobot.compose import Setup
    from chatrobot.robots.load import profile_argument

    robot = profile_argument(args.robot, profile_folders(args))
    return Setup(robot=robot, world="empty", fast=fast)


def _simulated_robot(args: argparse.Namespace) -> str:
    """Drive a metre on a virtual clock."""
    from chatrobot.compose import connect

    began_s = time.monotonic()
    connection = connect(_setup(args, fast=True), lambda _: None)
    result = connection.session.do("forward 1 m")
    connection.close()
    if result.outcome != "completed":
        raise ChatRobotError(f"it did not drive a metre: {result.reply}")
    return f"{args.robot} drove {result.path_m:.3f} m of 1 m, simulated in {time.monotonic() - began_s:.2f} s"


def _in_real_time(args: argparse.Namespace) -> str:
    """Start all processes, as `chatrobot do` would, and end them again."""
    from chatrobot.compose import connect

    began_s = time.monotonic()
    connection = connect(_setup(args, fast=False), lambda _: None)
    ready_s = time.monotonic() - began_s
    connection.close()
    return f"robot, control loop and guard run {ready_s:.2f} s after they are asked to"


def _ros(args: argparse.Namespace) -> Check:
    """Look what is sourced here, and who is there in a moment's listening."""
    from importlib.util import find_spec

    from chatrobot.wire.discovery import ros_reaches_this_machine_alone
    from chatrobot.wire.ros import HOW_TO_GET_IT

    distribution = os.environ.get("ROS_DISTRO", "")
    if find_spec("rclpy") is None:
        here = (
            f"{distribution} is sourced, but not for this Python"
            if distribution
            else "not installed, and not needed for the simulated robot"
        )
        return Check("ROS 2", "later", f"{here}; for --on ros {HOW_TO_GET_IT}")
    try:
        from rclpy.utilities import get_rmw_implementation_identifier

        works = f"{distribution} with {get_rmw_implementation_identifier()}".lstrip()
        found = _found("ros:", args, is_near=ros_reaches_this_machine_alone(os.environ))
    except (ChatRobotError, ImportError, RuntimeError) as error:
        return Check("ROS 2", "later", f"{distribution} does not work with this Python: {error}")
    return Check("ROS 2", "ok", f"{works}; {found}")


def _dds(args: argparse.Namespace) -> Check:
    """Look who is there in a moment's listening."""
    from chatrobot.wire.connect import is_on_this_machine

    try:
        return Check("DDS", "ok", f"works; {_found('dds:', args, is_near=is_on_this_machine('dds:'))}")
    except (ChatRobotError, OSError) as error:
        return Check("DDS", "later", str(error))


def _found(address: str, args: argparse.Namespace, *, is_near: bool) -> str:
    """Say how far that wire reaches, who publishes the robot's odometry there, and who its velocities."""
    from chatrobot.language.phrases import render_reason
    from chatrobot.motion.topic_discovery import why_unheard
    from chatrobot.robots.load import load_profile
    from chatrobot.wire.connect import connect_wire

    wiring = load_profile(args.robot, profile_folders(args)).wiring
    wire = connect_wire(address, wiring, "chatrobot_doctor")
    ends_s = time.monotonic() + DISCOVERY_S
    robots: list[str] = []
    while not robots and time.monotonic() < ends_s:
        time.sleep(0.05)
        robots = wire.publishers_of(wiring.odom_topic) if wiring.odom_topic else []
    drivers = wire.publishers_of(wiring.cmd_vel_topic)
    told = None if robots else why_unheard(wiring, wire.survey(), wire.resolve)
    wire.close()
    reach = f"on domain {os.environ.get('ROS_DOMAIN_ID', '').strip() or '0'}, "
    reach += "this machine" if is_near else "the whole network"
    text = f"{reach}, {', '.join(robots) or 'nobody'} publishes {wiring.odom_topic or 'odometry'}"
    text += f"; {', '.join(drivers)} publishes {wiring.cmd_vel_topic}" if drivers else ""
    return f"{text}. {render_reason(told, 'en')}" if told is not None else text


def _model(args: argparse.Namespace) -> Check:
    """Name the model that would be asked; to ask it may cost: `chatrobot model test` does."""
    from chatrobot.language.phrases import render_reason
    from chatrobot.models.config import ModelConfig, resolve
    from chatrobot.models.make import problem_with

    config = ModelConfig(folder=config_folder(args))
    try:
        choice = resolve(args.model, config)
    except ChatRobotError as error:
        return Check("language model", "missing", str(error))
    if choice is None:
        text = (
            "none is set up (chatrobot model does it); English, Chinese and German are understood without one"
        )
        return Check("language model", "later", text)
    problem = problem_with(choice.name, config)
    if problem is not None:
        text = render_reason(problem, "en")
        return Check("language model", "missing", text if choice.name in text else f"{choice.name}: {text}")
    sources = {"option": "--model", "environment": "CHATROBOT_MODEL", "stored": "chatrobot model use"}
    source = sources[choice.source]
    return Check("language model", "ok", f"{choice.name}, by {source}; chatrobot model test tries it")


_MORE = {
    "landlock": "Landlock: Linux 5.13 or later with lsm=landlock among the kernel's boot options",
    "own user": "a user of its own: start it as an ordinary user, or in a container that has more users than root",
    "namespaces": "namespaces: install bubblewrap, or allow user namespaces (in a container: its seccomp profile)",
}
"""How to get the walls that do not stand here."""


def _box() -> Check:
    """Build the sandbox around nothing, and see which walls stand."""
    from chatrobot.sandbox.warm_server import probe

    report = probe()
    if report.refusal is not None:
        missing = report.problems.get("seccomp") or str(dict(report.refusal.values))
        return Check("sandbox", "missing", f"none, so programs are refused: {missing}")
    walls = ", ".join(("filter", "limits", *(each for each in report.standing if each != "seccomp")))
    wanting = [each for each in _MORE if each not in report.standing]
    if "bubblewrap" in report.standing:
        wanting.remove("namespaces")
    more = "".join(f"; more with {_MORE[each]}" for each in wanting)
    return Check("sandbox", "ok", f"{report.level}: {walls}{more}")
