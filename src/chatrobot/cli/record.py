"""`chatrobot record [FILE]`: records a robot that others drive, until Ctrl-C. It only listens."""

from __future__ import annotations

import argparse
import os
import sys
import threading
import time
from pathlib import Path

from chatrobot.cli.console.words import language_of_environment
from chatrobot.cli.entry import STOPPED
from chatrobot.cli.folders import profile_folders
from chatrobot.cli.recorder import data_folder, require_extra
from chatrobot.cli.signals import SignalWatch
from chatrobot.cli.status_line import status_line
from chatrobot.core.errors import UsageError
from chatrobot.language.phrases import render_reason
from chatrobot.link.topic_link import CHATGPT_NODE, EVENTS, TELEMETRY, USER_INPUT
from chatrobot.recording import topics
from chatrobot.recording.about import about_of
from chatrobot.recording.recorder import Recorder
from chatrobot.recording.redactor import Redactor
from chatrobot.recording.shelf import check_new, make_folder, make_room, new_path
from chatrobot.robots.load import load_profile
from chatrobot.sim.load import load_world
from chatrobot.sim.robot import TRUTH_TOPIC
from chatrobot.wire.connect import connect_wire, wire_address

NAME = "chatrobot_record"
SILENT_S = 3.0
_SILENCE = (
    "nothing has come for {:.0f} s: is the robot on, is this its address (--on), are these its topics (--robot)?"
    " Recording goes on."
)
_TEXTS = (
    (topics.USER_INPUT, USER_INPUT),
    (topics.CHATGPT_NODE, CHATGPT_NODE),
    (topics.EVENTS, EVENTS),
    (topics.EVENTS, TELEMETRY),
)


def run(args: argparse.Namespace) -> int:
    """Return 5 after Ctrl-C, 1 where the recording ended by itself.

    Raises:
        InputError: an option, the profile, the world or the file cannot be used.
        WireError: nobody answers on that wire.
    """
    require_extra()
    if args.on == "sim":
        raise UsageError(
            "a simulated robot of ours is recorded by who drives it",
            where="--on sim",
            allowed='chatrobot do "…" --record; or chatrobot sim, then chatrobot record --on local:PATH',
        )
    address = wire_address("dds" if args.on == "auto" else args.on)
    profile = load_profile(args.robot, profile_folders(args))
    world = load_world(args.world or "empty")
    path = check_new(Path(args.file)) if args.file else _free_path(args, profile.name)
    wire = connect_wire(address, profile.wiring, NAME)
    try:
        recorder = Recorder(path, Redactor(tuple, os.environ))
    except OSError:
        wire.close()
        raise
    recorder.listen(wire, profile.wiring, TRUTH_TOPIC)
    for topic, name in _TEXTS:
        recorder.subscribe(wire, topic, name)
    language = language_of_environment()
    recorder.start(lambda: about_of(profile, world, on=args.on, language=language))
    return _watch(recorder, f"{profile.title} on {address}")


def _free_path(args: argparse.Namespace, robot: str) -> Path:
    folder = make_folder(data_folder(args.config_dir))
    make_room(folder)
    return new_path(folder, robot)


def _watch(recorder: Recorder, title: str) -> int:
    print(f"Recording {title} to {recorder.path}; Ctrl-C ends it.", flush=True)
    ended = threading.Event()
    began_s = heard_s = time.monotonic()
    heard, is_told = 0, False
    with SignalWatch(lambda _: ended.set()), status_line() as line:
        while not (ended.wait(1.0) or recorder.is_over):
            if recorder.message_count != heard:
                heard, heard_s, is_told = recorder.message_count, time.monotonic(), False
            elif time.monotonic() - heard_s > SILENT_S and not is_told:
                is_told = True
                line.clear()
                print(_SILENCE.format(SILENT_S), file=sys.stderr, flush=True)
            line.show(f"  {_progress(recorder, began_s)}")
    recorder.close()
    print(f"{_progress(recorder, began_s)} in {recorder.path}", flush=True)
    has_failed = False
    for notice in recorder.notices():
        if notice.reason.code != "recording":
            has_failed = True
            print(render_reason(notice.reason, language_of_environment()), file=sys.stderr)
    return 1 if has_failed and not ended.is_set() else STOPPED


def _progress(recorder: Recorder, began_s: float) -> str:
    seconds, megabytes = time.monotonic() - began_s, recorder.size_bytes / 1e6
    heard = f"{recorder.message_count} messages" if recorder.message_count else "nothing heard yet"
    return f"{seconds:.0f} s, {heard}, {megabytes:.1f} MB"
