"""Understands: makes of a text a reply and a plan, with what was said and done before."""

from __future__ import annotations

import math
import os
import uuid
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from chatrobot.core.events import Finished, Outcome, Remembered, Telemetry
from chatrobot.core.geometry import ZERO_TWIST, Pose
from chatrobot.core.reason import Reason
from chatrobot.dialogue.places import UNMEASURED, MapWays, Places, RestWatch
from chatrobot.dialogue.replies import describe_end, describe_model_end
from chatrobot.dialogue.words import Words
from chatrobot.language.consent import unasked
from chatrobot.language.context import Context, Dialogue, RobotState
from chatrobot.language.detect import language_of
from chatrobot.language.interpretation import Interpretation, LanguageCode
from chatrobot.language.interpreter import OfflineInterpreter
from chatrobot.language.ledger import Entry, TurnRecord, plan_in, plan_of
from chatrobot.language.phrases import describe_steps, say
from chatrobot.language.speed_limit import kept_within, within_limit
from chatrobot.plan.steps import Plan, Step
from chatrobot.robots.profile import OPEN_LOOP, RobotProfile
from chatrobot.sim.world import World

if TYPE_CHECKING:
    from chatrobot.dialogue.llm.terms import Ended


class Instruction(NamedTuple):
    """Holds what was said, what it means, and where the robot stood then."""

    text: str
    meant: Interpretation
    start: Pose


REMEMBERED_TURNS = 50
"""Older turns are forgotten: nobody says "again" about what was fifty instructions ago."""

UNHEARD = "answer_unheard"
_FIRST_TEXTS = {"en": "forward 1 m", "zh": "前进一米", "de": "einen Meter vor"}


