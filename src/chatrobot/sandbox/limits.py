"""How much of the machine a program in the sandbox may use."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from typing import Any


@dataclass(frozen=True)
class SandboxLimits:
    """Limits of one program. What goes beyond ends it, or is refused inside it, and never harms its neighbours.

    Args:
        memory_bytes: address space beyond what the warm server had; more is a MemoryError inside.
        cpu_s: processor time, whole seconds; then it is killed. The default lasts hours for a program that waits.
        wall_s: time on the clock from launch to the end; None for no limit (a program that drives for an hour).
        threads: threads at once, its first included; more is a RuntimeError inside.
        log_bytes: what is kept of its output; the rest is counted and dropped.
        file_bytes: the largest file. It can open none, so this is a second wall.
        descriptors: open descriptors (pipes and socket pairs of its own).
    """

    memory_bytes: int = 256 << 20
    cpu_s: int = 600
    wall_s: float | None = None
    threads: int = 64
    log_bytes: int = 256 << 10
    file_bytes: int = 0
    descriptors: int = 64

    def to_json(self) -> dict[str, Any]:
        return asdict(self)

    @classmethod
    def from_json(cls, data: Mapping[str, Any]) -> SandboxLimits:
        return cls(**data)
