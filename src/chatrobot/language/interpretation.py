"""Free text → what is to happen, without a model."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal

from chatrobot.language.clauses import read_frames
from chatrobot.language.context import Context
from chatrobot.language.lexicon import Key, Meaning, lexicon
from chatrobot.language.manner import Pace
from chatrobot.language.normalise import MAX_CHARACTERS, has_chinese, normalise
from chatrobot.language.quantities import read_quantities
from chatrobot.language.script import write
from chatrobot.language.tidy import tidy
from chatrobot.language.tokens import tokenise
from chatrobot.language.unclear import Unclear
from chatrobot.plan.steps import Plan
from chatrobot.robots.profile import RobotProfile

LanguageCode = Literal["en", "zh"]


@dataclass(frozen=True)
class Interpretation:
    """What an utterance means. `unaccounted` is the part that nothing explains; the last fields are for memory:

    they hold from the moment the session accepts the turn.
    """

    outcome: Literal["plan", "stop", "unclear", "refused", "answered"]
    reply: str
    language: LanguageCode
    plan: Plan | None = None
    append: bool = False
    unaccounted: str = ""
    define: Mapping[str, Plan] = field(default_factory=dict)
    remember_place: str = ""
    default_speed_mps: float | None = None
    default_rate_radps: float | None = None


class OfflineInterpreter:
    """Understands English and Chinese by rules over data. Keeps no state: the dialogue comes with the context."""

    def __init__(self, profile: RobotProfile) -> None:
        self._profile = profile

    def interpret(self, text: str, context: Context) -> Interpretation:
        """What `text` means in this context. Never raises, whatever the text."""
        language: LanguageCode = "zh" if has_chinese(text[:MAX_CHARACTERS]) else "en"
        if len(text) > MAX_CHARACTERS:
            return Interpretation("unclear", "too long", language)
        plain = normalise(text)
        try:
            atoms = tidy(read_quantities(tokenise(plain, lexicon(), self._names(context))))
            steps = write(read_frames(atoms), self._pace(context))
            return Interpretation("plan", "ok", language, Plan(tuple(steps)))
        except Unclear as problem:
            outcome: Literal["unclear", "refused"] = "refused" if problem.refused else "unclear"
            return Interpretation(outcome, f"{problem.code} {problem.part}", language, unaccounted=problem.part)

    def _pace(self, context: Context) -> Pace:
        return Pace(self._profile, context.dialogue.default_speed_mps, context.dialogue.default_rate_radps)

    def _names(self, context: Context) -> dict[Key, Meaning]:
        return {}
