"""Starts the robot's processes before the rest of a command is loaded, and shows what is waited for."""

from __future__ import annotations

import argparse
import os
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

from chatrobot.cli.lines import TypedAhead, has_keyboard
from chatrobot.link.processes import SIMULATED, Processes
from chatrobot.robots.profile import MotionBudget

if TYPE_CHECKING:
    from chatrobot.robots.profile import RobotProfile

COMMANDS = ("", "do", "mcp", "web")
STDOUT = 1
_CLEAR_LINE = "\r\x1b[K"


class Early:
    """The processes of a simulated robot in real time, None for any other; a line that says what is waited for; and
    what is typed meanwhile."""

    def __init__(self, args: argparse.Namespace) -> None:
        self.processes: Processes | None = None
        self.typed_ahead = TypedAhead()
        self._is_shown = False
        if not args.command and not args.json and has_keyboard():
            self.typed_ahead.start()
        profile = self._checked(args)
        if args.command != "mcp" and not args.json and os.isatty(STDOUT):
            self._show(profile.title)

    def _checked(self, args: argparse.Namespace) -> RobotProfile:
        """Check all that the robot's processes are told, start them, and return the robot's profile.

        Raises:
            InputError: a profile, world or option is wrong.
        """
        from chatrobot.cli.folders import profile_folders
        from chatrobot.robots.load import load_profile, profile_argument
        from chatrobot.robots.open_loop import as_chosen

        folders = profile_folders(args)
        budget = MotionBudget(args.max_distance, args.max_time)
        profile = as_chosen(load_profile(args.robot, folders), budget, open_loop=args.open_loop)
        if args.on in SIMULATED:
            from chatrobot.sim.fault_injection import FaultInjection
            from chatrobot.sim.load import load_world
            from chatrobot.sim.world import check_known

            world = args.world or ("empty" if args.open_loop else "home")
            check_known(load_world(world), profile)
            FaultInjection.parse(args.sim)
            self.processes = Processes.start(
                profile_argument(args.robot, folders), world, args.sim, budget, open_loop=args.open_loop
            )
        return profile

    def _show(self, title: str) -> None:
        from chatrobot.cli.console.words import Words, language_of_environment

        columns = os.get_terminal_size(STDOUT).columns or 80
        line = Words(language_of_environment()).say("starting", title=title)
        self._write(line[: columns - 1])  # a longer one could not be cleared
        self._is_shown = True

    def ready(self) -> None:
        """Clear the line: the robot can be told what to do."""
        if self._is_shown:
            self._is_shown = False
            is_plain = os.environ.get("TERM", "dumb") == "dumb" or "NO_COLOR" in os.environ
            self._write("\n" if is_plain else _CLEAR_LINE)

    def close(self) -> None:
        """End what no session has taken."""
        self.ready()
        if self.processes is not None and not self.processes.is_taken:
            self.processes.end()

    @staticmethod
    def _write(text: str) -> None:
        os.write(STDOUT, text.encode("utf-8", errors="replace"))


@contextmanager
def started_early(args: argparse.Namespace) -> Iterator[None]:
    """Within it `args.early` is there for a command that moves a robot in real time."""
    if args.command == "mcp":
        from chatrobot.cli.attach import attachable

        args.host_line = attachable(args)
    of_its_own = ("host_line", "pupils", "lesson")
    starts_its_own = any(getattr(args, name, None) for name in of_its_own)
    needs_robot = args.command in COMMANDS and not args.fast and not starts_its_own
    early = Early(args) if needs_robot else None
    args.early = early
    try:
        yield
    finally:
        if early is not None:
            early.close()
