"""The wire to a robot that may be gone for a while: wait for it, outlive its absence, notice its return."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import NamedTuple

from chatrobot.core.errors import WireError
from chatrobot.core.reason import Reason
from chatrobot.core.wiring import Wiring
from chatrobot.motion.topic_discovery import fit, is_complete
from chatrobot.wire.connect import (
    Connect,
    Endpoint,
    Returning,
    Surveying,
    advertise,
    comes_back,
    has_null_ranges,
    publishers_of,
    resolved,
)
from chatrobot.wire.messages import Message, TwistMessage
from chatrobot.wire.wire import M, Wire

CONNECT_S = 20.0
SURVEY_S = 0.8
"""A robot that is there is found within this time; one that comes later is taken to be as its profile says."""
LOOK_S = 0.05


class ReconnectingWire:
    """A wire whose other end may return: what cannot be sent meanwhile is dropped, as on every other wire.

    `on_gone` is called once for each time that it goes, by whatever thread finds out.
    """

    def __init__(self, wire: Wire) -> None:
        self._wire = wire
        self._is_gone = False
        self.on_gone: Callable[[], None] = lambda: None

    def publish(self, topic: str, message: Message) -> None:
        try:
            self._wire.publish(topic, message)
        except WireError:
            was_gone, self._is_gone = self._is_gone, True
            if not was_gone:
                self.on_gone()
        else:
            self._is_gone = False

    def subscribe(self, topic: str, kind: type[M], callback: Callable[[M], None]) -> None:
        self._wire.subscribe(topic, kind, callback)

    def close(self) -> None:
        self._wire.close()

    @property
    def is_connected(self) -> bool:
        return is_up(self._wire)

    @property
    def has_null_ranges(self) -> bool:
        return has_null_ranges(self._wire)

    def resolve(self, topic: str) -> str:
        return resolved(self._wire, topic)

    def publishers_of(self, topic: str) -> list[str]:
        return publishers_of(self._wire, topic)

    def survey(self) -> list[Endpoint]:
        return self._wire.survey() if isinstance(self._wire, Surveying) else []

    def rewire(self, wiring: Wiring) -> None:
        if isinstance(self._wire, Surveying):
            self._wire.rewire(wiring)


def is_up(wire: Wire) -> bool:
    """Whether the other end is there, as far as this wire can know."""
    return wire.is_connected if isinstance(wire, Returning) else True


class Reached(NamedTuple):
    """A robot's wire, its wiring as the wire shows it, and what a person should know of the differences."""

    wire: Wire
    wiring: Wiring
    said: list[Reason]


def reach(connect: Connect, address: str, wiring: Wiring, node: str) -> Reached:
    """The robot's wire; it may still be starting.

    Raises:
        WireError: nobody answers for `CONNECT_S`.
    """
    wire = _connect_patiently(connect, address, wiring, node)
    fitted, said = _survey(wire, wiring)
    advertise(wire, fitted.cmd_vel_topic, TwistMessage)
    return Reached(ReconnectingWire(wire) if comes_back(wire) else wire, fitted, said)


def _connect_patiently(connect: Connect, address: str, wiring: Wiring, node: str) -> Wire:
    deadline_s = time.monotonic() + CONNECT_S
    while True:
        try:
            return connect(address, wiring, node)
        except WireError:
            if time.monotonic() > deadline_s:
                raise
            time.sleep(0.01)


def _survey(wire: Wire, wiring: Wiring) -> tuple[Wiring, list[Reason]]:
    """How the robot is wired, where the wire can tell."""
    if not isinstance(wire, Surveying):
        return wiring, []
    deadline_s = time.monotonic() + SURVEY_S
    while time.monotonic() < deadline_s:
        if is_complete(wiring, wire.survey(), wire.resolve):
            return wiring, []
        time.sleep(LOOK_S)
    fitted, said = fit(wiring, wire.survey(), wire.resolve)
    wire.rewire(fitted)
    return fitted, said
