"""Lists every provider, one row each. Adding one touches this table, or, from outside, `register` or an entry point.

An installed package adds providers by the entry point group `chatrobot.models`: each entry names a `Provider`.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import cache
from typing import TYPE_CHECKING, Any, Literal

from chatrobot.core.reason import Reason
from chatrobot.models.config import ModelConfig
from chatrobot.models.seam import Model, ModelError
from chatrobot.models.secret import scrub

if TYPE_CHECKING:
    from collections.abc import Iterable

Wire = Literal["openai", "openai-responses", "anthropic", "google"]
ENTRY_POINTS = "chatrobot.models"


@dataclass(frozen=True)
class Provider:
    """One provider.

    `wire` is the protocol it speaks; `library` the class of the model library that knows its habits. The first of
    `key_variables` is the one that people are told of. `make` replaces all of it: a model of one's own.
    """

    name: str
    title: str
    wire: Wire = "openai"
    library: str = "openai_compatible:OpenAICompatibleProvider"
    key_variables: tuple[str, ...] = ()
    needs_key: bool = True
    key_page: str = ""
    base_url: str = ""
    base_url_variables: tuple[str, ...] = ()
    example: str = "NAME"
    settings: Mapping[str, Any] = field(default_factory=dict)
    make: Callable[[str, ModelConfig], Model] | None = None

    def address(self, config: ModelConfig) -> str:
        """Return its base URL: the person's, or the usual one; "" where the library knows it."""
        given = config.variable(*self.base_url_variables)
        if self.name == "ollama" and given:
            return ollama_address(given)
        return given or self.base_url


_OLLAMA: dict[str, Any] = {"temperature": 0.0, "extra_body": {"reasoning_effort": "none"}}
"""Small local models keep to the form of a plan best when nothing is left to chance, and some think for minutes."""
_TEMPLATED: dict[str, Any] = {
    "temperature": 0.0,
    "extra_body": {"chat_template_kwargs": {"enable_thinking": False}},
}
"""The same where the model's own template decides; one that knows no such word takes no notice."""

_BUILT_IN = (
    Provider(
        "openai", "OpenAI", "openai", "openai:OpenAIProvider", ("OPENAI_API_KEY",),
        key_page="https://platform.openai.com/api-keys", base_url="https://api.openai.com/v1",
        base_url_variables=("OPENAI_BASE_URL",), example="gpt-5-mini",
    ),
    Provider(
        "openai-responses", "OpenAI Responses, the conversation held by the server", "openai-responses",
        "openai:OpenAIProvider", ("OPENAI_API_KEY",), key_page="https://platform.openai.com/api-keys",
        base_url="https://api.openai.com/v1", base_url_variables=("OPENAI_BASE_URL",), example="gpt-5-mini",
    ),
    Provider(
        "anthropic", "Anthropic", "anthropic", "anthropic:AnthropicProvider", ("ANTHROPIC_API_KEY",),
        key_page="https://platform.claude.com/settings/keys", base_url="https://api.anthropic.com",
        base_url_variables=("ANTHROPIC_BASE_URL",), example="claude-haiku-4-5",
    ),
    Provider(
        "google", "Google Gemini", "google", "google:GoogleProvider", ("GOOGLE_API_KEY", "GEMINI_API_KEY"),
        key_page="https://aistudio.google.com/apikey", base_url="https://generativelanguage.googleapis.com",
        base_url_variables=("GOOGLE_GEMINI_BASE_URL",), example="gemini-2.5-flash",
    ),
    Provider(
        "ollama", "Ollama on this machine", library="ollama:OllamaProvider", key_variables=("OLLAMA_API_KEY",),
        needs_key=False, base_url="http://127.0.0.1:11434/v1", base_url_variables=("OLLAMA_BASE_URL", "OLLAMA_HOST"),
        example="qwen3:4b-instruct", settings=_OLLAMA,
    ),
    Provider(
        "llamacpp", "llama.cpp on this machine", key_variables=("LLAMACPP_API_KEY", "LLAMA_API_KEY"), needs_key=False,
        base_url="http://127.0.0.1:8080/v1", base_url_variables=("LLAMACPP_BASE_URL",), example="default",
        settings=_TEMPLATED,
    ),
    Provider(
        "vllm", "vLLM", key_variables=("VLLM_API_KEY",), needs_key=False, base_url="http://127.0.0.1:8000/v1",
        base_url_variables=("VLLM_BASE_URL",), example="Qwen/Qwen3-8B", settings=_TEMPLATED,
    ),
    Provider(
        "lmstudio", "LM Studio on this machine", key_variables=("LMSTUDIO_API_KEY",), needs_key=False,
        base_url="http://127.0.0.1:1234/v1", base_url_variables=("LMSTUDIO_BASE_URL",), example="NAME",
        settings=_TEMPLATED,
    ),
    Provider(
        "deepseek", "DeepSeek", library="deepseek:DeepSeekProvider", key_variables=("DEEPSEEK_API_KEY",),
        key_page="https://platform.deepseek.com/api_keys", base_url="https://api.deepseek.com",
        base_url_variables=("DEEPSEEK_BASE_URL",), example="deepseek-chat",
    ),
    Provider(
        "qwen", "Qwen (Alibaba Cloud, DashScope)", library="alibaba:AlibabaProvider",
        key_variables=("DASHSCOPE_API_KEY", "ALIBABA_API_KEY"),
        key_page="https://bailian.console.aliyun.com/?tab=model#/api-key",
        base_url="https://dashscope.aliyuncs.com/compatible-mode/v1", base_url_variables=("DASHSCOPE_BASE_URL",),
        example="qwen-plus",
    ),
    Provider(
        "openrouter", "OpenRouter", library="openrouter:OpenRouterProvider", key_variables=("OPENROUTER_API_KEY",),
        key_page="https://openrouter.ai/keys", base_url="https://openrouter.ai/api/v1",
        base_url_variables=("OPENROUTER_BASE_URL",), example="qwen/qwen3-30b-a3b",
    ),
    Provider(
        "openai-compatible", "anything that speaks OpenAI's protocol, at OPENAI_BASE_URL",
        key_variables=("OPENAI_API_KEY",), needs_key=False, base_url_variables=("OPENAI_BASE_URL",), example="NAME",
    ),
)  # fmt: skip

