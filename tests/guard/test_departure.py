"""A guard whose robot's process has left the wire leaves, too; where a network may hide the robot it stays."""

from __future__ import annotations

import socket
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager

import pytest

from chatrobot.guard.__main__ import Guard, HaltedRobot
from chatrobot.guard.watch import HANDSHAKE, Departure
from chatrobot.wire.messages import Message
from chatrobot.wire.wire import Endpoint, M, Wire

TWIST, ODOMETRY = "geometry_msgs/msg/Twist", "nav_msgs/msg/Odometry"
BASE, DRIVER = Endpoint("/cmd_vel", TWIST, "listens"), Endpoint("/odom", ODOMETRY, "publishes")
OTHERS = [Endpoint("/cmd_vel", TWIST, "publishes"), Endpoint("/odom", ODOMETRY, "listens")]
"""Of Motion, which has been killed but is listed still."""


class Domain(Wire):
    """A wire that discovers the others by itself."""

    knows_others = sees_others_leave = True

    def __init__(self, *ends: Endpoint) -> None:
        self.ends = ends
        self.zeros = 0

    def publish(self, topic: str, message: Message) -> None:
        assert topic == "cmd_vel"
        assert not any(message)  # type: ignore[arg-type]
        self.zeros += 1

    def subscribe(self, topic: str, kind: type[M], callback: Callable[[M], None]) -> None: ...
    def close(self) -> None: ...

    def survey(self) -> list[Endpoint]:
        return [*self.ends, *OTHERS]

    def resolve(self, topic: str) -> str:
        return f"/{topic}"


@contextmanager
def bereft(domain: Domain, odom: str = "odom", *, is_near: bool = True) -> Iterator[threading.Thread]:
    """A guard whose Motion shook hands and died."""
    ours, its_end = socket.socketpair(socket.AF_UNIX, socket.SOCK_STREAM)
    guard = Guard(its_end, [HaltedRobot(domain, "cmd_vel", odom, is_near=is_near)])
    thread = threading.Thread(target=guard.run, daemon=True)
    ours.send(HANDSHAKE)
    thread.start()
    assert ours.recv(1) == HANDSHAKE
    ours.close()
    yield thread
    domain.ends = ()
    if is_near:
        thread.join(5.0)
        assert not thread.is_alive()


@pytest.mark.parametrize(
    "ends",
    [
        pytest.param((), id="nobody is there"),
        pytest.param((BASE,), id="somebody looks at the velocities, but no robot publishes odometry"),
        pytest.param((DRIVER,), id="nobody takes velocities"),
    ],
)
def test_where_the_robot_is_gone_the_guard_is_gone_within_a_second(ends: tuple[Endpoint, ...]) -> None:
    domain = Domain(*ends)
    with bereft(domain) as thread:
        thread.join(1.0)
        assert not thread.is_alive()
    assert domain.zeros > 3, "who may still have listened was told to stand"


def test_while_the_robot_is_there_zeros_go_on() -> None:
    domain = Domain(BASE, DRIVER)
    with bereft(domain) as thread:
        thread.join(1.0)
        assert thread.is_alive()
        assert domain.zeros > 20


def test_a_robot_without_odometry_is_there_while_it_takes_velocities() -> None:
    domain = Domain(BASE)
    with bereft(domain, odom="") as thread:
        thread.join(0.8)
        assert thread.is_alive()


def test_beyond_a_network_a_robot_that_is_not_listed_may_still_drive() -> None:
    domain = Domain()
    with bereft(domain, is_near=False) as thread:
        thread.join(1.0)
        assert thread.is_alive()
        assert domain.zeros > 20


def test_a_robot_that_is_listed_again_is_there_again() -> None:
    domain = Domain()
    departure = Departure(domain, "cmd_vel", "odom", is_near=True)
    assert not departure.is_over(1.0)
    assert not departure.is_over(1.2)
    assert departure.is_over(1.4)
    domain.ends = BASE, DRIVER
    assert not departure.is_over(1.5)
    domain.ends = ()
    assert not departure.is_over(1.6)
    assert departure.is_over(2.0)
