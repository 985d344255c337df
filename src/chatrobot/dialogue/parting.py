"""A person who says goodbye, and nothing else, leaves: how the displays of a session know."""

from __future__ import annotations

from chatrobot.core.events import Event, Result
from chatrobot.core.reason import Reason
from chatrobot.language.interpretation import Interpretation

PARTING = "parting"
"""The code of such an interpretation, and of the reason in its result."""


def parting(meant: Interpretation) -> Reason | None:
    """The reason of a result that ends the conversation; None for any other."""
    return Reason(PARTING) if meant.code == PARTING else None


def is_parting(event: Event) -> bool:
    """The person has said goodbye, and has been answered."""
    return isinstance(event, Result) and event.reason is not None and event.reason.code == PARTING
