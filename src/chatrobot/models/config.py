"""What making a model needs to know about this machine and person."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path


@dataclass(frozen=True)
class ModelConfig:
    """Where settings live and what the environment says.

    `folder` holds the choice of a model and the record of
    usage (None: neither is kept); keys are never in it. `session` tells sessions apart in the record.
    """

    folder: Path | None = None
    environ: Mapping[str, str] = field(default_factory=lambda: os.environ, repr=False)
    session: str = ""
    keyring: bool = True
    """False: keys come from the environment alone."""

    def variable(self, *names: str) -> str:
        """The first of these that is set and not empty, else ""."""
        return next((value for name in names if (value := self.environ.get(name, "").strip())), "")
