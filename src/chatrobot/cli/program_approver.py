"""Yes, no, or edit: who answers for a program that has been rehearsed."""

from __future__ import annotations

from chatrobot.cli.approver import Approver
from chatrobot.cli.editor import edited_text
from chatrobot.core.events import Event, ProgramWritten
from chatrobot.language.consent import wants_to_edit
from chatrobot.session.session import Session


class ProgramApprover(Approver):
    """An `Approver` that also takes `e`: the plan is declined, and what the editor leaves waits in `edited`."""

    prompt = "Do it? [y/N/e(dit)] "

    def __init__(self, *, can_ask: bool) -> None:
        super().__init__(can_ask=can_ask)
        self._shown: ProgramWritten | None = None
        self._edited: tuple[str, str] | None = None

    def edited(self) -> tuple[str, str] | None:
        """Name and source of the program as it was edited, once; None where it was not."""
        found, self._edited = self._edited, None
        return found

    def hear(self, event: Event) -> None:
        if isinstance(event, ProgramWritten):
            self._shown = event
        super().hear(event)

    def take(self, session: Session, answer: str) -> None:
        if wants_to_edit(answer) and self._shown is not None:
            with self.editing:
                self._edited = (self._shown.program, edited_text(self._shown.source, ".py"))
        super().take(session, answer)
