"""Makes the model that a person chose."""

from __future__ import annotations

import time
from dataclasses import dataclass
from pathlib import Path

from chatrobot.dialogue.llm.camera import Camera
from chatrobot.dialogue.llm.terms import ModelOptions
from chatrobot.language.interpretation import LanguageCode
from chatrobot.language.phrases import say
from chatrobot.models.seam import Model
from chatrobot.robots.profile import RobotProfile

SERVER_HELD = {"openai": "openai-responses", "openai-compatible": "openai-responses"}
"""Providers whose protocol also knows a conversation that the server holds."""


def chosen_model(option: str, folder: Path | None, *, server_held: bool = False) -> Model | None:
    """Return the model of `--model`, of CHATROBOT_MODEL or of the settings in `folder`; None where none is set up.

    Args:
        server_held: the conversation is to live at the server (`revChatGPT:=True`), where the provider can do that.

    Raises:
        ModelError: `model_unknown`.
        InputError: the stored choice cannot be read.
    """
    from chatrobot.models.config import ModelConfig, resolve

    config = ModelConfig(folder, session=time.strftime("%Y-%m-%d %H:%M:%S"))
    choice = resolve(option, config)
    if choice is None or choice.name == "none":
        return None
    from chatrobot.models.make import make_model  # with asyncio, which nothing else here needs

    provider, colon, name = choice.name.partition(":")
    provider = SERVER_HELD.get(provider, provider) if server_held else provider
    return make_model(f"{provider}{colon}{name}", config)


def warm_up(model: Model | None) -> None:
    """Load what it needs in the background, while a person still types."""
    if model is not None:
        from chatrobot.models.make import warm

        warm(model)


@dataclass(frozen=True)
class ModelSetup:
    """Model and how it is used. `camera` takes pictures for it; None where there is none, or it cannot see."""

    model: Model
    options: ModelOptions
    profile: RobotProfile
    camera: Camera | None = None


def explain_server_held(model: Model | None, language: LanguageCode) -> str:
    """Say what has become of the tutorial's parameter revChatGPT."""
    if model is None:
        return say(language, "revchatgpt_no_model")
    return say(language, "revchatgpt_gone", model=model.name)
