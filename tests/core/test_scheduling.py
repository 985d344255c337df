"""Processes that move the robot are woken promptly; what they start for others is not."""

from __future__ import annotations

import os
import threading
from collections.abc import Callable
from pathlib import Path

import pytest

from chatrobot.core.process import wake_as_others_do, wake_promptly


def turn_ns() -> int:
    """How long the calling thread's turns on the processor are, as the kernel tells it."""
    told = Path(f"/proc/self/task/{threading.get_native_id()}/sched")
    for line in told.read_text(encoding="ascii").splitlines() if told.exists() else ():
        name, _, value = line.partition(":")
        if name.strip() == "se.slice":
            return int(value)
    pytest.skip("THIS KERNEL DOES NOT TELL how long a turn is: nothing is checked here")


def in_a_thread(work: Callable[[], None]) -> None:
    """What is set of a thread goes with it."""
    raised: list[BaseException] = []

    def run() -> None:
        try:
            work()
        except BaseException as error:  # noqa: BLE001 - raised again, where the test sees it
            raised.append(error)

    thread = threading.Thread(target=run)
    thread.start()
    thread.join()
    if raised:
        raise raised[0]


def takes_short_turns() -> bool:
    """Whether this kernel has them at all (Linux 6.12)."""
    release = tuple(int(part) for part in os.uname().release.split(".")[:2])
    return release >= (6, 12)


def test_what_moves_the_robot_takes_short_turns_and_its_threads_too() -> None:
    def work() -> None:
        before_ns = turn_ns()
        if not takes_short_turns():
            pytest.skip("THIS KERNEL KNOWS NO SHORT TURNS (before 6.12): nothing is checked here")
        wake_promptly()
        assert turn_ns() == 300_000 < before_ns
        threads: list[int] = []
        in_a_thread(lambda: threads.append(turn_ns()))
        assert threads == [300_000]

    in_a_thread(work)


def test_what_is_started_for_others_takes_turns_like_any_other() -> None:
    def work() -> None:
        before_ns = turn_ns()
        wake_promptly()
        wake_as_others_do()
        assert turn_ns() == before_ns

    in_a_thread(work)


def test_niceness_stays_what_it_was() -> None:
    def work() -> None:
        os.setpriority(os.PRIO_PROCESS, 0, 3)
        wake_promptly()
        assert os.getpriority(os.PRIO_PROCESS, 0) == 3

    in_a_thread(work)


def test_what_a_person_has_given_real_time_or_batch_scheduling_keeps_it() -> None:
    def work() -> None:
        os.sched_setscheduler(0, os.SCHED_BATCH, os.sched_param(0))
        wake_promptly()
        assert os.sched_getscheduler(0) == os.SCHED_BATCH
        wake_as_others_do()
        assert os.sched_getscheduler(0) == os.SCHED_OTHER

    in_a_thread(work)