class Understanding:
    """Interprets texts and keeps the dialogue. Used by one thread.

    Args:
        world: its named places can be gone to.
        folder: where places live between sessions; None for nowhere.
        frame: names the odom frame where it is the same in every session: that of a simulated robot, which begins at
            the start of its world; empty where nothing tells whether odometry ran on.
    """

    def __init__(self, profile: RobotProfile, world: World, folder: Path | None, frame: str = "") -> None:
        self.is_simulated = bool(frame)
        """Whether things can be put around the robot and taken away."""
        self.profile, self._interpreter = profile, OfflineInterpreter(profile)
        self._state = RobotState(has_said_so=False, is_measured=profile.has_odometry)
        self.world_places = {alias: world.places[main] for alias, main in world.aliases.items()}
        self.main_places = dict(world.places)
        """The places of the world, each once."""
        self.ways = MapWays(world, profile)
        self._names = tuple(world.names_of(name) for name in world.places)
        self._without_heading = frozenset(
            alias for alias, main in world.aliases.items() if main in world.without_heading
        )
        epoch = frame or uuid.uuid4().hex
        self.places, self._words = Places(folder, profile.name, epoch), Words(folder, profile.name, epoch)
        self._dialogue = Dialogue(words=self._words.all())
        self._rest, self._started, self._reaches_robot = RestWatch(), False, True
        self.language: LanguageCode = "en"
        self._last: tuple[str, Context] | None = None
        """The text that was interpreted last, and what was known then."""

    @property
    def pose(self) -> Pose:
        """Return where the robot last said it was."""
        return self._state.pose

    @property
    def known_pose(self) -> Pose | None:
        """Return the same; None where it has never said."""
        return self._state.pose if self._state.has_said_so else None

    @property
    def usable_places(self) -> dict[str, Pose]:
        """Return the places a person has named, as far as their coordinates still hold."""
        return {name: place.pose for name, place in self.places.all().items() if place.usable}

    def warm(self, *languages: str) -> None:
        """Load the words now, while somebody waits for something else anyway: the first sentence is then quick."""
        for language in languages or ("en", "zh"):
            self._interpreter.interpret(_FIRST_TEXTS[language], Context())

    def interpret(self, text: str, under_way: Sequence[Instruction] = ()) -> Interpretation:
        """Return what `text` means now. Instructions that are under way are read as turns before."""
        self._last = (text, self.context(under_way))
        meant = self.read(*self._last)
        self.language = meant.language
        if meant.remember_place and not self.hears_robot:  # nobody knows which place this is
            code = UNHEARD if self.is_measured else "answer_unmeasured"
            meant = Interpretation("refused", say(self.language, code), self.language)
        if meant.obstacles and not self.is_simulated:
            meant = Interpretation("refused", say(self.language, "only_simulated"), self.language)
        return unasked(meant, *self._last)

    def why(self) -> list[str]:
        """Return lines on how the last text was read, and what came of it."""
        from chatrobot.language.explaining import explain

        if self._last is None:
            return [say(self.language, "why_nothing_said")]
        return explain(*self._last, self._interpreter)

    def _context(self, dialogue: Dialogue) -> Context:
        without_heading = self._without_heading - dialogue.places.keys()
        ways = self.ways
        known = (self.world_places, without_heading, self._names, ways.any, ways.ring, ways.along)
        return Context(dialogue, self._state, *known, self.language, ways.things)

    def context(self, under_way: Sequence[Instruction] = ()) -> Context:
        """Return what is known now, to read a text by, with these as turns before."""
        turns = (*self._dialogue.turns, *map(self._as_if_done, under_way))
        return self._context(replace(self._dialogue, turns=turns, places=self.places.all()))

    def would_mean(self, text: str) -> Interpretation:
        """Return what `text` would mean if it were said now. From any thread: nothing is noted."""
        return self.read(text, self.context())

    def read(self, text: str, context: Context) -> Interpretation:
        """Return what `text` means in that context; nothing is noted."""
        try:
            return self._interpreter.interpret(text, context)
        except Exception as error:  # a fault in reading one text ends no session, and is told
            if os.environ.get("CHATROBOT_DEBUG"):
                raise
            told = say(self.language, "reading_failed", problem=type(error).__name__)
            return Interpretation("unclear", told, self.language, code="reading_failed")

    def can_do(self, text: str) -> bool:
        """Return whether `text` would be driven if it were said now. From any thread."""
        return self.would_mean(text).outcome == "plan"

    def place_names(self) -> list[tuple[str, ...]]:
        """Return the names of each place that can be gone to, the person's own first."""
        own = self.usable_places
        return [*((name,) for name in own), *(names for names in self._names if names[0] not in own)]

    @property
    def is_measured(self) -> bool:
        """True where the robot has odometry, as far as is known."""
        return self._state.is_measured

    def note_notice(self, code: str) -> None:
        """Note that Motion drives without odometry, whatever our profile says, or that it reaches no robot now."""
        if code == OPEN_LOOP:
            self._state = replace(self._state, is_measured=False)
        elif code in ("wire_gone", "wire_back"):
            self._reaches_robot = code == "wire_back"

    def stop_code(self, code: str = "stopped_now") -> str:
        """Return the phrase of a stop that is true: what nobody reaches or measures is not said to stand."""
        if not self._reaches_robot:
            return f"{code}_unreached"
        return code if self.is_measured else f"{code}_unmeasured"

    @property
    def hears_robot(self) -> bool:
        """True once the robot has said where it is."""
        return self._started

    def misses_robot(self, meant: Interpretation) -> bool:
        """Return whether `meant` cannot be answered before the robot has said where it is."""
        return not self.hears_robot and meant.reply == say(meant.language, UNHEARD)

    def tells_it_stands(self, meant: Interpretation) -> bool:
        """Return whether the answer is that the robot stands and is ready."""
        return meant.reply == say(meant.language, "answer_standing")

    def tells_it_moves(self, meant: Interpretation) -> bool:
        """Return whether the answer is that the robot moves, and how fast."""
        return meant.reply == say(meant.language, "answer_moving", speed_mps=self.speed_mps)

    @property
    def speed_mps(self) -> float:
        """Return how fast the robot last said it was."""
        return math.hypot(self._state.twist.vx_mps, self._state.twist.vy_mps)

    @property
    def last_done(self) -> Step | None:
        """Return the last step of the last turn that moved; None where that took another one back."""
        last = next((turn for turn in reversed(self._dialogue.turns) if turn.moved), None)
        return last.way[-1] if last is not None and last.way and last.walk is None else None

    def undone_programs(self, meant: Interpretation) -> Entry | None:
        """Return the ledger's entry that `meant` does again, where it was undone whole and programs are in it."""
        if meant.walk is None or meant.walk.kind != "redo":
            return None
        entry = self._dialogue.ledger.redoes()
        return entry if entry is not None and entry.programs and not entry.back else None

    def amended(self, plan: Plan, said: str) -> Plan | None:
        """Return the plan with what `said` changes of it; None where that says anything else."""
        return self._interpreter.amended(plan, said, self.context())

    @property
    def limit_mps(self) -> float | None:
        """Return the highest speed that a person allows; None where nobody has said one."""
        limit_mps = self._dialogue.usual.limit_mps
        return None if limit_mps == math.inf else limit_mps

    def within_limit(self, step: Step) -> Step:
        """Return the step no faster than the person allows."""
        return step if self.limit_mps is None else kept_within(step, self.limit_mps, self.profile)

    def accept(self, plan: Plan) -> Interpretation:
        """Return the meaning of a plan as it is: there is nothing to understand, but it keeps to the speed limit."""
        meant = Interpretation("plan", "", self.language, plan)
        return meant if self.limit_mps is None else within_limit(meant, self.limit_mps, self.profile)

    def say(self, code: str, text: str, **values: float | str) -> str:
        """Return a phrase in the language of `text`, what the person said."""
        self.hear_language(text)
        return say(self.language, code, text=text[:80], **values)

    def hear_language(self, text: str) -> None:
        """Answer in the language of `text`, where it has one."""
        self.language = self.language_of(text)

    def language_of(self, text: str) -> LanguageCode:
        """Return the language of `text`; of what was said last, where it has none."""
        return language_of(text, self.language) if any(map(str.isalpha, text)) else self.language

    def note_telemetry(self, event: Telemetry, *, is_ours: bool) -> None:
        """Note where the robot is. `is_ours`: a turn of ours moves it, or may."""
        self._lose(self._rest.hear(event, is_ours=is_ours))
        around = event.battery_percent, event.nearest_obstacle_m, event.sectors_m
        self._state = RobotState(event.pose, event.twist, event.moving, event.path_m, *around)
        if not self._started:
            self._started = True
            self._dialogue = replace(self._dialogue, start_pose=event.pose)

    def note_place(self, event: Remembered) -> None:
        """Remember a place that a plan named."""
        self.places.add(event.place, event.pose)

    def note_unmoved(self, text: str, meant: Interpretation) -> None:
        """Remember a turn that ended without motion; it may still have taught us something."""
        if meant.outcome == "answered":
            self._learn(meant)
            if meant.remember_place:
                self.places.add(meant.remember_place, self._state.pose)
        outcomes: dict[str, Outcome] = {"unclear": "unclear", "refused": "refused", "answered": "answered"}
        self._record(TurnRecord(text, outcomes.get(meant.outcome, "stopped"), told=meant.reply))
        pending = meant.open_text or text if meant.outcome == "unclear" and not meant.is_held else ""
        held, offered = meant.held_plan, meant.offered_plan
        self._dialogue = replace(self._dialogue, pending=pending, held=held, offered=offered)

    def close_question(self) -> None:
        """Let nothing that was asked wait for an answer any more: a stop came, or an order that is done."""
        self._dialogue = replace(self._dialogue, pending="", held=None, offered=None)

    def note_finished(
        self,
        text: str,
        meant: Interpretation,
        finished: Finished,
        rehearse_only: bool,
        program_number: int = 0,
    ) -> str:
        """Remember a turn of a plan or a program as it really went; return the reply."""
        outcome = finished.outcome
        # What holds from now on does, whatever came of the order beside it.
        self._learn(meant if outcome == "completed" else replace(meant, define={}, renamed={}))
        plan = meant.plan if outcome in ("completed", "stopped", "failed") and not rehearse_only else None
        told = describe_end(finished, meant.language, meant.plan.steps if meant.plan is not None else ())
        record = TurnRecord(
            text, outcome, plan, walk=meant.walk, program=program_number, told=told, corrects=meant.corrects
        )
        self._note_end(replace(record, wanted=meant.plan if outcome == "refused" else None), finished)
        if outcome == "refused":  # `no, 2 m` changes what could not be done
            self._dialogue = replace(self._dialogue, offered=meant.plan)
        return say(meant.language, "only_rehearsed") if rehearse_only and outcome == "completed" else told

    def describe(self, steps: Sequence[Step]) -> str:
        """Return steps in a few words."""
        return describe_steps(steps, self.language)

    def note_model_turn(self, text: str, ended: Ended, rehearse_only: bool) -> str:
        """Remember a turn that a model planned; return the reply, in the language of the order."""
        language = self.language_of(text)
        plan = plan_of(ended.steps) if not rehearse_only and ended.finished is not None else None
        told = describe_model_end(ended, language)
        self._note_end(TurnRecord(text, ended.outcome, plan, told=told), ended.finished)
        return say(language, "only_rehearsed") if rehearse_only and ended.outcome == "completed" else told

    def _learn(self, meant: Interpretation) -> None:
        for name, new in meant.renamed.items():
            self.places.rename(name, new)
        words = self._words.learn(meant.define, meant.renamed)
        usual = self._dialogue.usual.changed(meant.usual)
        self._dialogue = replace(self._dialogue, words=words, usual=usual)

    def take_unkept(self) -> Reason | None:
        """Return why places, or words, are kept for this session only; once, None where they are kept."""
        return self.places.take_unkept() or self._words.take_unkept()

    def _as_if_done(self, instruction: Instruction) -> TurnRecord:
        text, meant, start = instruction
        plan, pose = meant.plan, self._state.pose
        return TurnRecord(
            text, "completed", plan, start, pose, plan, walk=meant.walk, corrects=meant.corrects
        )

    def _note_end(self, record: TurnRecord, finished: Finished | None) -> None:
        """Enter a turn into the ledger; one that Motion has ended, as it was measured."""
        self.close_question()
        if finished is None:
            self._record(record)
            return
        if finished.duration_s:
            self._state = replace(self._state, pose=finished.pose, twist=ZERO_TWIST, moving=False)
        self._lose(self._rest.begin(finished))
        record = replace(
            record,
            start_pose=finished.start,
            end_pose=finished.pose,
            executed=plan_in(finished.executed),
            remaining=plan_in(finished.remaining),
            lost="" if finished.measured else UNMEASURED,
            duration_s=finished.duration_s,
        )
        self._record(record)
        self._lose(self._rest.end(finished))

    def _lose(self, code: str) -> None:
        """Nobody can tell any more how to get back to where the turns up to now began."""
        if code:
            turns = tuple(replace(turn, lost=turn.lost or code) for turn in self._dialogue.turns)
            self._dialogue = replace(self._dialogue, turns=turns)

    def _record(self, record: TurnRecord) -> None:
        turns = (*self._dialogue.turns, record)[-REMEMBERED_TURNS:]
        self._dialogue = replace(self._dialogue, turns=turns)
