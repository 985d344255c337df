"""`chatrobot replay FILE`: shows a recording again, in the terminal or in a browser. No robot is there to be moved."""

from __future__ import annotations

import argparse
import contextlib
import sys
import time
from collections.abc import Callable

from chatrobot.cli.console.motion_view import MotionView
from chatrobot.cli.console.tables import way_map
from chatrobot.cli.console.words import language_of_environment
from chatrobot.cli.entry import STOPPED, forget_stdout
from chatrobot.cli.folders import profile_folders
from chatrobot.cli.human import HumanPrinter
from chatrobot.cli.json_lines import Output, json_line
from chatrobot.cli.recorder import read_recording
from chatrobot.cli.report.summary import words_in
from chatrobot.cli.signals import SignalWatch
from chatrobot.core.errors import InputError, UsageError
from chatrobot.core.reason import printable
from chatrobot.language.interpretation import LanguageCode, language_of_tags
from chatrobot.recording.about import world_of
from chatrobot.recording.playback import TELEMETRY_S, Heard, Shown, play, shown
from chatrobot.recording.reader import Recording
from chatrobot.robots.load import DEFAULT_PROFILE, load_profile
from chatrobot.robots.profile import RobotProfile

Show = Callable[[float, Shown], None]


def run(args: argparse.Namespace) -> int:
    """Return 0 at the end of the recording, 5 where somebody ended it before.

    Raises:
        InputError: it is no recording.
    """
    recording, amiss = read_recording(args.file)
    if amiss:
        language = language_of_tags(recording.meta.get("language", ""))
        print(f"chatrobot: {words_in(language)(amiss)}", file=sys.stderr)
    if args.web:
        return _show_in_browser(args, recording)
    output = Output()
    show: Show = _in_json(output) if args.json else _Screen(output, recording).show
    with SignalWatch(lambda _: None) as watch:
        play(shown(recording), args.speed, show, lambda: not (watch.is_leaving or output.is_broken))
        has_left = watch.is_leaving
    if output.is_broken:
        forget_stdout()
        return STOPPED
    if isinstance(screen := getattr(show, "__self__", None), _Screen):
        screen.end()
    return STOPPED if has_left else 0


def _in_json(output: Output) -> Show:
    """One JSON object a line: each event as it was, with its seconds since the recording began (`recorded_s`)."""

    def show(t_s: float, item: Shown) -> None:
        data = {"event": "heard", **item._asdict()} if isinstance(item, Heard) else item.to_json()
        output.write(json_line({**data, "recorded_s": round(t_s, 3)}))

    return show


class _Screen:
    """A terminal: events as a command prints them, where the robot is while it moves, and a map at the end."""

    def __init__(self, output: Output, recording: Recording) -> None:
        meta = recording.meta
        self._language: LanguageCode = language_of_tags(meta.get("language", ""))
        self._printer = HumanPrinter(output, shows_pose=True)
        self._motion_view = MotionView()
        self._trail: list[tuple[float, float]] = []
        self._world = world_of(meta)
        title, world = meta.get("title", "a robot"), meta.get("world", "")
        where = f" in {world}" if world else ""
        output.write(printable(f"{title}{where}{self._when(recording)}\n"))

    def _when(self, recording: Recording) -> str:
        if not recording.began_ns:
            return f": {words_in(self._language)('nothing')}"
        when = time.strftime("%Y-%m-%d %H:%M:%S", time.localtime(recording.began_ns / 1e9))
        return f", {when}, {recording.duration_s:.1f} s"

    def show(self, _t_s: float, item: Shown) -> None:
        """Show one thing."""
        if isinstance(item, Heard):
            if item.text:
                self._printer.turn(item.text)
            return
        self._motion_view.hear(item)
        here = (self._motion_view.pose.x_m, self._motion_view.pose.y_m)
        if not self._trail or abs(here[0] - self._trail[-1][0]) + abs(here[1] - self._trail[-1][1]) > 0.03:
            self._trail.append(here)
        self._printer.show(item, self._language)

    def end(self) -> None:
        """Draw where it went."""
        from rich.console import Console

        self._printer.clear()
        if len(self._trail) > 1:
            self._motion_view.trail = tuple(self._trail)
            self._motion_view.path = self._motion_view.trail
            Console(highlight=False).print(way_map(self._motion_view, self._world))


def _profile(args: argparse.Namespace, recording: Recording) -> RobotProfile:
    """Return the robot that the recording is of, the usual one where it is not known here."""
    with contextlib.suppress(InputError):
        return load_profile(recording.meta.get("robot", DEFAULT_PROFILE), profile_folders(args))
    name = recording.meta.get("robot")
    print(f"no profile {name!r} here: drawn as {DEFAULT_PROFILE}", file=sys.stderr)
    return load_profile(DEFAULT_PROFILE, ())


def _show_in_browser(args: argparse.Namespace, recording: Recording) -> int:
    """Serve a page that shows it, until Ctrl-C. Whoever looks at it may only watch.

    Raises:
        UsageError: the web console is not installed, or no port is free.
    """
    try:
        from chatrobot.web.replayed import ReplayRoom, watching
        from chatrobot.web.server import WebServer
    except ImportError as error:
        problem = f"the web console is not installed: {error.name} is missing"
        raise UsageError(problem, allowed="pip install 'chatrobot[web]'") from error
    from chatrobot.cli.web import listen
    from chatrobot.web.words import web_words

    profile, world = _profile(args, recording), world_of(recording.meta)
    access = watching()
    room = ReplayRoom(profile, world)
    server = WebServer(access, {room.name: room})
    with (
        contextlib.closing(listen(access.host, None)) as page,
        contextlib.closing(listen(access.host, 0)) as stop,
        SignalWatch(lambda _: None) as watch,
    ):
        server.start(page, stop)
        url = f"{access.origin(access.host)}/"
        print(web_words(language_of_environment(), "replay_address", url=url), flush=True)
        while not watch.is_leaving and not room.faces:  # somebody looks
            time.sleep(0.05)
        items = shown(recording, profile.lidar)
        play(items, args.speed, room.show, lambda: not (watch.is_leaving or room.is_halted))
        room.tell_end()
        while not watch.is_leaving:
            room.tell_again()
            time.sleep(TELEMETRY_S)
        server.close()
    return STOPPED
