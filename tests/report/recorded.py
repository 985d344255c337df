"""Recordings for tests: written by hand, or of a session in simulated time."""

from __future__ import annotations

import argparse
import json
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from chatrobot.cli.recorder import recorded
from chatrobot.compose import Setup
from chatrobot.core.events import Event, TruePose
from chatrobot.dialogue.options import Options
from chatrobot.recording import topics
from chatrobot.recording.about import about_of
from chatrobot.recording.topics import Topic
from chatrobot.recording.writer import RecordingWriter
from chatrobot.robots.load import load_profile
from chatrobot.sim.load import load_world
from chatrobot.wire.messages import Message, Text

BEGAN_NS = 1_790_000_000 * 10**9
Timed = tuple[float, Topic, Message]
STOP_AFTER_S = 7.0
SAID = (
    "go to the kitchen",  # stopped after `STOP_AFTER_S`
    "linear.x = 2.5,linear.y = 0,angular.z = 0",  # limited
    "forward 20 m",  # refused
    "write a program that drives backwards at 0.3 m/s for 2 seconds",
)


def told(t_s: float, event: Event | dict[str, Any]) -> Timed:
    """An event at that time."""
    data = event.to_json() if isinstance(event, Event) else event
    return t_s, topics.EVENTS, Text(json.dumps(data, allow_nan=False))


def heard(t_s: float, turn: int, text: str) -> Timed:
    """A person's words at that time."""
    return told(t_s, {"event": "heard", "turn": turn, "text": text})


def write(path: Path, messages: Iterable[Timed], *, language: str = "en", world: str = "home") -> Path:
    """Write a recording of the default robot."""
    about = about_of(load_profile("wheeltec_mini_mec"), load_world(world), on="sim", language=language)
    with path.open("wb") as file:
        writer = RecordingWriter(file, about, str)
        for index, (t_s, topic, message) in enumerate(messages):
            writer.write(topic, message, BEGAN_NS + round(t_s * 1e9))
            if index % 200 == 0:
                writer.flush()
        writer.close()
    return path


def session(path: Path, said: Iterable[str] = SAID, sim: str = "") -> Path:
    """Record a session in simulated time, whose first instruction is stopped on its way."""
    now_s = 0.0

    def on_event(event: Event) -> None:
        nonlocal now_s
        now_s = event.t_s if isinstance(event, TruePose) else now_s

    choice = argparse.Namespace(record=str(path), no_record=False, config_dir=None)
    options = Options(ask_findings=False)
    setup = Setup(fast=True, trace=True, world="home", sim=sim, programs=True, options=options)
    connection = recorded(choice)(setup, on_event)
    talk = connection.session
    for number, text in enumerate(said):
        talk.say(text)
        while not talk.is_idle and (number or now_s < STOP_AFTER_S):
            talk.pump(0.02)
        if not talk.is_idle:
            talk.say("stop")
            while not talk.is_idle:
                talk.pump(0.02)
    connection.close()
    return path
