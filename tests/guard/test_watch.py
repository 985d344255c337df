"""The guard's rule, on a clock of our own."""

from __future__ import annotations

from chatrobot.core.clock import TICK_S
from chatrobot.guard.watch import BEAT, HANDSHAKE, MISSED_S, Watch


def test_an_idle_guard_sends_nothing() -> None:
    assert not Watch().must_halt(1000.0)


def test_missed_beats_halt_the_robot_and_late_beats_do_not_undo_it() -> None:
    watch = Watch()
    watch.hear(HANDSHAKE, 0.0)
    assert not watch.must_halt(MISSED_S)
    assert watch.must_halt(MISSED_S + 0.001)
    watch.hear(BEAT, MISSED_S + 0.002)
    assert watch.must_halt(MISSED_S + 0.003)


def test_a_new_handshake_ends_a_trip() -> None:
    watch = Watch()
    watch.hear(HANDSHAKE, 0.0)
    assert watch.must_halt(1.0)
    watch.hear(HANDSHAKE, 1.0)
    assert not watch.must_halt(1.0 + MISSED_S / 2)


def test_steady_beats_never_trip() -> None:
    watch = Watch()
    watch.hear(HANDSHAKE, 0.0)
    for beat in range(1, 500):
        assert not watch.must_halt(beat * TICK_S)
        watch.hear(BEAT, beat * TICK_S)


def test_losing_motion_without_a_goodbye_trips_at_once() -> None:
    watch = Watch()
    watch.hear(HANDSHAKE, 0.0)
    watch.lose()
    assert watch.must_halt(0.001)


def test_the_guard_looks_again_no_later_than_the_next_overdue_beat() -> None:
    watch = Watch()
    watch.hear(HANDSHAKE, 5.0)
    assert watch.seconds_left(5.1) <= MISSED_S
    assert watch.seconds_left(5.0 + MISSED_S + 1.0) == 0.0


def test_it_begins_idle_and_a_loss_before_any_handshake_is_none() -> None:
    watch = Watch()
    assert watch.state == "idle"
    watch.lose()
    watch.hear(BEAT, 1.0)
    assert watch.state == "idle"
    assert watch.seconds_left(50.0) == MISSED_S


def test_how_long_it_may_sleep_depends_on_its_state() -> None:
    watch = Watch()
    assert watch.seconds_left(0.0) == MISSED_S
    watch.hear(HANDSHAKE, 5.0)
    assert watch.seconds_left(5.1) == 5.0 + MISSED_S - 5.1
    watch.lose()
    assert watch.seconds_left(5.1) == TICK_S
