"""Goes on with a conversation that the server holds (Responses API): only what it does not know yet is sent.

The place of the first tutorials' second client: a bearer token, any base URL, and a conversation that lives elsewhere.
"""

from __future__ import annotations

import threading
from collections.abc import Sequence
from typing import Any

from chatrobot.models.config import ModelConfig
from chatrobot.models.seam import Message

VARIABLE = "CHATROBOT_CONVERSATION"
"""`conv_…` goes on with that conversation; `resp_…` goes on after that response."""


class Conversation:
    """State of a server-held conversation. Locked: `forget` may come from another thread than the calls."""

    def __init__(self, config: ModelConfig) -> None:
        given = config.variable(VARIABLE)
        self._lock = threading.Lock()
        self._conversation = given if given.startswith("conv") else ""
        self._previous = "" if self._conversation else given
        self._asking = self._heard = ""
        self._is_settled = True

    def prepare(self, request: Any, messages: Sequence[Message]) -> None:
        """Leave out of `request` what the server has heard already.

        The system's words are said each time: the protocol does not keep them from one response to the next.
        """
        with self._lock:
            if self._previous or self._conversation:
                new = self._unknown(messages)
                if new is None:  # an answer was given up, and what the server has of it nobody knows
                    self._previous = ""
                else:
                    request.messages = new
            request.conversation, request.previous_response = self._conversation, self._previous
            self._asking, self._is_settled = _last_said(messages), False

    def is_lost(self, error: BaseException) -> bool:
        """Tell whether this error says that the server no longer knows what we went on from; then we begin anew."""
        body = str(getattr(error, "body", ""))
        with self._lock:
            lost = (
                bool(self._previous)
                and getattr(error, "status_code", 0) in (400, 404)
                and "previous" in body.lower()
            )
            if lost:
                self._previous = ""
        return lost

    def answered(self, response_id: str) -> None:
        """Note that the server has kept its reply under that id."""
        with self._lock:
            self._heard, self._is_settled = self._asking, True
            if not self._conversation:
                self._previous = response_id

    def forget(self) -> None:
        """Begin a new conversation with the next call."""
        with self._lock:
            self._conversation = self._previous = self._heard = ""
            self._is_settled = True

    def _unknown(self, messages: Sequence[Message]) -> tuple[Message, ...] | None:
        """Return the system's messages and what the server has not heard; None where that cannot be told."""
        first = _after(messages, self._heard) if self._heard else None
        if first is None:
            if not self._is_settled and not self._conversation:
                return None
            answers = [index for index, message in enumerate(messages) if message.role == "assistant"]
            first = answers[-1] + 1 if answers else 0
        return tuple(
            message for index, message in enumerate(messages) if index >= first or message.role == "system"
        )


def _after(messages: Sequence[Message], heard: str) -> int | None:
    """Return the first message after the one with these words and the answer to it, or None where nobody said them."""
    said = [
        index for index, message in enumerate(messages) if message.role == "user" and message.text == heard
    ]
    if not said or said[-1] == len(messages) - 1:  # the same words said once more are new
        said = said[:-1]
    if not said:
        return None
    after = said[-1] + 1
    return after + 1 if messages[after].role == "assistant" else after


def _last_said(messages: Sequence[Message]) -> str:
    return next((message.text for message in reversed(messages) if message.role == "user"), "")
