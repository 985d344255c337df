"""Waiting for an event ends with the event, with `wake` or with its timeout, whatever signals come meanwhile."""

from __future__ import annotations

import re
from pathlib import Path

from tests.under_signals import see_every_wait_end

import chatrobot
from chatrobot.core.events import Notice
from chatrobot.core.reason import Reason
from chatrobot.link.motion_link import EventQueue

SOURCES = Path(chatrobot.__file__).parent


def test_a_signal_in_the_last_moment_of_a_wait_does_not_make_it_wait_for_ever() -> None:
    see_every_wait_end(
        "from chatrobot.link.motion_link import EventQueue", "EventQueue()", "next_event(0.002)"
    )


def test_events_come_in_order_and_a_wake_ends_one_wait() -> None:
    events, notices = EventQueue(), [Notice(0, Reason("released")), Notice(0, Reason("wire_back"))]
    events._events.put(notices[0])
    events.wake()
    events._events.put(notices[1])
    assert [events.next_event(0.0) for _ in range(4)] == [notices[0], None, notices[1], None]


def test_no_simple_queue_is_waited_for_with_a_timeout() -> None:
    """CPython's bug is in that class alone; a file that needs a timeout takes `queue.Queue`."""
    waiting = [
        path.relative_to(SOURCES).as_posix()
        for path in SOURCES.rglob("*.py")
        if "SimpleQueue(" in (text := path.read_text()) and re.search(r"\.get\([^)]*timeout", text)
    ]
    assert waiting == []
