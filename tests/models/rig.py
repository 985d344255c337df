"""A scripted server and every provider pointed at it."""

from __future__ import annotations

import time
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from chatrobot.models.config import ModelConfig
from chatrobot.models.fake.script import read_script
from chatrobot.models.fake.server import FakeModel
from chatrobot.models.make import make_model
from chatrobot.models.providers import providers
from chatrobot.models.seam import CallLimits, Message, Model, ModelError, Usage

KEY = "sk-test-0123456789abcdef"
MODEL = "org/fake"
WIRES = ("openai", "openai-responses", "anthropic", "google")
"""One provider of each wire format."""
ALL = tuple(providers())
_ROOTED = ("anthropic", "google", "ollama", "deepseek")
"""Those whose base URL has no /v1 in it."""


@contextmanager
def serving(replies: Any, **top: Any) -> Iterator[FakeModel]:
    script = read_script({"models": [MODEL, "fake"], "replies": replies, **top})
    with FakeModel(script) as fake:
        yield fake


def config_for(provider: str, url: str, *, key: str = KEY, **more: Any) -> ModelConfig:
    row = providers()[provider]
    address = url if provider in _ROOTED else f"{url}/v1"
    environ = {row.base_url_variables[0]: address}
    if key and row.key_variables:
        environ[row.key_variables[0]] = key
    return ModelConfig(environ=environ, keyring=False, **more)


def model_at(provider: str, url: str, *, key: str = KEY, name: str = "", **more: Any) -> Model:
    name = name or (MODEL if provider == "openrouter" else "fake")
    return make_model(f"{provider}:{name}", config_for(provider, url, key=key, **more))


class Got:
    """A reply to its end."""

    def __init__(self, model: Model, *said: str, limits: CallLimits | None = None, system: str = "") -> None:
        messages = [Message("system", system)] if system else []
        roles = ("user", "assistant")
        messages += [Message(roles[index % 2], text) for index, text in enumerate(said)]  # type: ignore[arg-type]
        began_s = time.monotonic()
        self.pieces: list[str] = []
        self.error: ModelError | None = None
        reply = model.ask(messages, limits or CallLimits())
        try:
            for piece in reply:
                self.pieces.append(piece)
        except ModelError as error:
            self.error = error
        self.took_s = time.monotonic() - began_s
        self.usage: Usage | None = reply.usage

    @property
    def text(self) -> str:
        return "".join(self.pieces)

    @property
    def code(self) -> str:
        return self.error.reason.code if self.error is not None else ""

    @property
    def values(self) -> dict[str, Any]:
        assert self.error is not None
        return dict(self.error.reason.values)
