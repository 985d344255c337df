"""Which walls the sandbox has on this machine, found out by building it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal

from chatrobot.core.errors import SandboxError
from chatrobot.core.reason import Reason
from chatrobot.sandbox.layers import Layers
from chatrobot.sandbox.warm_server import WarmServer

Level = Literal["none", "minimum", "good", "full"]


@dataclass(frozen=True)
class SandboxReport:
    """What stands here.

    Args:
        problems: for each layer that was tried why it does not stand, or "" where it does.
        refusal: why no program runs here at all, or None.
    """

    problems: Mapping[str, str]
    refusal: Reason | None

    @property
    def standing(self) -> tuple[str, ...]:
        return tuple(layer for layer, problem in self.problems.items() if not problem)

    @property
    def level(self) -> Level:
        """minimum: filter, limits and a clean environment; good: Landlock or namespaces too; full: both."""
        if self.refusal is not None:
            return "none"
        levels: tuple[Level, ...] = ("minimum", "good", "full")
        has_world = "namespaces" in self.standing or "bubblewrap" in self.standing
        return levels[("landlock" in self.standing) + has_world]


def probe(layers: Layers | None = None) -> SandboxReport:
    """Start a warm server without any modules, see what stands, and end it again (0.1 s)."""
    refusal = None
    with WarmServer(layers=layers, has_library=False) as server:
        try:
            server.start()
        except SandboxError as error:
            refusal = error.reason
        return SandboxReport(server.problems, refusal)