LOCAL = ("ollama", "llamacpp", "vllm", "lmstudio")
"""Those that usually run on one's own machine."""
_registered: dict[str, Provider] = {}


def register(provider: Provider) -> None:
    """Add a provider, or put another in the place of one of ours."""
    _registered[provider.name] = provider


def providers() -> dict[str, Provider]:
    """Return all of them by name: ours, those of installed packages, those registered."""
    return {
        **{provider.name: provider for provider in _BUILT_IN},
        **{provider.name: provider for provider in _installed()},
        **_registered,
    }


@cache
def _installed() -> tuple[Provider, ...]:
    from importlib.metadata import entry_points

    loaded: Iterable[Any] = (entry.load() for entry in entry_points(group=ENTRY_POINTS))
    return tuple(provider for provider in loaded if isinstance(provider, Provider))


def split_name(text: str) -> tuple[Provider, str]:
    """Take `PROVIDER:NAME` apart.

    Raises:
        ModelError: `model_unknown`, naming the providers there are.
    """
    provider_name, colon, name = text.strip().partition(":")
    provider = providers().get(provider_name.strip().lower())
    if provider is None or not colon or not name.strip():
        raise ModelError(
            Reason("model_unknown", {"model": scrub(text, None), "providers": ", ".join(providers())})
        )
    return provider, name.strip()


def ollama_address(host: str) -> str:
    """Return the base URL of an OLLAMA_HOST as its own tools read it: `host`, `host:port`, a URL, 0.0.0.0 for here."""
    scheme, _, rest = host.rpartition("://")
    place, slash, path = rest.partition("/")
    name, colon, port = place.rpartition(":")
    if not colon or not port.isdigit():
        name, port = place, "443" if scheme == "https" else "80" if scheme == "http" else "11434"
    if name in ("", "0.0.0.0", "[::]"):
        name = "127.0.0.1"
    path = f"/{path.rstrip('/')}" if slash and path.strip("/") else ""
    return f"{scheme or 'http'}://{name}:{port}{path}" + ("" if path.endswith("/v1") else "/v1")
