"""A conversation that the server holds (Responses API): only what it does not know yet is sent.

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
    """Where a server-held conversation stands. Locked: `forget` may come from another thread than the calls."""

    def __init__(self, config: ModelConfig) -> None:
        given = config.variable(VARIABLE)
        self._lock = threading.Lock()
        self._conversation = given if given.startswith("conv") else ""
        self._previous = "" if self._conversation else given

    def prepare(self, request: Any, messages: Sequence[Message]) -> None:
        """Leave out of `request` what the server has heard already.

        The system's words are said each time: the
        protocol does not keep them from one response to the next.
        """
        with self._lock:
            request.conversation, request.previous_response = self._conversation, self._previous
        if request.conversation or request.previous_response:
            request.messages = _unknown(messages)

    def is_lost(self, error: BaseException) -> bool:
        """Whether this error says that the server no longer knows what we went on from; then we begin anew."""
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
        """The server has kept its reply under that id."""
        with self._lock:
            if not self._conversation:
                self._previous = response_id

    def forget(self) -> None:
        """Begin a new conversation with the next call."""
        with self._lock:
            self._conversation = self._previous = ""


def _unknown(messages: Sequence[Message]) -> tuple[Message, ...]:
    """The system's messages and all after the last answer."""
    last = max((index for index, message in enumerate(messages) if message.role == "assistant"), default=-1)
    return tuple(
        message for index, message in enumerate(messages) if index > last or message.role == "system"
    )
