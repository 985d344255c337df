"""One utterance in its context: its atoms, their frames, the steps these mean."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from chatrobot.language.announced import with_announced
from chatrobot.language.around import around_places, once_around
from chatrobot.language.back import check_leads_to_start, driven_back
from chatrobot.language.brackets import unrolled
from chatrobot.language.chatter import without_cautions, without_chatter
from chatrobot.language.clauses import read_frames
from chatrobot.language.compass import with_headings
from chatrobot.language.conditions import settle_condition
from chatrobot.language.context import Context
from chatrobot.language.corrections import corrected, with_denied_motions, with_slips, without_negated
from chatrobot.language.dialogue import refer, walked
from chatrobot.language.ellipsis import with_rates
from chatrobot.language.facts import with_defined_units, with_words_counted
from chatrobot.language.frames import GO, STILL, TURN, Frame
from chatrobot.language.interpretation import LanguageCode
from chatrobot.language.last_motion import speeds_said, state_after
from chatrobot.language.lexicon import lexicon
from chatrobot.language.manner import Pace
from chatrobot.language.meant import instead
from chatrobot.language.multiples import in_shares, with_multiples
from chatrobot.language.names import names_in, without_light_words
from chatrobot.language.numbers import is_chinese
from chatrobot.language.order import in_order
from chatrobot.language.quantities import read_quantities
from chatrobot.language.restated import without_restated, without_told_before
from chatrobot.language.returning import back_to_places
from chatrobot.language.script import Memory
from chatrobot.language.standing import by_places, facing, stood
from chatrobot.language.tidy import tidy
from chatrobot.language.tokens import SILENT, Atom, tokenise
from chatrobot.language.turned_sides import with_turned_sides
from chatrobot.language.unclear import Unclear
from chatrobot.language.undo import Walked
from chatrobot.language.writing import write
from chatrobot.plan.base import rounded_angle
from chatrobot.plan.steps import Go, Step
from chatrobot.robots.profile import RobotProfile


def frames_of(atoms: Sequence[Atom]) -> list[Frame]:
    """The frames of an utterance, with what was taken back or forbidden left out.

    Raises:
        Unclear: for a word that nothing accounts for.
    """
    settled = settle_condition(with_defined_units(without_chatter(with_announced(unrolled(atoms)))))
    return without_told_before(read_frames(tidy(without_negated(in_order(corrected(settled))))))


@dataclass(frozen=True)
class Reading:
    """How texts are read here and now.

    `facing_rad` is the heading on the map that a person said the robot has, if one did.
    `by_ear`: what sounds like a longer word is that word.
    """

    language: LanguageCode
    context: Context
    profile: RobotProfile
    facing_rad: float | None = None
    by_ear: bool = False

    @property
    def pace(self) -> Pace:
        """The robot's limits, and the speeds that are usual in this dialogue."""
        usual, before = self.context.dialogue.usual, speeds_said(self.context.dialogue)
        return Pace(
            self.profile, usual.speed_mps, usual.rate_radps, *before, usual.distance_m, usual.turn_rad
        )

    def atoms(self, plain: str) -> list[Atom]:
        """The atoms of a normalised text."""
        names = names_in(self.context)
        atoms = tokenise(plain, lexicon(), names, by_ear=self.by_ear)
        if {atom.kind for atom in atoms} - SILENT > {"defined"}:
            atoms = tokenise(plain, lexicon(), without_light_words(names), by_ear=self.by_ear)
        atoms = around_places(with_turned_sides(atoms))
        atoms = by_places(with_denied_motions(read_quantities(atoms)))
        atoms = without_restated(in_shares(with_multiples(with_slips(with_rates(atoms)))))
        atoms = _done_as_taught(back_to_places(with_headings(atoms, self.facing_rad)))
        atoms = without_cautions(with_words_counted(atoms, self.context.dialogue.words))
        if any(a.kind == "role" and a.value == "apart" for a in atoms):  # rows side by side, no garden work
            atoms = [Atom("shape", "lawn", a.text) if a.text == "mow the lawn" else a for a in atoms]
        return atoms

    def steps(self, frames: list[Frame]) -> list[Step]:
        """The steps that the frames mean after the turns before.

        Raises:
            Unclear: where a clause cannot be acted on.
        """
        found = self.walked(frames)
        if found is not None:
            return list(found.steps)
        return instead(frames, self.context, self._steps, self.profile) or self._steps(frames)

    def walked(self, frames: list[Frame]) -> Walked | None:
        """What the frames do if they undo turns before, or do again what was undone, and nothing else.

        Raises:
            Unclear: where there is nothing to undo, or nobody knows the way any more.
        """
        return None if _goes_on_after_undo(frames) else walked(frames, self.context, self.pace)

    def _steps(self, frames: list[Frame]) -> list[Step]:
        if _goes_on_after_undo(frames):  # `undo that and go back 1 m`
            undone = walked(frames[:1], self.context, self.pace)
            return [*(undone.steps if undone else ()), *self.steps_of_their_own(frames[1:])]
        if _goes_on_after_again(frames):  # `the same to the right, then forward 1 m`
            again = refer(frames[:1], self.context, self.pace)
            if again is None or any("again" in frame.flags for frame in frames[1:]):
                raise Unclear("unclear_motion", frames[0].text)
            return [*again, *self.steps_of_their_own(frames[1:])]
        if _goes_back_first(frames):  # `go back and wait`
            back = driven_back(frames[0], self.context, self.pace)
            if back:
                return [*back, *self.steps_of_their_own(frames[1:])]
        return refer(frames, self.context, self.pace) or self.steps_of_their_own(frames)

    def steps_of_their_own(self, frames: list[Frame]) -> list[Step]:
        """The steps of frames that do not refer to an earlier turn as a whole."""
        last = frames[-1].copy() if frames else Frame()
        steps = write(frames, self.pace, self._memory())
        check_leads_to_start(last, steps, self.context)
        return steps

    def _memory(self) -> Memory:
        dialogue = self.context.dialogue
        context = self.context
        poses = {**context.world_places, **{n: p.pose for n, p in dialogue.places.items() if p.usable}}
        places = {
            name: Go(round(p.x_m, 6), round(p.y_m, 6), rounded_angle(p.yaw_rad, 2), place=name)
            for name, p in poses.items()
        }
        for name in context.places_without_heading:
            places[name] = replace(places[name], yaw_rad=None)
        words = {name: plan.steps for name, plan in dialogue.words.items()}
        return Memory(
            places,
            words,
            state_after(self.context),
            lambda go: once_around(go, self.context),
            lambda said, known: stood(said, known, self.context),
            lambda go, before: facing(go, before, self.context),
        )


