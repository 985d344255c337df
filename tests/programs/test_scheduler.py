"""The scheduler of virtual time by itself: who runs when, and what a look at the clock costs."""

from __future__ import annotations

from typing import NoReturn

import pytest

from chatrobot.programs.inside.scheduler import FLOOD_LOOK_NS, LOOK_NS, Scheduler
from chatrobot.programs.inside.virtual_time import VirtualLock

SECOND_NS = 10**9


class OverError(Exception):
    """The horizon."""


class World:
    """Time that nobody outside has a say in."""

    due_ns = 2**62

    def __init__(self) -> None:
        self.asked: list[int] = []
        self.was_stuck = False

    def advance(self, now_ns: int, until_ns: int) -> int:
        self.asked.append(until_ns)
        return max(now_ns, until_ns)

    def finish(self, now_ns: int, stuck: bool) -> NoReturn:
        self.was_stuck = stuck
        assert now_ns == 60 * SECOND_NS
        raise OverError


@pytest.fixture
def scheduler() -> Scheduler:
    made = Scheduler(World(), 60 * SECOND_NS)
    VirtualLock.scheduler = made
    return made


def test_a_sleep_ends_when_it_should(scheduler: Scheduler) -> None:
    scheduler.sleep_until(3 * SECOND_NS)
    assert scheduler.now_ns == 3 * SECOND_NS


def test_a_look_costs_little_and_a_flood_of_looks_more(scheduler: Scheduler) -> None:
    assert scheduler.look() == LOOK_NS
    for _ in range(1000):
        before_ns = scheduler.now_ns
        scheduler.look()
    assert scheduler.now_ns - before_ns == FLOOD_LOOK_NS
    scheduler.sleep_until(30 * SECOND_NS)
    before_ns = scheduler.now_ns
    assert scheduler.look() - before_ns == LOOK_NS


def test_the_horizon_ends_it_asleep_and_at_the_next_look(scheduler: Scheduler) -> None:
    with pytest.raises(OverError):
        scheduler.sleep_until(61 * SECOND_NS)
    with pytest.raises(OverError):
        scheduler.look()


def test_who_waits_for_nothing_is_stuck() -> None:
    world = World()
    scheduler = Scheduler(world, 60 * SECOND_NS)
    with pytest.raises(OverError):
        scheduler.block(None)
    assert world.was_stuck
    assert world.asked == [60 * SECOND_NS]


def test_a_lock_waits_as_long_as_it_is_told(scheduler: Scheduler) -> None:
    lock = VirtualLock()
    assert lock.acquire()
    assert not lock.acquire(timeout=2.5)
    assert scheduler.now_ns == 2.5 * SECOND_NS
    assert not lock.acquire(blocking=False)
    lock.release()
    assert lock.acquire(timeout=1.0)
    lock.release()
    with pytest.raises(RuntimeError, match="release unlocked lock"):
        lock.release()


@pytest.mark.parametrize(("blocking", "timeout"), [(False, 1.0), (True, -2.0)])
def test_a_lock_refuses_what_a_real_one_refuses(blocking: bool, timeout: float) -> None:
    with pytest.raises(ValueError):
        VirtualLock().acquire(blocking, timeout)
