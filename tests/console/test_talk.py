"""What a typed line and a key do, without a terminal and without a robot."""

from types import SimpleNamespace

import pytest
from rich.text import Text

from chatrobot.cli.console import commands
from chatrobot.cli.console.clean import LONGEST_CHARS
from chatrobot.cli.console.talk import TWICE_S, Talk
from chatrobot.cli.console.words import Words
from chatrobot.core.clock import VirtualClock
from chatrobot.core.errors import JointError
from chatrobot.core.events import Finished, Interpreted, Rehearsed, Result, Started
from chatrobot.core.geometry import Pose
from chatrobot.robots.load import load_profile
from chatrobot.sim.load import load_world


class FakeSession:
    """Notes what it is told."""

    def __init__(self, log):
        self.log = log
        self.is_idle = True
        self.is_lost = False

    def _note(self, *what):
        if self.is_lost:
            raise JointError("Motion is gone")
        self.log.append(what)
        return len(self.log)

    def say(self, text):
        return self._note("say", text)

    def say_plan(self, plan_text):
        return self._note("say_plan", plan_text)

    def stop(self, why=""):
        self._note("stop", why)

    def emergency_stop(self, why=""):
        self._note("emergency_stop", why)

    def release(self):
        self._note("release")

    def approve(self, turn, yes):
        self._note("approve", turn, yes)


class FakeFace:
    """Notes what it shows in the same list."""

    width, echoes = 100, False

    def __init__(self, log):
        self.log = log

    def print(self, *lines):
        self.log += [("print", str(line) if isinstance(line, Text) else repr(line)) for line in lines]

    def refresh(self):
        pass

    def edit(self, plan_text):
        self.log.append(("edit", plan_text))

    def leave(self, code):
        self.log.append(("leave", code))


@pytest.fixture
def log():
    return []


@pytest.fixture
def talk(log):
    connection = SimpleNamespace(
        session=FakeSession(log), world=load_world("home"), profile=load_profile("wheeltec_mini_mec")
    )
    talk = Talk(connection, Words(), VirtualClock(), commands.run)
    talk.face = FakeFace(log)
    return talk


def told(log):
    """What the session was told, without what was shown."""
    return [entry for entry in log if entry[0] not in ("print",)]


def shown(log):
    return "\n".join(entry[1] for entry in log if entry[0] == "print")


def ask(talk):
    """A plan of turn 1 waits for a yes."""
    talk.hear(Interpreted(1, "offline", "drive 1 m", ""))
    talk.hear(
        Rehearsed(1, True, 3.6, 1.0, Pose(1.0), (), ((0.0, 0.0, 0.0), (1.0, 0.0, 0.0)), needs_approval=True)
    )


def test_a_stop_is_out_before_anything_is_drawn(talk, log):
    talk.enter("stop")
    assert log[0] == ("say", "stop")
    log.clear()
    talk.interrupt()
    assert log[0] == ("stop", "Ctrl-C")


def test_two_interrupts_at_once_leave_and_two_far_apart_stop_twice(talk, log):
    talk.interrupt()
    talk._clock.advance(TWICE_S + 0.1)
    talk.interrupt()
    assert ("leave", 0) not in log
    talk._clock.advance(TWICE_S - 0.1)
    talk.interrupt()
    assert told(log)[-1] == ("leave", 0)


def test_leaving_waits_for_what_was_told(talk, log):
    talk.session.is_idle = False
    talk.leave()
    assert told(log) == []
    talk.session.is_idle = True
    talk.hear(Result(1, "completed", "done"))
    assert told(log) == [("leave", 0)]


def test_leaving_twice_does_not_wait(talk, log):
    talk.session.is_idle = False
    talk.leave()
    talk.leave()
    assert told(log) == [("leave", 0)]


def test_leaving_a_question_is_a_no(talk, log):
    ask(talk)
    talk.session.is_idle = False
    talk.leave()
    assert told(log) == [("approve", 1, False)]


def test_an_interrupt_takes_a_goodbye_back(talk, log):
    talk.session.is_idle = False
    talk.leave()
    talk.interrupt()
    talk.session.is_idle = True
    talk.hear(Result(1, "stopped", "stopped"))
    assert ("leave", 0) not in log


@pytest.mark.parametrize(
    ("answer", "yes"), [("y", True), ("Yes.", True), ("好", True), ("n", False), ("不要", False)]
)
def test_a_question_is_answered(talk, log, answer, yes):
    ask(talk)
    talk.enter(answer)
    assert told(log) == [("approve", 1, yes)]


def test_yes_to_no_question_is_an_instruction_like_any_other(talk, log):
    talk.enter("yes")
    assert told(log) == [("say", "yes")]


def test_a_stop_during_a_question_is_a_stop(talk, log):
    ask(talk)
    talk.enter("stop")
    assert told(log) == [("say", "stop")]


def test_a_question_is_over_once_its_turn_has_begun_or_ended(talk, log):
    for end in (Started(1, Pose()), Finished(1, "refused", None, Pose(), Pose(), 0.0, 0.0, 0.0, 0.0)):
        ask(talk)
        talk.hear(end)
        log.clear()
        talk.enter("y")
        assert told(log) == [("say", "y")]


def test_editing_withdraws_the_plan_silently_and_sends_the_new_one(talk, log):
    ask(talk)
    talk.enter("e")
    assert told(log) == [("edit", "drive 1 m"), ("approve", 1, False)]
    talk.hear(Result(1, "refused", "not approved"))
    assert "not approved" not in shown(log)
    talk.take_edited("drive 2 m\n")
    assert told(log)[-1] == ("say_plan", "drive 2 m")


def test_what_is_too_long_is_never_done_in_part(talk, log):
    talk.enter("forward 1 m " * LONGEST_CHARS)
    talk.enter("x" * LONGEST_CHARS + " ")
    talk.take_edited("drive 1 m\n" * LONGEST_CHARS)
    assert told(log) == []


def test_an_empty_line_is_nothing(talk, log):
    talk.enter("  \n")
    talk.take_edited("\n")
    assert log == []


def test_emergency_stop_latches_the_screen_until_release(talk, log):
    talk.enter("/estop")
    assert talk.latched
    talk.enter("/release")
    assert not talk.latched
    assert told(log) == [("emergency_stop", "/estop"), ("release",)]
    talk.enter("emergency stop")
    assert talk.latched


def test_when_motion_is_gone_the_talk_ends_with_a_word(talk, log):
    talk.session.is_lost = True
    talk.enter("forward 1 m")
    assert ("leave", 1) in log
    assert "Motion is gone" in shown(log)


def test_a_long_line_is_echoed_in_part(talk, log):
    talk.enter("x" * 3000)
    assert len(shown(log)) < 700
