"""A session that writes and runs programs, on simulated time; `house` is the fixture."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

from tests.programs.scripted_model import ScriptedModel, program

from chatrobot.compose import Connection, Setup, connect
from chatrobot.core.events import (
    Event,
    ProgramWritten,
    Rehearsed,
    Result,
)
from chatrobot.programs.library import KeptProgram

ASKED = "Write a ROS 2 Python program that makes the robot dance as you like"
ARGUED = """
import time
import rclpy
from geometry_msgs.msg import Twist
rclpy.init()
node = rclpy.create_node("driver")
publisher = node.create_publisher(Twist, "velocity", 10)
twist = Twist()
twist.linear.x = node.declare_parameter("speed", 0.1).value
publisher.publish(twist)
time.sleep(1.0)
publisher.publish(Twist())
"""
DANCE = program("self.drive(0.2, 0.0, 1.0)\nself.drive(0.0, 0.5, 2.0)")

BROKEN = {
    "a syntax error": (DANCE.replace("def run(self):", "def run(self)"), "is not valid Python"),
    "an exception": (
        DANCE.replace("self.drive(0.2, 0.0, 1.0)", "self.drvie(0.2, 0.0, 1.0)"),
        "AttributeError",
    ),
    "a forbidden import": (DANCE.replace("import time", "import time, socket"), "socket"),
    "an unknown import": (DANCE.replace("import time", "import time, cv2"), "cv2"),
    "a limit": (DANCE.replace("0.2, 0.0, 1.0", "5.0, 0.0, 0.2"), "5.00 m/s"),
    "no stop at its end": (DANCE.replace("self.drive(0.0, 0.0, 1.0)", "pass"), "without stopping"),
}


class House:
    """A simulated robot on virtual time, with one warm box for many programs; each test tells it its own model."""

    def __init__(self, world: str, folder: Path) -> None:
        self.events: list[Event] = []
        self.on_event: Callable[[Event], None] = lambda _: None
        self.connection: Connection = connect(
            Setup(fast=True, trace=True, world=world, folder=folder, programs=True), self._hear
        )
        self.session = self.connection.session
        assert self.session.authoring is not None
        self.authoring = self.session.authoring

    def _hear(self, event: Event) -> None:
        self.events.append(event)
        self.on_event(event)

    def model(self, *replies: str) -> ScriptedModel:
        self.authoring.model = ScriptedModel(*replies)
        return self.authoring.model

    def do(self, text: str) -> Result:
        self.events.clear()
        return self.session.do(text)

    def run(self, code: str, name: str = "test") -> Result:
        self.events.clear()
        return self._end_of(self.session.say_draft(self.authoring.draft_of(KeptProgram(name, code))))

    def edit(self, name: str, code: str) -> Result:
        self.events.clear()
        return self._end_of(self.session.say_source(name, code))

    def _end_of(self, turn: int) -> Result:
        while turn not in self.session.results:
            self.session.pump(0.1)
        return self.session.results[turn]

    def all(self, kind: type[Any]) -> list[Any]:
        return [event for event in self.events if isinstance(event, kind)]

    @property
    def marks(self) -> list[str]:
        return [mark.reason.code for written in self.all(ProgramWritten) for mark in written.marks]

    @property
    def findings(self) -> list[str]:
        return [finding.reason.code for rehearsed in self.all(Rehearsed) for finding in rehearsed.findings]
