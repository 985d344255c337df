"""A conversation on simulated time, for tests."""

from __future__ import annotations

from collections.abc import Callable

from chatrobot.compose import Connection, Setup, connect
from chatrobot.core.events import Event, Result, TruePose
from chatrobot.dialogue.options import Options


class Talk:
    """A session on simulated time, and everything it told."""

    def __init__(self, **setup: object) -> None:
        self.events: list[Event] = []
        given = Setup(**{"world": "empty", "fast": True, "trace": True, **setup})  # type: ignore[arg-type]
        self.connection: Connection = connect(given, self.events.append)
        self.session = self.connection.session

    def do(self, text: str) -> Result:
        return self.session.do(text)

    def pump_until(self, done: Callable[[], bool]) -> None:
        for _ in range(100_000):
            if done():
                return
            self.session.pump(0.02)
        raise AssertionError("it did not come to pass")

    def pump_until_moving(self) -> None:
        """Until it drives at 0.1 m/s, in truth."""
        self.pump_until(lambda: any(isinstance(e, TruePose) and e.vx_mps > 0.1 for e in self.events))

    def results(self) -> dict[int, Result]:
        return {event.turn: event for event in self.events if isinstance(event, Result)}


def said_while_moving(first: str, then: str) -> Talk:
    """At the keyboard: `then` is said while the robot does `first`; both have ended."""
    talk = Talk(options=Options(while_moving="replace"))
    talk.session.say(first)
    talk.pump_until_moving()
    talk.session.say(then)
    talk.pump_until(lambda: len(talk.results()) == 2)
    return talk
