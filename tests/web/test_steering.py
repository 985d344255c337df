"""Whoever steers has to be there: a stick or a plan without beats of its page ends, and nothing beats in its place."""

from __future__ import annotations

import threading
import time
from typing import Any

import pytest

from chatrobot.core.events import Finished, Rehearsed, Result
from chatrobot.core.geometry import ORIGIN, ZERO_TWIST, Twist
from chatrobot.link.motion_link import TURNS
from chatrobot.web.steering import FIRST_BEAT_S, Steering, Watchdog
from tests.processes import wait_until
from tests.web.rig import PATIENCE_S, NotingSession, WebRig

FORWARD = Twist(0.2)
SINCE_BEAT_S = 0.04
"""Between the last beat of a page that is let live, and the end of that."""
BUSY_S = 0.3
"""For so long the event loop reads nothing: more than a page may be silent."""
GONE = ("stop", "the steering page is gone")


class Page:
    def __init__(self, *, is_local: bool = True) -> None:
        self.is_local = is_local
        self.unread = 0

    def unread_bytes(self) -> int:
        return self.unread


class Rig:
    """Steering on a clock that a test moves."""

    def __init__(self) -> None:
        self.now_s, self.has_work, self.lost = 0.0, False, 0
        self.robot = NotingSession()
        self.steering = Steering(self.robot, lambda: self.has_work, self._note_lost, lambda: self.now_s)

    def _note_lost(self) -> None:
        self.lost += 1

    def live(self, duration_s: float, page: Any = None, *, stick: Twist | None = None) -> None:
        """Let time pass; the watchdog looks, and `page` beats, as often as they do."""
        for step in range(round(duration_s / 0.01)):
            self.now_s += 0.01
            if step % 5 == 0 and page is not None:
                self.steering.beat(page)
                if stick is not None:
                    self.steering.stick(page, stick)
            if step % 2 == 0:
                self.steering.look()

    def seconds_to(self, what: tuple[Any, ...]) -> float:
        """Let time pass without a beat; how long until the robot is told that."""
        began_s = self.now_s
        while what not in self.robot.log:
            assert self.now_s < began_s + 2.0
            self.live(0.02)
        return self.now_s - began_s

    def take_with_a_plan(self, page: Page | None = None) -> Page:
        """Have that page steer, and its plan run."""
        page = page or Page()
        self.steering.take(page)
        self.live(0.5, page)
        self.has_work = True
        return page

    def live_unread(self, duration_s: float, page: Page) -> None:
        """Live on while the page sends beats that nobody reads."""
        for _ in range(round(duration_s / 0.05)):
            page.unread += 20
            self.live(0.05)


@pytest.fixture
def steered() -> Rig:
    return Rig()


def test_a_silent_stick_is_left_to_motion(steered: Rig) -> None:
    """A zero said in the place of a hand that still holds it would count, after a stop, as letting go."""
    page = Page()
    steered.steering.take(page)
    steered.live(0.5, page, stick=FORWARD)
    steered.live(2.0, page)
    assert set(steered.robot.log) == {("steer", *FORWARD)}


def test_whoever_gives_the_steering_up_ends_what_they_said(steered: Rig) -> None:
    page = Page()
    steered.steering.take(page)
    steered.live(0.1, page)
    steered.steering.take(None)
    assert steered.robot.log == []
    steered.steering.take(page)
    steered.has_work = True
    steered.steering.take(None)
    assert steered.robot.log == [("stop", "nobody steers any more")]


def test_whoever_takes_over_stops_the_stick_and_keeps_the_plan(steered: Rig) -> None:
    page, other = Page(), Page()
    steered.steering.take(page)
    steered.live(0.1, page, stick=FORWARD)
    steered.has_work = True
    steered.steering.take(other)
    assert steered.robot.log[-1] == ("steer", *ZERO_TWIST)
    assert GONE not in steered.robot.log