def _goes_on_after_undo(frames: Sequence[Frame]) -> bool:
    if len(frames) < 2 or frames[0].verb != "undo":
        return False
    after, told = frames[1], frames[1].has_extent or "number" in frames[1].q
    return bool((told or after.direction) and (after.joined in ("and", "then") or (told and after.moves)))


def _goes_on_after_again(frames: Sequence[Frame]) -> bool:
    """Whether the motion before is only the first of what is wanted."""
    if len(frames) < 2 or frames[0].verb or frames[1].joined != "then" or not frames[1].moves:
        return False
    return "again" in frames[0].flags and not frames[0].q and not is_chinese(frames[0].text)


def _goes_back_first(frames: Sequence[Frame]) -> bool:
    """Whether it says `go back`, and then what else."""
    if len(frames) != 2 or frames[1].joined != "and" or is_chinese(frames[0].text):
        return False
    own = (frames[1].verb in STILL or frames[1].verb in TURN or frames[1].shape) and not frames[1].flags - {
        "instead"
    }
    return bool(own) and frames[0].verb in GO


def _done_as_taught(atoms: Sequence[Atom]) -> list[Atom]:
    """`Run the salsa`, `drive a lap`: the verb right before a word that was taught drives nothing of its own."""
    out: list[Atom] = []
    for atom in atoms:
        if atom.kind == "defined":
            beside = (a.kind == "glue" or (a.kind, a.value) == ("num", "article") for a in reversed(out))
            at = len(out) - 1 - next((k for k, is_beside in enumerate(beside) if not is_beside), len(out))
            if at >= 0 and (out[at].kind, out[at].value) == ("verb", "go"):
                out[at] = Atom("verb", "make", out[at].text)
        out.append(atom)
    return out
