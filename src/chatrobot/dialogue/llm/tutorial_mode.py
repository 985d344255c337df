"""The tutorial's first instruction: it connects a model's output to the robot and shows the form to answer in."""

from __future__ import annotations

import re
from collections.abc import Sequence

from chatrobot.plan.base import Step
from chatrobot.plan.steps import RawTwist
from chatrobot.plan.tutorial_form import ImpossibleTwistError, read_tutorial_line

_EXAMPLE = re.compile(r"(?:linear|angular)\s*\.\s*[xyz]\s*=", re.IGNORECASE)
_ASKS = re.compile(
    r"\b(?:answer|reply|respond|output|translate|return|give me)\b|回答|回复|输出|翻译|返回", re.IGNORECASE
)
_LEAST_ASSIGNMENTS = 3
LONGEST_S = 10.0
"""What anybody may send in that form to the nodes (`nodes/foreign.py`), a model may, too."""


def connects_to_the_robot(text: str) -> bool:
    """Whether `text` tells a model to answer in the tutorial's form: it asks for it, and shows an example."""
    return (
        len(_EXAMPLE.findall(text)) >= _LEAST_ASSIGNMENTS and bool(_ASKS.search(text)) and not is_form(text)
    )


def is_form(text: str) -> bool:
    """Whether `text` is a line of that form itself."""
    try:
        return read_tutorial_line(text) is not None
    except ImpossibleTwistError:
        return True


def is_short_form(steps: Sequence[Step]) -> bool:
    """Whether a plan consists wholly of the tutorial's twists, and of few: the person has connected the model to the
    robot for just these."""
    twists = [step for step in steps if isinstance(step, RawTwist)]
    return 0 < len(twists) == len(steps) and sum(step.duration_s for step in twists) <= LONGEST_S