def test_taking_what_one_has_is_no_beat(steered: Rig) -> None:
    page = steered.take_with_a_plan()
    for _ in range(10):
        steered.live(0.1)
        steered.steering.take(page)
    assert steered.robot.log == [GONE]


@pytest.mark.parametrize(("is_local", "most_s"), [(True, 0.22), (False, 0.32)])
def test_a_page_without_beats_ends_what_it_said(steered: Rig, is_local: bool, most_s: float) -> None:
    page = steered.take_with_a_plan(Page(is_local=is_local))
    steered.live(2.0, page)
    assert steered.robot.log == []
    assert most_s - 0.05 < steered.seconds_to(GONE) + SINCE_BEAT_S <= most_s
    steered.live(1.0)
    assert steered.robot.log == [GONE]
    assert steered.lost == 1


def test_beats_that_the_event_loop_has_not_read_yet_are_no_silence(steered: Rig) -> None:
    page = steered.take_with_a_plan()
    steered.live_unread(0.4, page)
    assert steered.robot.log == []
    assert 0.13 < steered.seconds_to(GONE) + SINCE_BEAT_S <= 0.23, (
        "bytes that lie there are no beats that come"
    )


def test_an_event_loop_that_reads_no_more_ends_the_plan_though_the_page_beats(steered: Rig) -> None:
    page = steered.take_with_a_plan()
    steered.live_unread(0.8, page)
    assert steered.robot.log == [GONE]


def test_what_a_page_without_beats_says_does_not_keep_it_where_the_event_loop_reads_it(steered: Rig) -> None:
    page = steered.take_with_a_plan()
    for _ in range(3):
        page.unread = 400
        steered.live(0.02)
        page.unread = 0
        steered.live(0.06)
    assert steered.robot.log == [GONE]


@pytest.mark.realtime
def test_a_page_that_beats_keeps_its_plan_while_the_event_loop_is_busy(rig: WebRig) -> None:
    page = rig.page()
    page.say("say", text="forward 1 m")
    rig.session.wait_for("say", "forward 1 m")
    is_done = threading.Event()
    rig.call(lambda: time.sleep(BUSY_S))
    rig.call(is_done.set)
    assert is_done.wait(PATIENCE_S)
    assert GONE not in rig.session.log
    page.freeze()
    rig.session.wait_for(*GONE, timeout_s=2.0)


def test_a_page_that_is_silent_and_has_nothing_to_do_ends_nothing(steered: Rig) -> None:
    """What another face of the robot said is none of its business."""
    page = Page()
    steered.steering.take(page)
    steered.live(0.5, page)
    steered.live(2.0)
    assert steered.robot.log == []
    assert not steered.steering.is_alive


def test_who_begins_to_steer_has_a_moment_until_the_first_beat(steered: Rig) -> None:
    steered.has_work = True
    steered.steering.take(Page())
    steered.live(FIRST_BEAT_S)
    assert steered.robot.log == []
    steered.live(0.5)
    assert steered.robot.log == [GONE]


def test_beats_of_another_page_hold_nothing(steered: Rig) -> None:
    page, other = Page(), Page()
    steered.steering.take(page)
    steered.live(0.1, page)
    steered.has_work = True
    steered.live(0.4, other)
    assert steered.robot.log == [GONE]
    assert not steered.steering.stick(other, FORWARD)
    assert steered.robot.log == [GONE]


def test_a_page_that_leaves_lets_go_and_ends_what_it_said(steered: Rig) -> None:
    page = Page()
    steered.steering.take(page)
    steered.steering.stick(page, FORWARD)
    assert steered.steering.leave(page)
    assert steered.robot.log == [("steer", *FORWARD), GONE]
    assert steered.steering.steerer is None
    assert not steered.steering.stick(page, FORWARD)


