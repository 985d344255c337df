"""Finds the model that is meant: `--model`, else CHATROBOT_MODEL, else what `chatrobot model use` stored, else none."""

from __future__ import annotations

import os
import sys
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Literal

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

from chatrobot.core.errors import InputError
from chatrobot.core.files import write_whole

FILE = "model.toml"
VARIABLE = "CHATROBOT_MODEL"
Source = Literal["option", "environment", "stored"]


@dataclass(frozen=True)
class ModelConfig:
    """Settings' folder, and what the environment says.

    `folder` holds the choice of a model and the record of usage (None: neither is kept); keys are never in it.
    `session` tells sessions apart in the record. Without `keyring` keys come from the environment alone.
    """

    folder: Path | None = None
    environ: Mapping[str, str] = field(default_factory=lambda: os.environ, repr=False)
    session: str = ""
    keyring: bool = True

    def variable(self, *names: str) -> str:
        """Return the first of these that is set and not empty, else ""."""
        return next((value for name in names if (value := self.environ.get(name, "").strip())), "")


@dataclass(frozen=True)
class Choice:
    """Model by name (`PROVIDER:NAME`) and who chose it."""

    name: str
    source: Source


def resolve(option: str, config: ModelConfig) -> Choice | None:
    """Return the model to use, or None where none is set up. `option` is what `--model` said, "" for nothing.

    Raises:
        InputError: the stored choice cannot be read.
    """
    if option.strip():
        return Choice(option.strip(), "option")
    if name := config.variable(VARIABLE):
        return Choice(name, "environment")
    stored = _stored(config)
    return Choice(stored, "stored") if stored else None


def _stored(config: ModelConfig) -> str:
    if config.folder is None:
        return ""
    path = config.folder / FILE
    try:
        return str(tomllib.loads(path.read_text(encoding="utf-8-sig")).get("model", ""))
    except FileNotFoundError:
        return ""
    except (OSError, ValueError) as error:
        problem = getattr(error, "strerror", None) or str(error)
        raise InputError(problem, where=str(path), allowed='model = "PROVIDER:NAME"') from None


def store_choice(name: str, folder: Path) -> Path:
    """Keep it for later sessions ("" keeps that there is none), and return the file.

    Raises:
        OSError: the folder cannot be written.
    """
    path = folder / FILE
    quoted = name.replace("\\", "\\\\").replace('"', '\\"')
    text = f'# The language model of new sessions. Keys are never kept here.\nmodel = "{quoted}"\n'
    write_whole(path, text)
    return path
