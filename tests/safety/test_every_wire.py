"""The safety suite over every wire: each profile on each backend, the sources in turn, to a listener at the far end.

A backend gets these tests by being one that `connect_wire` knows: it has to be listed here, or this fails. The whole
matrix of profiles and sources runs on the wire within this process (test_every_robot.py).
"""

from __future__ import annotations

import contextlib
import inspect
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from chatrobot.governor.lease import PRIORITIES
from chatrobot.robots.load import ProfileEntry, list_profiles
from chatrobot.robots.profile import Wiring
from chatrobot.wire.connect import MODULES
from chatrobot.wire.messages import TwistMessage
from chatrobot.wire.wire import Wire
from tests.safety import test_every_robot as suite
from tests.safety.driven import Driven

Wired = tuple[Callable[[], Wire], Callable[[], None]]
"""Makes a further end of one wire; waits until those who have subscribed are heard of."""

CHECKS = (
    suite.test_nothing_moves_before_it_begins,
    suite.test_zero_comes_at_once_from_full_speed,
    suite.test_a_stop_voids_what_was_minted_and_the_motion_has_to_begin_again,
    suite.test_an_emergency_stop_holds_whoever_asks_until_a_person_releases_it,
    suite.test_a_lease_that_ends_or_lapses_ends_the_motion,
    suite.test_a_clock_that_goes_back_stops_the_robot,
    suite.test_a_wall_of_returns_is_not_driven_into,
)
"""Those whose many messages are worth a real wire; what they show of the rest does not hang on what carries it."""

SOURCES = [*PRIORITIES, "one that nobody has heard of"]
ENTRIES = list_profiles()


@contextlib.contextmanager
def local(_: Wiring, folder: Path) -> Iterator[Wired]:
    import threading

    from chatrobot.wire.local import LocalHub, LocalWire

    hub, ended, wires = LocalHub(folder / "wire"), threading.Event(), list[LocalWire]()

    def serve() -> None:
        while not ended.is_set():
            hub.poll(0.05)

    thread = threading.Thread(target=serve)
    thread.start()

    def connect() -> LocalWire:
        wires.append(LocalWire(folder / "wire"))
        return wires[-1]

    yield connect, lambda: None
    for wire in wires:
        wire.close()
    ended.set()
    thread.join()
    hub.close()


@contextlib.contextmanager
def dds(wiring: Wiring, _: Path) -> Iterator[Wired]:
    pytest.importorskip("cyclonedds", reason="cyclonedds has no wheel for this machine or Python")
    from tests.wire.dds_rig import Ends

    ends = Ends(wiring)
    yield ends.connect, lambda: None
    ends.close()


@contextlib.contextmanager
def rosbridge(wiring: Wiring, _: Path) -> Iterator[Wired]:
    pytest.importorskip("websockets", reason="pip install 'chatrobot[rosbridge]'")
    from chatrobot.wire.rosbridge.wire import RosbridgeWire
    from tests.wire.fake_rosbridge import FakeRosbridge

    server, wires = FakeRosbridge(), list[RosbridgeWire]()

    def connect() -> RosbridgeWire:
        wires.append(RosbridgeWire(server.url, wiring))
        return wires[-1]

    def settle() -> None:
        assert server.wait_for("subscribe", 1, 10.0)

    yield connect, settle
    for wire in wires:
        wire.close()
    server.stop()


WIRES = {"local": local, "dds": dds, "rosbridge": rosbridge}
ELSEWHERE = {"ros": "rclpy is in no package registry; tests/wire/test_wire_ros.py has a stand-in"}


def test_every_backend_is_in_this_suite() -> None:
    assert MODULES.keys() - ELSEWHERE.keys() == WIRES.keys()


def test_the_checks_are_those_that_any_source_on_any_robot_inherits() -> None:
    assert all(list(inspect.signature(check).parameters) == ["robot"] for check in CHECKS)


@pytest.mark.parametrize("wire", WIRES)
@pytest.mark.parametrize("entry", ENTRIES, ids=lambda entry: entry.name)
def test_every_profile_is_safe_over_every_wire(entry: ProfileEntry, wire: str, tmp_path: Path) -> None:
    profile = entry.load()
    first = ENTRIES.index(entry) + 3 * list(WIRES).index(wire)
    with WIRES[wire](profile.wiring, tmp_path) as (connect, settle):
        ends = [connect(), connect()]
        ends[0].subscribe(profile.wiring.cmd_vel_topic, TwistMessage, lambda _: None)
        settle()
        for number, check in enumerate(CHECKS):
            source = SOURCES[(first + number) % len(SOURCES)]
            check(Driven(profile, source, iter(ends).__next__))


def test_between_them_they_let_every_source_drive_over_every_wire() -> None:
    for wire in range(len(WIRES)):
        turns = {
            SOURCES[(entry + 3 * wire + check) % len(SOURCES)]
            for entry in range(len(ENTRIES))
            for check in range(len(CHECKS))
        }
        assert turns == set(SOURCES)