@pytest.mark.filterwarnings("ignore::pytest.PytestUnhandledThreadExceptionWarning")
def test_a_watchdog_that_breaks_stops_all_that_pages_said_and_lets_none_say_more() -> None:
    broken, other = Rig(), Rig()
    page = other.take_with_a_plan()

    def fail() -> None:
        raise ValueError("an error of ours")

    broken.steering = Steering(broken.robot, lambda: True, fail, lambda: broken.now_s)
    broken.steering.take(Page())
    broken.now_s += FIRST_BEAT_S + 1.0  # its page is silent
    watchdog = Watchdog(lambda: [broken.steering, other.steering])
    watchdog.start()
    wait_until(lambda: ("stop", "the web console broke") in other.robot.log)
    watchdog.stop()
    assert GONE in broken.robot.log
    other.steering.beat(page)
    assert not other.steering.is_alive, "nobody would notice that it is gone"


def test_closing_the_steering_page_ends_its_plan(rig: WebRig) -> None:
    page, watcher = rig.page(), rig.page()
    page.say("say", text="forward 1 m")
    rig.session.wait_for("say", "forward 1 m")
    page.socket.close()
    rig.session.wait_for(*GONE)
    assert watcher.wait_for("lost")["text"]
    assert watcher.wait_for("steering", by=None)


def test_an_agents_plan_that_a_page_said_yes_to_ends_with_that_page(rig: WebRig) -> None:
    page, watcher = rig.page(), rig.page()
    turn = TURNS + 1
    for number in (turn, turn + 1):
        rig.tell(Rehearsed(number, True, 1.0, 1.0, ORIGIN, needs_approval=True))
        page.say("approve", turn=number, yes=True)
        rig.session.wait_for("approve", number, True)
        if number == turn:
            rig.tell(Finished(turn, "completed", None, ORIGIN, ORIGIN, 0.0, 0.5, 1.0, 0.0))
            assert watcher.wait_for_event("finished")["text"]
    page.socket.close()
    rig.session.wait_for(*GONE)


def test_closing_it_after_the_plan_has_ended_stops_nothing(rig: WebRig) -> None:
    page, watcher = rig.page(), rig.page()
    page.say("say", text="forward 1 m")
    page.wait_for("said")
    rig.tell(Result(1, "completed", "Done."))
    page.socket.close()
    watcher.wait_for("steering", by=None)
    assert rig.session.log == [("say", "forward 1 m")]


def test_a_page_that_beats_no_more_ends_its_plan_though_its_connection_stays(rig: WebRig) -> None:
    page = rig.page()
    page.say("say", text="forward 1 m")
    rig.session.wait_for("say", "forward 1 m")
    page.freeze()
    rig.session.wait_for(*GONE, timeout_s=2.0)
    page.say("beat")
    page.say("say", text="forward 1 m")
    page.wait_for("said")
    page.wait_for("said")


def test_that_the_steering_page_is_gone_is_told_once_whoever_leaves_after_it(rig: WebRig) -> None:
    """Pages that try anew while the server stands still all come, and are gone, at once."""
    first = rig.page()
    first.hold()
    first.say("say", text="forward 1 m")
    first.wait_for("said")
    first.socket.close()
    for _ in range(2):
        wait_until(lambda: rig.room.steering.steerer is None)
        rig.page().socket.close()
    wait_until(lambda: rig.session.log.count(GONE) == 3)
    assert [told["is"] for told in rig.page().heard[0]["history"]] == ["said", "lost"]


def test_a_page_that_never_beats_is_told_that_nothing_is_done(rig: WebRig) -> None:
    page = rig.page(beats=False)
    wait_until(lambda: not rig.room.steering.is_alive)
    page.say("say", text="forward 1 m")
    assert page.wait_for("refused")["why"] == "silent"
    assert rig.session.log == []


def test_who_takes_over_keeps_the_plan_going_with_beats_of_their_own(rig: WebRig) -> None:
    first, second = rig.page(), rig.page()
    first.say("say", text="forward 1 m")
    rig.session.wait_for("say", "forward 1 m")
    second.say("take")
    second.wait_for("steering", you=True)
    first.socket.close()
    second.freeze()
    rig.session.wait_for(*GONE, timeout_s=3.0)
