"""Makes a model of a name: `make_model("PROVIDER:NAME", config)`. Making one touches nothing; `warm` loads ahead."""

from __future__ import annotations

import asyncio
import gc
import importlib
import sys
import threading
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from importlib.util import find_spec
from typing import Any

from chatrobot.core.reason import Reason
from chatrobot.models.config import ModelConfig
from chatrobot.models.conversation import Conversation
from chatrobot.models.failures import Place, reason_of
from chatrobot.models.keys import find_key
from chatrobot.models.providers import Provider, split_name
from chatrobot.models.reply import StreamedReply, in_background
from chatrobot.models.seam import CallLimits, Message, Model, ModelError, Reply, Usage
from chatrobot.models.secret import PieceScrubber, Secret
from chatrobot.models.usage import priced, record

EXTRA = "pip install 'chatrobot[models]'"
SWITCH_S = 0.0005
_LIBRARY = "pydantic_ai"


def make_model(name: str, config: ModelConfig | None = None) -> Model:
    """Make the model that `PROVIDER:NAME` names. The key is looked for at the first call.

    Raises:
        ModelError: `model_unknown`, where no provider has that name.
    """
    config = config or ModelConfig()
    provider, model = split_name(name)
    if provider.make is not None:
        return provider.make(model, config)
    return LibraryModel(provider, model, config)


def warm(model: Model, *, wait_s: float = 0.0) -> None:
    """Begin to load what that model needs, in the background; wait so long for it. Its first call tells of errors."""
    if isinstance(model, LibraryModel):
        done = threading.Event()
        in_background(model.get_ready(), lambda task: task.add_done_callback(lambda _: done.set()))
        if wait_s:
            done.wait(wait_s)


def problem_with(name: str, config: ModelConfig) -> Reason | None:
    """Return what stands in the way of asking `PROVIDER:NAME`: its name, the extra, the key, the address.

    Sends nothing.
    """
    try:
        provider, model = split_name(name)
    except ModelError as error:
        return error.reason
    if provider.make is not None:
        return None
    if find_spec(_LIBRARY) is None:
        return _missing_extra(provider)
    return _obstacle(Place(provider, model, provider.address(config), find_key(provider, config)))


def _missing_extra(provider: Provider) -> Reason:
    return Reason("model_missing_extra", {"command": EXTRA, "provider": provider.name})


def _obstacle(place: Place) -> Reason | None:
    """Return why nothing can be sent there."""
    if not place.secret and place.provider.needs_key:
        return place.reason("model_no_key")
    if place.secret is not None and place.secret.flaw is not None:
        return place.reason(f"model_key_{place.secret.flaw}")
    if not place.address:
        return place.reason("model_no_address", variable=place.provider.base_url_variables[0])
    return None


def _load(provider: Provider, model: str) -> Any:
    """Return the module that knows the library, with the library and its price list loaded.

    Raises:
        ModelError: `model_missing_extra`.
    """
    try:
        with _quiet_import():
            importlib.import_module(f"{_LIBRARY}.models.{provider.wire.partition('-')[0]}")
            priced(Usage(), provider.name, model)
            return importlib.import_module("chatrobot.models.library")
    except ImportError:
        raise ModelError(_missing_extra(provider)) from None


@contextmanager
def _quiet_import() -> Iterator[None]:
    """Import without holding other threads up: a stop word may be typed meanwhile.

    Collecting garbage among a million new objects keeps the interpreter for a tenth of a second at a time, and there
    is none among modules.
    """
    interval_s, was_collecting = sys.getswitchinterval(), gc.isenabled()
    gc.disable()
    sys.setswitchinterval(SWITCH_S)
    try:
        yield
    finally:
        sys.setswitchinterval(interval_s)
        if was_collecting:
            gc.freeze()
            gc.enable()


