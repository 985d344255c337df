"""What a screen does for the chat controller."""

from __future__ import annotations

from typing import Protocol

from rich.console import RenderableType


class Display(Protocol):
    """A screen. All of it may be called from any thread."""

    @property
    def echoes(self) -> bool:
        """What was typed stays to be seen without our help."""
        ...

    @property
    def width(self) -> int:
        """Columns."""
        ...

    def print(self, *lines: RenderableType) -> None: ...

    def refresh(self) -> None:
        """Something that the status bar shows has changed."""
        ...

    def edit(self, plan_text: str) -> None:
        """Let the person change a plan; it comes back through `ChatController.take_edited`."""
        ...

    def leave(self, code: int) -> None:
        """End the conversation; `code` is the exit code."""
        ...
