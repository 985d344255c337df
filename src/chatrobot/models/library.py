"""Knows the model library, alone: builds its models, streams their text.

Imported late and only in the background thread: loading it takes one to three seconds.
"""

from __future__ import annotations

import importlib
import warnings
from collections.abc import AsyncIterator, Sequence
from dataclasses import dataclass, field
from typing import Any

from pydantic_ai.direct import model_request_stream
from pydantic_ai.messages import (
    BinaryContent,
    ModelMessage,
    ModelRequest,
    ModelResponse,
    PartDeltaEvent,
    PartStartEvent,
    TextPart,
    TextPartDelta,
    ToolCallPart,
    UserContent,
    UserPromptPart,
)

from chatrobot.models.failures import Place
from chatrobot.models.providers import Provider
from chatrobot.models.seam import CallLimits, Message, Usage
from chatrobot.models.web_client import allow, web_client

warnings.filterwarnings("ignore", module=r"pydantic_ai\.")
SPARE_S = 5.0
"""The library's own time limit comes after ours, which has the better words."""
NO_KEY = "none"
"""Local servers want no key, but the clients want something to send."""


@dataclass
class Ending:
    """End of a call: what is known once its stream has ended."""

    usage: Usage | None = None
    is_whole: bool = False
    finish: str = ""
    refusal: str = ""
    tool: str = ""
    response_id: str = ""


@dataclass
class Request:
    """One call: what to send and where to continue from."""

    messages: Sequence[Message]
    limits: CallLimits
    previous_response: str = ""
    conversation: str = ""
    ending: Ending = field(default_factory=Ending)


def build(place: Place) -> Any:
    """Make the library's model for that place. Touches no network; repeats no failed call by itself."""
    provider, name, address = place.provider, place.model, place.address
    key = place.secret.reveal() if place.secret else NO_KEY
    client = web_client(address)
    if provider.wire == "anthropic":
        from anthropic import AsyncAnthropic
        from pydantic_ai.models.anthropic import AnthropicModel
        from pydantic_ai.providers.anthropic import AnthropicProvider

        claude = AsyncAnthropic(api_key=key, base_url=address, http_client=client, max_retries=0)
        return AnthropicModel(name, provider=AnthropicProvider(anthropic_client=claude))
    if provider.wire == "google":
        from google.genai.types import HttpRetryOptions
        from pydantic_ai.models.google import GoogleModel
        from pydantic_ai.providers.google import GoogleProvider

        once = HttpRetryOptions(attempts=1)
        google = GoogleProvider(api_key=key, http_client=client, base_url=address, retry_options=once)
        return GoogleModel(name, provider=google)
    from openai import AsyncOpenAI
    from pydantic_ai.models.openai import OpenAIChatModel, OpenAIResponsesModel

    openai = AsyncOpenAI(api_key=key, base_url=address, http_client=client, max_retries=0)
    habits = _habits(provider, openai)
    if provider.wire == "openai-responses":
        return OpenAIResponsesModel(name, provider=habits)
    if provider.name == "openai":
        return OpenAIChatModel(name, provider=habits)
    # `max_tokens` is what all of them understand; the newer field of OpenAI's own is not.
    understood: Any = {"openai_chat_supports_max_completion_tokens": False}
    return OpenAIChatModel(name, provider=habits, profile=understood)


def _habits(provider: Provider, client: Any) -> Any:
    """Return the library's class for that provider; releases for Python 3.10 do not have all of them."""
    module, _, class_name = provider.library.partition(":")
    try:
        kind = getattr(importlib.import_module(f"pydantic_ai.providers.{module}"), class_name)
    except ModuleNotFoundError:
        from pydantic_ai.providers.openai import OpenAIProvider

        return OpenAIProvider(openai_client=client)
    if class_name == "OpenAICompatibleProvider":
        return kind(provider.name, openai_client=client)
    return kind(openai_client=client)


async def stream(model: Any, provider: Provider, request: Request) -> AsyncIterator[str]:
    """Yield the pieces of text of one call; `request.ending` is filled in when it ends.

    Raises:
        Exception: whatever the library raises; `failures.reason_of` sorts it.
    """
    ending = request.ending
    allow(request.limits)
    async with model_request_stream(
        model, _messages(request.messages), model_settings=_settings(provider, request)
    ) as got:
        try:
            async for event in got:
                if isinstance(event, PartStartEvent):
                    if isinstance(event.part, TextPart):
                        yield event.part.content
                    elif isinstance(event.part, ToolCallPart):
                        ending.tool = event.part.tool_name
                elif isinstance(event, PartDeltaEvent) and isinstance(event.delta, TextPartDelta):
                    yield event.delta.content_delta
        finally:
            ending.usage = _usage(got)
        details = got.provider_details or {}
        ending.finish = str(got.finish_reason or "")
        # The library takes a stream without a finish reason for whole; to us it has been cut off.
        ending.is_whole = bool(details.get("finish_reason")) or ending.finish == "content_filter"
        ending.refusal = str(details.get("refusal") or "")
        ending.response_id = str(got.provider_response_id or "")


def _settings(provider: Provider, request: Request) -> Any:
    settings: dict[str, Any] = {
        "max_tokens": request.limits.reply_tokens,
        "timeout": request.limits.total_s + SPARE_S,
        "thinking": False,
        **provider.settings,
    }
    if request.conversation:
        settings["openai_conversation_id"] = request.conversation
    elif request.previous_response:
        settings["openai_previous_response_id"] = request.previous_response
    return settings


def _messages(messages: Sequence[Message]) -> list[ModelMessage]:
    """Return ours in the library's form. What the system says goes first, as instructions: caches of prompts hit."""
    found: list[ModelMessage] = []
    for message in messages:
        if message.role == "assistant":
            found.append(ModelResponse(parts=[TextPart(content=message.text)]))
        elif message.role == "user":
            content: list[UserContent] = [message.text]
            if message.picture is not None:
                kind = "image/jpeg" if message.picture.startswith(b"\xff\xd8") else "image/png"
                content.append(BinaryContent(data=message.picture, media_type=kind))
            found.append(
                ModelRequest(parts=[UserPromptPart(content=content if len(content) > 1 else message.text)])
            )
    instructions = "\n\n".join(message.text for message in messages if message.role == "system")
    if instructions and found and isinstance(found[-1], ModelRequest):
        found[-1].instructions = instructions
    return found


def _usage(got: Any) -> Usage | None:
    """Return it as the provider counted it, or None."""
    used = got.usage() if callable(got.usage) else got.usage
    if not (used.input_tokens or used.output_tokens):
        return None
    return Usage(
        prompt_tokens=used.input_tokens, cached_tokens=used.cache_read_tokens, reply_tokens=used.output_tokens
    )