class LibraryModel:
    """`Model` (see `seam`) on the model library. What begins with `_` runs in the background thread."""

    def __init__(self, provider: Provider, model: str, config: ModelConfig) -> None:
        self._provider = provider
        self._model = model
        self._config = config
        self._conversation = Conversation(config) if provider.wire == "openai-responses" else None
        self._place: Place | None = None
        self._library: Any = None
        self._built: Any = None

    @property
    def name(self) -> str:
        """`PROVIDER:NAME`, as the person wrote it."""
        return f"{self._provider.name}:{self._model}"

    @property
    def secret(self) -> Secret | None:
        """Its key, once it has been found."""
        return self._place.secret if self._place is not None else None

    def ask(self, messages: Sequence[Message], limits: CallLimits) -> Reply:
        """Begin a call; see `seam.Model`."""
        messages = tuple(messages)
        return StreamedReply(
            lambda sink: self._produce(messages, limits, sink),
            limits,
            prompt_chars=sum(len(message.text) for message in messages),
            price=lambda usage: priced(usage, self._provider.name, self._model, self._config.folder),
            on_end=lambda usage: record(self._config, self.name, usage),
        )

    def forget(self) -> None:
        """Begin a new conversation where the server holds it."""
        if self._conversation is not None:
            self._conversation.forget()

    async def get_ready(self) -> None:
        """Do what the first call would do before it sends anything. In the background thread."""
        try:
            self._build(await self._find_place())
        except Exception:  # noqa: BLE001 - the first call meets the same, and tells
            return

    async def _find_place(self) -> Place:
        """Load the library and find the key.

        Raises:
            ModelError: what stands in the way of asking.
        """
        self._library = self._library or _load(self._provider, self._model)
        if self._place is None:
            # A keyring may ask its user to unlock it: not in the thread that all calls share.
            finding = asyncio.get_running_loop().run_in_executor(None, find_key, self._provider, self._config)
            address = self._provider.address(self._config)
            self._place = Place(self._provider, self._model, address, await finding)
        if (obstacle := _obstacle(self._place)) is not None:
            self._place = None  # a key may be in the keyring at the next call
            raise ModelError(obstacle)
        return self._place

    def _build(self, place: Place) -> None:
        if self._built is None:
            self._built = self._library.build(place)

    async def _produce(self, messages: Sequence[Message], limits: CallLimits, sink: StreamedReply) -> None:
        place = await self._find_place()
        may_be_lost = self._conversation
        while True:
            try:
                self._build(place)
                sink.begin()
                await self._stream(messages, limits, sink, place)
                return
            except ModelError:
                raise
            except Exception as error:  # noqa: BLE001 - a hostile reply may make the library raise anything
                if may_be_lost is None or not may_be_lost.is_lost(error):
                    reason = reason_of(error, place)
                    break
                may_be_lost = None  # a conversation that the server has forgotten is begun anew, once
        raise ModelError(reason)  # out here, so that no provider's error with its headers hangs on to it

    async def _stream(
        self, messages: Sequence[Message], limits: CallLimits, sink: StreamedReply, place: Place
    ) -> None:
        request = self._library.Request(messages, limits)
        if self._conversation is not None:
            self._conversation.prepare(request, messages)
        scrubber = PieceScrubber(place.secret)
        has_text = False
        try:
            async for piece in self._library.stream(self._built, self._provider, request):
                has_text = has_text or bool(piece.strip())
                sink.put(scrubber.feed(piece))
            sink.put(scrubber.rest())
        finally:
            if request.ending.usage is not None:
                sink.count(request.ending.usage)
        _judge(request.ending, place, limits, has_text=has_text)
        if self._conversation is not None:
            self._conversation.answered(request.ending.response_id)


def _judge(ending: Any, place: Place, limits: CallLimits, *, has_text: bool) -> None:
    """Check that what came is a whole reply.

    Raises:
        ModelError: it is not.
    """
    if ending.finish == "content_filter":
        raise ModelError(place.reason("model_refused", said=ending.refusal))
    if ending.finish == "length":
        raise ModelError(place.reason("model_too_long", limit_tokens=limits.reply_tokens))
    if ending.tool:
        raise ModelError(place.reason("model_called_tool", tool=place.quote(ending.tool)[:60]))
    if ending.finish == "error":
        raise ModelError(place.reason("model_server_error", status=200))
    if not ending.is_whole:
        raise ModelError(place.reason("model_cut_off"))
    if not has_text:
        raise ModelError(place.reason("model_empty"))
