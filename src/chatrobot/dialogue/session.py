"""One conversation with one robot: texts in, events out, whatever display is on top.

`say`, `stop` and `emergency_stop` may be called from any thread; everything else belongs to the thread that pumps.
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from dataclasses import replace
from typing import Any

from chatrobot.core.errors import LinkError
from chatrobot.core.events import Event, Finished, Notice, Paused, Remembered, Result, Telemetry
from chatrobot.core.geometry import Twist
from chatrobot.core.reason import Reason
from chatrobot.core.sensed_events import ObstacleChanged
from chatrobot.dialogue.amending import Amending
from chatrobot.dialogue.dispatch import Dispatch
from chatrobot.dialogue.goal_client import GoalClient, RequestLog
from chatrobot.dialogue.llm.requests import ModelRequests
from chatrobot.dialogue.llm.setup import ModelSetup
from chatrobot.dialogue.llm.terms import Ended
from chatrobot.dialogue.observations import measured
from chatrobot.dialogue.options import Options
from chatrobot.dialogue.programs.authoring import Authoring
from chatrobot.dialogue.programs.draft import Draft
from chatrobot.dialogue.programs.requests import ProgramRequests
from chatrobot.dialogue.question import Proposals
from chatrobot.dialogue.resuming import Resuming
from chatrobot.dialogue.understanding import Understanding
from chatrobot.dialogue.utterances import EarlyAnswers, Kind, NextUtterance, Utterance, UtteranceQueue
from chatrobot.dialogue.while_driving import WhileDriving
from chatrobot.link.motion_link import MotionLink
from chatrobot.plan.text import format_plan
from chatrobot.reflex import is_emergency_stop, is_pause, is_stop, leads_with_stop

STEERED_S = 1.0
"""So long after a stick was held a text need only begin with a stop word to be one."""
FIRST_NEWS_LOOKS, FIRST_NEWS_LOOK_S = 10, 0.1
"""How often and how long an answer waits for the first word of odometry."""


class Session:
    """See the module.

    Args:
        on_event: hears every event, in order; it only reads.
        authoring: writes and keeps programs; None where requests for one are driven as plans.
    """

    def __init__(
        self,
        link: MotionLink,
        understanding: Understanding,
        on_event: Callable[[Event], None],
        options: Options,
        authoring: Authoring | None = None,
        model_setup: ModelSetup | None = None,
    ) -> None:
        self._link, self.understanding, self.authoring = link, understanding, authoring
        self._on_event, understanding.language = on_event, options.language
        self.on_said: Callable[[int, str], None] = lambda _, __: None
        """Hears, in the thread that says it, each text that was taken in, with the number of its turn."""
        self._resuming = Resuming(understanding)
        self._goals = GoalClient(link, options, self._resuming)
        self._utterances = waiting = UtteranceQueue()
        self._proposals = Proposals(understanding, waiting, self._resuming, self.approve)
        self._requests = log = RequestLog(understanding, self._emit)
        self.results = self._requests.results  # by the number of the turn
        self._llm = ModelRequests(
            model_setup, options.interpreter, link, understanding, self._emit, self._conclude_model_turn,
            lambda: self._utterances.pauses,
        )  # fmt: skip
        self._driving = driving = WhileDriving(self._goals, understanding, log, self._resuming)
        early = EarlyAnswers(understanding, self._llm, log, authoring, driving)
        awaits, amending = self._proposals.awaits, Amending(self._goals, understanding, log, self._resuming)
        self._next = NextUtterance(waiting, log, self._llm, understanding, self._resuming, early, awaits)
        self._programs: ProgramRequests | None = None
        self._steered_at_s = -math.inf
        if authoring is not None:
            self._programs = ProgramRequests(
                authoring, understanding, log, self._goals, link, self._emit, waiting.is_void_turn, self._finish,
            )  # fmt: skip
            self._llm.writer = self._programs
        self._dispatch = Dispatch(
            link, self._goals, waiting, understanding, log, self._proposals, self._resuming, self._llm,
            self._programs, driving, amending, self._emit, self.stop, self._hears_robot_soon,
        )  # fmt: skip

    @property
    def options(self) -> Options:
        """Return the options. They may be replaced between two turns, but for who interprets."""
        return self._goals.options

    @options.setter
    def options(self, options: Options) -> None:
        self._goals.options = options

    def say(self, text: str) -> int:
        """Take in what a person said; the number of its turn. A stop is out before this returns."""
        moves = self.is_moving or time.monotonic() - self._steered_at_s < STEERED_S
        if is_emergency_stop(text):
            self.emergency_stop(text.strip()[:80])
            kind: Kind = "emergency_stop"
        elif (leads_with_stop(text) or self._declines_motion(text)) if moves else is_stop(text):
            kind = "pause" if is_pause(text) else "stop"
            (self.pause if kind == "pause" else self.stop)(text.strip()[:80])
        else:
            kind = "text"
        return self._take_in(text, kind)

    def _declines_motion(self, text: str) -> bool:
        return not self.is_paused and self._proposals.declines_motion(text)

    def say_plan(self, plan_text: str) -> int:
        """Take in a plan that a person or a program wrote itself; the number of its turn."""
        return self._take_in(plan_text, "plan")

    def say_edited_plan(self, plan_text: str, instead_of: str = "") -> int:
        """Take in an edit of a plan that waited for a yes: it, or `instead_of` if it is none, is asked about."""
        return self._take_in(plan_text, "edited_plan", instead_of)

    def say_program(self, text: str, name: str = "") -> int:
        """Take in what a program is to do, asked for as one; the number of its turn."""
        return self._take_in(text, "program", name)

    def say_draft(self, draft: Draft) -> int:
        """Take in a program that is there; the number of its turn."""
        return self._take_in(draft.program.name, "draft", draft)

    def say_source(self, name: str, source: str) -> int:
        """Take in what a person made of the program of that name: it is asked about before it runs."""
        return self._take_in(name, "source", source)

    def _take_in(self, text: str, kind: Kind, about: Draft | str = "") -> int:
        turn = self._utterances.add(text, kind, about, is_moving=self.is_moving)
        self.on_said(turn, text)
        self._link.wake()
        return turn

    def stop(self, why: str = "") -> None:
        """Stop the robot and drop what was said before this moment."""
        self._link.send("stop", self._utterances.void(why), why=why)
        self._llm.cancel(self._utterances.stopped_by)

    def pause(self, why: str = "") -> None:
        """Stop the robot as `stop` does, and keep what it was told; what cannot be kept ends as with a stop."""
        self._utterances.hold(is_under_way=self.is_moving or self._llm.is_busy)
        self._link.send("stop", why=why, keep=True)
        self._llm.cancel_unmoved(Reason("paused_by", {"why": why}))

    def resume(self) -> int:
        """Go on with what is paused; the number of the turn that says so."""
        return self._take_in("", "resume")

    def emergency_stop(self, why: str = "") -> None:
        """Stop the robot and keep it stopped until `release`."""
        self._link.send("emergency_stop", self._utterances.void(why), why=why)
        self._llm.cancel(self._utterances.stopped_by)

    @property
    def stops(self) -> int:
        """Return a number that changes with every stop and pause: what was asked for before it counts no more."""
        return self._utterances.stops

    def steer(self, twist: Twist) -> None:
        """Drive by a stick that a person holds: said anew 20 times a second, once zero; a moment without lets go."""
        self._steered_at_s = time.monotonic() if not twist.is_zero else -math.inf
        self._link.send("steer", **twist._asdict())

    def release(self) -> None:
        """Release an emergency stop. For the local console alone."""
        self._link.send("release")

    def limit(self, **limits: Any) -> None:
        """Change or ask for the motion budget: `max_distance_m`, `max_time_s` (a number or `none`). For the console."""
        self._link.send("limit", **limits)

    def change_obstacle(self, **request: Any) -> None:
        """Put an obstacle into the simulation, move it or take it away, as the `obstacle` envelope says."""
        self._link.send("obstacle", **request)

    def watch_scans(self, on: bool) -> None:
        """Have what the lidar sees told as `scan` events, for a map, or no more."""
        self._link.send("watch", scans=on)

    def look(self) -> None:
        """Ask what the lidar sees: a `looked` event of turn 0 follows."""
        self._link.send("look")

    def approve(self, turn: int, yes: bool, *, edited: bool = False) -> None:
        """Answer a rehearsed plan that waits for a yes; `edited`: a person has another one asked about in its place."""
        self._proposals.rehearsed.forget(turn)
        self._link.send("approve", turn, yes=yes, **({"edited": True} if edited else {}))

    @property
    def is_moving(self) -> bool:
        """True while a plan of ours runs, or is on its way to."""
        return self._requests.is_any_with_motion or self._llm.is_moving

    @property
    def model_wait_s(self) -> float | None:
        """Return how long a model has been asked by now, for a plan or a program; None where none is."""
        return time.monotonic() - at_s if (at_s := self._llm.asked_at_s) is not None else None

    @property
    def is_paused(self) -> bool:
        """True while a plan of ours is paused, or what was said and had not begun."""
        return self.is_plan_paused or self._utterances.is_unbegun_held

    @property
    def is_plan_paused(self) -> bool:
        """True while a plan of ours that had begun is paused."""
        return self._resuming.paused is not None

    @property
    def is_being_paused(self) -> bool:
        """True from a pause until Motion has told what came of it."""
        return self._next.is_being_paused

    @property
    def waits_for_a_word(self) -> bool:
        """True while a plan is paused or asked about, and nothing happens before somebody says something."""
        is_asked = self._proposals.rehearsed.turn is not None and not self.is_being_paused
        waits = is_asked or (self.is_paused and not self._llm.is_calling)
        return waits and self._find_next() is None

    @property
    def is_idle(self) -> bool:
        """True where nothing runs, is thought about or waits."""
        is_thinking = self._llm.is_busy or self._llm.is_writing
        return not (self._requests.is_any_with_motion or self._utterances.waiting or is_thinking)

    # --- the pumping thread ---

    def do(self, text: str) -> Result:
        """Say it and see it through; return the result of its turn."""
        return self.see_through(self.say(text))

    def see_through(self, turn: int) -> Result:
        """Let things happen until that turn has its result."""
        while turn not in self.results:
            self.pump(0.1)
        return self.results[turn]

    def pump(self, timeout_s: float) -> None:
        """Let things happen for up to `timeout_s`: texts are understood, events heard.

        Raises:
            LinkError: Motion is gone.
        """
        self._llm.pump()
        self._take_texts()
        stands = self._llm.is_writing or not self._requests.is_any_with_motion
        if self._llm.is_calling and self._link.is_simulated and stands:
            self._llm.wait(timeout_s)  # a model thinks in no time at all
            self._llm.pump()
            timeout_s = 0.0
        self._hear_events(0.0 if self._find_next() is not None else timeout_s)
        self._llm.pump()
        if self._link.is_lost:
            raise LinkError("Motion is gone, and its guard sends the robot zeros. Start chatrobot again.")
        self._take_texts()

    def _hear_events(self, timeout_s: float) -> None:
        while (event := self._link.next_event(timeout_s)) is not None:
            self._hear(event)
            timeout_s = 0.0

    def end_after(self, turn: int | None = None) -> None:
        """Have nothing done of what is said after that turn, or from now on: the person has said goodbye."""
        self._utterances.end_after(turn)

    def close(self) -> None:
        """Say goodbye: what runs is still done."""
        self._link.close()

    def _emit(self, event: Event) -> None:
        self._proposals.hear(event)
        self._on_event(event)

    def _find_next(self) -> Utterance | None:
        return self._next.find(self.options, self._dispatch.waiting_turn)

    def _take_texts(self) -> None:
        for one in self._utterances.take_too_many():  # who said it hears so now, not after the ten before
            self._requests.conclude(one.turn, "refused", self.understanding.say("queue_full", one.text))
        self._next.drop_held()
        while (found := self._find_next()) is not None:
            self._goals.pauses = self._utterances.pauses
            if (taken := self._utterances.take(found)) is not None:
                self._dispatch.take(taken)
                self._next.drop_held()

    def _hears_robot_soon(self) -> bool:
        """A robot that is there says where it is within a moment of the start."""
        for _ in range(FIRST_NEWS_LOOKS):
            if not self.understanding.hears_robot:
                self._hear_events(FIRST_NEWS_LOOK_S)
        return self.understanding.hears_robot

    def _conclude_model_turn(self, turn: int, text: str, ended: Ended) -> None:
        reply = self.understanding.note_model_turn(text, ended, self.options.rehearse_only)
        is_refused = ended.outcome == "refused" and not self.options.rehearse_only
        finished, language = ended.finished if is_refused else None, self.understanding.language_of(text)
        reply, proposal = self._driving.with_offer(reply, finished, language)
        self._requests.conclude(turn, ended.outcome, reply, ended.finished, ended.reason, proposal)

    def _hear(self, event: Event) -> None:
        if isinstance(event, Telemetry):
            is_ours = self._requests.is_any_with_motion or self._llm.is_busy
            self.understanding.note_telemetry(event, is_ours=is_ours)
        elif isinstance(event, Remembered):
            self.understanding.note_place(event)
        elif isinstance(event, ObstacleChanged):
            self.understanding.ways.note_obstacle(event)
        elif isinstance(event, Paused) and self._requests.has(event.turn):
            event = replace(event, waiting=self._dispatch.texts_behind(event.turn))
        elif isinstance(event, Notice):
            self.understanding.note_notice(event.reason.code)
        self._emit(event)
        if self._requests.has(event.turn) or self._llm.has(event.turn):
            was_paused = self.is_plan_paused
            self._resuming.hear(event)
            self._requests.hear(event)
            if was_paused and not self.is_plan_paused:
                self._utterances.drop_held(self._resuming.ended_by)
        if self._utterances.hear(event):
            self._llm.cancel(self._utterances.stopped_by)
        if self._programs is not None and self._programs.hear(event):
            return  # the next version of a program is on its way
        self._llm.hear(event)
        if isinstance(event, Finished):
            self._finish(event)

    def _finish(self, event: Finished) -> None:
        if (instruction := self._requests.take(event.turn)) is None:
            return
        (text, meant, _), programs, rehearse_only = instruction, self._programs, self.options.rehearse_only
        program = event.turn if programs is not None and programs.has_run(event.turn) else 0
        reply = self.understanding.note_finished(text, meant, event, rehearse_only, program)
        if programs is not None:
            reply = programs.ending(event.turn, reply)
        plan_text = format_plan(meant.plan) if meant.plan is not None else ""
        self._llm.note(text, plan_text, f"{event.outcome}: {measured(event)}")
        ended = None if rehearse_only else event
        reply, proposal = self._driving.with_offer(reply, ended, meant.language)
        self._requests.conclude(event.turn, event.outcome, reply, event, proposal=proposal)
