"""Free text → what is to happen, without a model."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import lru_cache
from typing import Literal

from chatrobot import reflex
from chatrobot.language import forms, questions
from chatrobot.language.amends import amended
from chatrobot.language.arithmetic import settle_condition
from chatrobot.language.asides import check_finished, is_choice, without_asides
from chatrobot.language.brackets import unrolled
from chatrobot.language.chatter import without_chatter
from chatrobot.language.clauses import read_frames
from chatrobot.language.compass import split_convention, with_headings
from chatrobot.language.context import Context, Dialogue
from chatrobot.language.corrections import corrected, without_negated
from chatrobot.language.dialogue import refer, state_after
from chatrobot.language.facing import without_compass
from chatrobot.language.facts import (
    defined_unit,
    unit_length_m,
    with_defined_units,
    with_known_counts,
    with_words_counted,
)
from chatrobot.language.frames import STILL, Frame
from chatrobot.language.heeded import check_heeded
from chatrobot.language.lexicon import Key, Meaning, cut, lexicon
from chatrobot.language.manner import Pace
from chatrobot.language.multiples import with_multiples
from chatrobot.language.normalise import MAX_CHARACTERS, has_chinese, normalise
from chatrobot.language.order import in_order
from chatrobot.language.phrases import describe_plan, say
from chatrobot.language.program_request import read_program_request
from chatrobot.language.quantities import read_quantities
from chatrobot.language.rephrase import rephrased
from chatrobot.language.restated import without_restated
from chatrobot.language.script import Memory, write
from chatrobot.language.sounds import mended
from chatrobot.language.tidy import tidy
from chatrobot.language.tokens import Atom, tokenise
from chatrobot.language.tutorial_form import read_twist
from chatrobot.language.unclear import Unclear
from chatrobot.language.unfinished import breaks_off
from chatrobot.language.until import UntilObstacle, read_until
from chatrobot.plan.steps import Drive, Go, ObstacleWithin, Plan, Remember, Step
from chatrobot.robots.profile import RobotProfile

LanguageCode = Literal["en", "zh"]
Outcome = Literal["plan", "stop", "unclear", "refused", "answered"]

_BREAKS = re.compile(
    r"(?<!\d)[,.;!?](?!\d)|(?<=\d)[,.;!?](?=\s|$)|[,.;!?]\s|,|\n|"
    r"\b(?:and then|then|and)\b|然后|接着|再|并且|并|之后"
)


@dataclass(frozen=True)
class Interpretation:
    """What an utterance means.

    `unaccounted` is the part that nothing explains, `code` the reason in a word (see `phrases.toml`).
    `append`: it goes on where the running motion ends. The last four are for the dialogue's memory and hold
    from the moment the session accepts the turn; `remember_place` is where the robot stands now.
    """

    outcome: Outcome
    reply: str
    language: LanguageCode
    plan: Plan | None = None
    append: bool = False
    unaccounted: str = ""
    code: str = ""
    define: Mapping[str, Plan] = field(default_factory=dict)
    remember_place: str = ""
    default_speed_mps: float | None = None
    default_rate_radps: float | None = None


class OfflineInterpreter:
    """Understands English and Chinese by rules over data. Keeps no state.

    The dialogue comes with the context.
    """

    def __init__(self, profile: RobotProfile) -> None:
        self._profile = profile

    def interpret(self, text: str, context: Context) -> Interpretation:
        """What `text` means in this context. Never raises, whatever the text."""
        language: LanguageCode = "zh" if has_chinese(text[:MAX_CHARACTERS]) else "en"
        if len(text) > MAX_CHARACTERS:
            return Interpretation(
                "unclear", say(language, "too_long", characters=len(text)), language, code="too_long"
            )
        try:
            return _Reading(text, language, context, self._profile).interpretation()
        except Unclear as problem:
            return _asked_back(problem, language)


def _asked_back(problem: Unclear, language: LanguageCode) -> Interpretation:
    outcome: Outcome = "refused" if problem.refused else "unclear"
    reply = say(language, problem.code, part=problem.part)
    return Interpretation(outcome, reply, language, unaccounted=problem.part, code=problem.code)


class _Reading:
    """One utterance in its context."""

    def __init__(self, text: str, language: LanguageCode, context: Context, profile: RobotProfile) -> None:
        self.text, self.language, self.context, self.profile = text, language, context, profile
        self.by_ear = False
        plain = with_known_counts(without_compass(rephrased(normalise(text), language), language))
        rest, self.facing_rad = split_convention(plain, language)
        self.plain = rest or plain
        dialogue = context.dialogue
        self.pace = Pace(profile, dialogue.default_speed_mps, dialogue.default_rate_radps)

    def interpretation(self) -> Interpretation:
        if not self.plain:
            raise Unclear("empty")
        program = read_program_request(self.plain)
        if program is not None:
            return self._plan(program)
        twist = read_twist(self.plain)
        if twist is not None:
            return self._plan([twist])
        if reflex.is_stop(self.text) or reflex.is_stop(self.plain):
            return Interpretation("stop", say(self.language, "stop"), self.language)
        definition = forms.read_definition(self.plain, self.language)
        if definition is not None:
            return self._defined(definition)
        answered = self._remembering() or self._pending()
        if answered is not None:
            return answered
        unit = defined_unit(self.plain)
        if unit is not None:
            reply = say(self.language, "unit_set", unit=unit[0], measure=unit[1])
            return Interpretation("answered", reply, self.language)
        return self._command(self._with_earlier_unit(self.plain))

    def _with_earlier_unit(self, plain: str) -> str:
        """一步是三十厘米, said in a turn before: it holds for the steps that are counted now."""
        for turn in reversed(self.context.dialogue.turns):
            unit = _unit_defined_in(turn.text, self.language)
            counted = unit and re.search(rf"(?:[零一二两三四五六七八九十百\d]|半) ?{unit[0]}", plain)
            if unit and counted:
                defined_here = re.search(rf"一 ?{unit[0]}[^,。;]*(?:是|算|等于|为|按)", plain)
                return plain if defined_here else f"{plain}, 一{unit[0]}是{unit[1]}"
        return plain

    def _defined(self, definition: forms.Definition) -> Interpretation:
        inner = self._command(definition.body)
        if inner.plan is None:
            return inner
        reply = say(
            self.language, "defined", name=definition.name, text=describe_plan(inner.plan, self.language)
        )
        return Interpretation("answered", reply, self.language, define={definition.name: inner.plan})

    def _remembering(self) -> Interpretation | None:
        """Clauses that name the place where the robot stands, before, after or between motions."""
        whole = forms.read_place(self.plain, self.language)
        if whole and not _BREAKS.search(self.plain.strip(" ,.!;?")):
            return self._placed([Remember(whole)])
        clauses = _clauses(self.plain)
        names = [forms.read_place(clause, self.language) for clause in clauses]
        if not any(names):
            return self._placed([Remember(whole)]) if whole else None
        steps: list[Step] = []
        pending = ""
        for k, (clause, name) in enumerate(zip(clauses, names)):
            if name is None:
                pending += clause
                continue
            steps += self._steps(pending)
            pending = ""
            following = names[k + 1] if k + 1 < len(names) else None
            if not (name == forms.UNNAMED and following):
                steps.append(Remember(name))
        return self._placed([*steps, *self._steps(pending)])

    def _placed(self, steps: list[Step]) -> Interpretation:
        if len(steps) == 1 and isinstance(steps[0], Remember):
            reply = say(self.language, "step_remember", place=steps[0].place)
            return Interpretation("answered", reply, self.language, remember_place=steps[0].place)
        return self._plan(steps)

    def _steps(self, clause: str) -> list[Step]:
        atoms = self._atoms(clause)
        if all(a.kind in ("sep", "conn", "filler", "glue", "reason") for a in atoms):
            return []
        inner = self._command(clause)
        if inner.plan is None:
            raise Unclear(
                inner.code or "unknown_part",
                inner.unaccounted or clause.strip(),
                refused=inner.outcome == "refused",
            )
        return list(inner.plan.steps)

    def _pending(self) -> Interpretation | None:
        """A fragment answers what was asked back about the turn before."""
        pending = self.context.dialogue.pending
        if not pending or len(pending) + len(self.plain) > MAX_CHARACTERS:
            return None
        atoms = tidy(self._atoms(self.plain))
        ways = [k for k, a in enumerate(atoms) if k and a.kind == "dir" and atoms[k - 1].text == a.text]
        verbs = [a for k, a in enumerate(atoms) if k + 1 not in ways and a.text not in ("say",)]
        if any(a.kind in ("verb", "shape", "place") for a in verbs):
            return None
        before = rephrased(normalise(pending), self.language)
        for joined in (f"{before} {self.plain}", f"{before}, {self.plain}"):
            try:
                found = self._command(joined)
            except Unclear:
                continue
            if found.outcome == "plan":
                return found
        return None

    def _command(self, plain: str) -> Interpretation:
        """What a command means as it stands; else, what it sounds like."""
        try:
            return self._understood(plain)
        except Unclear as problem:
            heard = None if problem.refused or self.by_ear else self._heard(plain)
            if heard is None:
                raise
            return heard

    def _heard(self, plain: str) -> Interpretation | None:
        if self.language == "en":
            return None
        self.by_ear = True
        try:
            found = self._understood(mended(plain, self.language))
        except Unclear:
            return None
        finally:
            self.by_ear = False
        return found if found.outcome == "plan" else None

    def _understood(self, plain: str) -> Interpretation:
        atoms = self._atoms(plain)
        command = questions.without_quiz(plain, self.language)
        if command and not questions.is_question(command, self.language):
            return self._understood(command)
        amounts = any(a.kind == "q" and a.value in ("length", "angle", "turns") for a in atoms)
        if amounts and is_choice(plain, self.language):
            raise Unclear("contradiction", plain[:60])
        asks = questions.is_question(plain, self.language)
        ability = questions.asks_ability(plain, self.language)
        doubt = next((a for a in atoms if a.kind == "doubt" and a.text != "来着"), None)
        if doubt is not None and not plain.endswith("?") and not any(a.kind == "refuse" for a in atoms):
            raise Unclear("unknown_part", doubt.text)
        refusal = next((a for a in atoms if a.kind == "refuse"), None)
        if (asks and refusal is None) or (refusal is None and ability):
            found = self._question(plain, atoms, ability)
            if found is not None:
                return found
        if refusal is not None:
            if ability and plain.endswith("?"):
                return Interpretation("answered", say(self.language, "answer_cannot"), self.language)
            raise Unclear(f"refuse_{refusal.value}", refusal.text, refused=True)
        if self._is_stop(plain):
            return Interpretation("stop", say(self.language, "stop"), self.language)
        loose = "" if asks else breaks_off(plain, self.language)
        if loose and not self._known_name(loose):
            raise Unclear("unknown_part", f"{loose} …")
        if is_choice(plain, self.language):
            raise Unclear("contradiction", plain[:60])
        check_finished(atoms)
        until = read_until(plain, self.language)
        if until is not None:
            return self._until(until)
        frames = _frames(atoms)
        default = self._default(frames)
        if default is not None:
            return default
        steps = self._read(frames)
        if not asks:
            check_heeded(atoms, steps, lambda changed: self._read(_frames(changed)))
        return self._plan(steps, append=_appends(atoms))

    def _read(self, frames: list[Frame]) -> list[Step]:
        """The steps that the frames mean here and now."""
        undone = amended(frames, self.context)
        return [
            *undone,
            *(refer(frames, self.context, self.pace) or write(frames, self.pace, self._memory())),
        ]

    def _until(self, until: UntilObstacle) -> Interpretation:
        frames = _frames(self._atoms(until.before))
        steps = write(frames, self.pace, self._memory())
        last = steps[-1]
        if not isinstance(last, Drive):
            raise Unclear("condition", until.before)
        said = frames[-1].has_extent
        steps[-1] = replace(
            last,
            distance_m=last.distance_m if said else None,
            duration_s=last.duration_s if said else None,
            until=ObstacleWithin(until.distance_m),
        )
        return self._plan([*steps, *self._steps(until.after)])

    def _known_name(self, words: str) -> bool:
        return any(words.split()[-1] in key for key in self._names())

    def _is_stop(self, plain: str) -> bool:
        """Whether one clause is a stop and none of the others could move anything."""
        clauses = [part for part in re.split(r"[,.;!?…—\n]| - ", plain) if part.strip()]
        stops = [reflex.is_stop(clause) for clause in clauses]
        if len(clauses) < 2 or not any(stops):
            return False
        others = [a for clause, stop in zip(clauses, stops) if not stop for a in self._atoms(clause)]
        moving = ("q", "dir", "rot", "shape", "place", "defined", "number", "pace", "condition")
        return not any(
            a.kind in moving or (a.kind == "verb" and a.value not in (*STILL, "make")) for a in others
        )

    def _question(self, plain: str, atoms: list[Atom], ability: bool) -> Interpretation | None:
        """The answer, unless it is a command put as a question."""
        try:
            frames = _frames(atoms)
            check_finished(atoms)
            steps = refer(frames, self.context, self.pace) or write(frames, self.pace, self._memory())
            steps = [] if is_choice(plain, self.language) else steps
            plain_question = questions.is_plain_question(plain, self.language)
            if steps and any(f.has_extent or (f.moves and not plain_question) for f in frames):
                return None
        except Unclear:
            pass
        if questions.orders(plain, self.language):
            return None
        topic = questions.topic_of(plain, self.language)
        if not topic and ability:
            topic = "ability"
        if not topic:
            return None
        reply = questions.answer(topic, self.language, self.context, self.profile)
        return Interpretation("answered", reply, self.language)

    def _default(self, frames: list[Frame]) -> Interpretation | None:
        """`From now on drive at 10 cm/s`."""
        if not frames or not any("from_now_on" in frame.flags for frame in frames):
            return None
        if len(frames) > 1 or frames[0].has_extent or frames[0].direction or frames[0].shape:
            raise Unclear("unclear_motion", frames[0].text)
        frame = frames[0]
        turning = frame.turning or "rate" in frame.q
        speed = None if turning else self.pace.speed(frame)
        rate = self.pace.rate(frame) if turning else None
        if speed is None and rate is None:
            raise Unclear("unclear_motion", frame.text)
        code, values = (
            ("default_set", {"mps": speed}) if speed is not None else ("default_rate_set", {"radps": rate})
        )
        reply = say(self.language, code, **{k: f"{v:.3g}" for k, v in values.items() if v is not None})
        return Interpretation(
            "answered", reply, self.language, default_speed_mps=speed, default_rate_radps=rate
        )

    def _plan(self, steps: list[Step], *, append: bool = False) -> Interpretation:
        try:
            plan = Plan(tuple(steps))
        except ValueError:
            raise Unclear("nothing_to_do") from None
        return Interpretation("plan", describe_plan(plan, self.language), self.language, plan, append)

    def _atoms(self, plain: str) -> list[Atom]:
        atoms = tokenise(plain, lexicon(), self._names(), by_ear=self.by_ear)
        atoms = without_restated(with_multiples(read_quantities(without_asides(atoms, self.language))))
        atoms = with_headings(atoms, self.facing_rad)
        atoms = with_words_counted(atoms, self.context.dialogue.words)
        if any(a.kind == "role" and a.value == "apart" for a in atoms):  # rows side by side, no garden work
            atoms = [Atom("shape", "lawn", a.text) if a.text == "mow the lawn" else a for a in atoms]
        return atoms

    def _names(self) -> dict[Key, Meaning]:
        dialogue = self.context.dialogue
        names: dict[Key, Meaning] = {}
        for name in (*self.context.world_places, *dialogue.places):
            names[cut(normalise(name))] = (("place", name),)
        for word, plan in dialogue.words.items():
            counter = ("counter", word) in lexicon().words.get(cut(word), ())
            if counter and unit_length_m(plan) is not None:
                continue  # a unit: it is counted
            names[cut(normalise(word))] = (("defined", word),)
            if word.isascii() and not word.endswith("s"):
                names[cut(normalise(f"{word}s"))] = (("defined", word),)
        if forms.UNNAMED in dialogue.places:
            for written in (
                "that place",
                "the place you remembered",
                "that spot",
                "the marked spot",
                "那个地方",
                "记住的地方",
                "刚才记住的地方",
                "the saved spot",
                "the saved place",
                "the marked place",
                "那个位置",
                "the remembered place",
                "the remembered spot",
                "the spot you remembered",
                "刚才记住的位置",
                "记住的位置",
            ):
                names[cut(written)] = (("place", forms.UNNAMED),)
        return names

    def _memory(self) -> Memory:
        dialogue: Dialogue = self.context.dialogue
        places = {name: Go(p.x_m, p.y_m, place=name) for name, p in self.context.world_places.items()}
        for name, place in dialogue.places.items():
            if place.usable:
                places[name] = Go(place.pose.x_m, place.pose.y_m, place=name)
        words = {name: plan.steps for name, plan in dialogue.words.items()}
        return Memory(places, words, replace(state_after(self.context)))


@lru_cache(maxsize=128)
def _unit_defined_in(text: str, language: str) -> tuple[str, str] | None:
    """Asked of every earlier turn at each sentence: so each is read once."""
    return defined_unit(rephrased(normalise(text), language))


def _frames(atoms: list[Atom]) -> list[Frame]:
    settled = settle_condition(with_defined_units(without_chatter(unrolled(atoms))))
    return read_frames(tidy(without_negated(in_order(corrected(settled)))))


def _clauses(text: str) -> list[str]:
    """The text cut before and after each break, nothing lost."""
    parts, at = [], 0
    for found in _BREAKS.finditer(text):
        parts.append(text[at : found.start()])
        parts.append(found.group())
        at = found.end()
    parts.append(text[at:])
    merged: list[str] = []
    for part in parts:
        if merged and not part.strip():
            merged[-1] += part
        else:
            merged.append(part)
    return merged


def _appends(atoms: list[Atom]) -> bool:
    first = next((a for a in atoms if a.kind != "filler"), None)
    return first is not None and first.kind == "conn"
