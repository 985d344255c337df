"""What was done, once more, begun on the other side: `the same but right first`, `again, starting with the left`."""

from __future__ import annotations

from chatrobot.language.context import Dialogue
from chatrobot.language.inverse import flipped
from chatrobot.language.rules import form
from chatrobot.language.unclear import Unclear
from chatrobot.plan.steps import Arc, Drive, RawTwist, Repeat, Step, Turn


def begun_on(plain: str, language: str, dialogue: Dialogue) -> list[Step] | None:
    """Return the steps of the motion before, with sides exchanged where it began on the other; else None.

    Raises:
        Unclear: it led to a place or a heading, or to no side.
    """
    sides = (
        side for side in ("left", "right") if form(language, "selections", f"begun_{side}").search(plain)
    )
    side = next(sides, "")
    last = dialogue.last_motion
    if not side or last is None or last.plan is None:
        return None
    steps = list(last.plan.steps)
    mirrored = [flipped(step) for step in steps]
    first = next((k for k, (a, b) in enumerate(zip(steps, mirrored, strict=True)) if a != b), None)
    if first is None:
        raise Unclear("unclear_motion", plain[:60])  # it had no side: a turn before it, or to slide?
    return steps if _goes_left(steps[first]) == (side == "left") else mirrored


def _goes_left(step: Step) -> bool:
    """Whether a step that its mirror image differs from turns or drives to the left, or begins so."""
    if isinstance(step, Repeat):
        return _goes_left(next(inner for inner in step.steps if flipped(inner) != inner))
    if isinstance(step, RawTwist):
        return step.vy_mps > 0 or (step.vy_mps == 0 and step.wz_radps > 0)
    if isinstance(step, Drive):
        return step.direction_rad > 0
    return isinstance(step, (Turn, Arc)) and step.left
