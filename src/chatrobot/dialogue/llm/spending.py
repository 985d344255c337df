"""What a turn has used of what the person allows: rounds, tokens and time."""

from __future__ import annotations

import time

from chatrobot.core.reason import Reason
from chatrobot.dialogue.llm.terms import ModelOptions
from chatrobot.models.seam import Usage


class Spending:
    """Counts from the turn's beginning. A retry is a round that corrects the one before it, and is counted apart."""

    def __init__(self, options: ModelOptions) -> None:
        self._options = options
        self._tokens = 0
        self.began_s = time.monotonic()
        self.calls = 0
        self.retries = 0

    @property
    def rounds(self) -> int:
        """Calls that were no corrections."""
        return self.calls - self.retries

    def note(self, usage: Usage) -> None:
        """What a call has used."""
        self._tokens += usage.prompt_tokens + usage.reply_tokens

    def used_up(self) -> Reason | None:
        """Why no model may be asked any more."""
        options = self._options
        if self._tokens >= options.budget_tokens:
            return Reason("model_tokens_used", {"tokens": self._tokens, "budget": options.budget_tokens})
        if time.monotonic() - self.began_s >= options.budget_s:
            return Reason("model_time_used", {"budget_s": options.budget_s})
        return None

    def rounds_used_up(self) -> Reason | None:
        """Why there is no further round."""
        if self.rounds >= self._options.rounds:
            return Reason("model_rounds_used", {"rounds": self._options.rounds})
        return None
