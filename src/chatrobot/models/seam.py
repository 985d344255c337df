"""Declares what the project knows of a language model: messages in, pieces of text out, or one clear reason.

A model proposes; nothing it says is trusted. No provider's library is imported by this file.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Literal, Protocol

from chatrobot.core.errors import ChatRobotError
from chatrobot.core.reason import Reason

Role = Literal["system", "user", "assistant"]


@dataclass(frozen=True)
class Message:
    """One message. `picture` goes with it, a JPEG or PNG file, for models that can see."""

    role: Role
    text: str
    picture: bytes | None = None


@dataclass(frozen=True)
class CallLimits:
    """Bounds of one call: seconds to the first piece and in all, tokens and characters of the reply."""

    first_piece_s: float = 20.0
    total_s: float = 60.0
    reply_tokens: int = 1500
    reply_chars: int = 50_000


@dataclass(frozen=True)
class Usage:
    """Tokens and cost of one call, as the provider counted it; `counted` is False where it did not and we estimated.

    `cost_usd` is None where the price is not known.
    """

    prompt_tokens: int = 0
    cached_tokens: int = 0
    reply_tokens: int = 0
    cost_usd: float | None = None
    counted: bool = True


class ModelError(ChatRobotError):
    """Raised for a call that came to nothing, or to less than a whole reply. `reason` says why and with it the way out.

    Codes: model_missing_extra, model_unknown, model_no_key, model_key_not_ascii, model_key_space, model_wrong_key,
    model_no_network, model_rate_limit, model_first_piece_timeout, model_timeout, model_cut_off, model_empty,
    model_refused, model_too_long, model_not_found, model_server_error, model_broken_reply.
    """

    def __init__(self, reason: Reason) -> None:
        self.reason = reason
        super().__init__(f"{reason.code}: {dict(reason.values)}")


class Reply(Protocol):
    """Reply under way. Iterate over it for its pieces of text, in one thread; `cancel` it from any."""

    @property
    def usage(self) -> Usage | None:
        """Return what the call used, once it has ended, however it ended."""

    def __iter__(self) -> Iterator[str]:
        """Yield the pieces as they arrive.

        Raises:
            ModelError: no reply, or not a whole one. The pieces that came before it are valid.
        """

    def cancel(self) -> None:
        """End the call now; the iteration ends without an error. Returns at once."""


class Model(Protocol):
    """Model that can be asked. Making one touches nothing: the network is used by `ask` alone."""

    @property
    def name(self) -> str:
        """`PROVIDER:NAME`, as the person wrote it."""

    def ask(self, messages: Sequence[Message], limits: CallLimits) -> Reply:
        """Begin a call. Returns at once; what goes wrong is raised by the iteration.

        A model with a server-held conversation sends what the server does not know yet.
        """

    def forget(self) -> None:
        """Begin a new conversation, where the server holds it; otherwise nothing."""
