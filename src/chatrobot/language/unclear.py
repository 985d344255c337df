"""How a rule says that it does not understand: with the part of the sentence, and why."""

from __future__ import annotations

OF_AN_ORDER = frozenset(
    {
        "which_side",
        "which_way",
        "which_size",
        "which_place",
        "how_far",
        "how_long",
        "no_unit",
        "unclear_motion",
    }
)
"""What is asked back about an order, and never about a remark: `nice turn` leaves no question open."""


STUMBLED = frozenset({"unknown_part", "unclear_motion", "nothing_to_do"})
"""Why a text was not read, where it may have talk in it that no mark sets off."""


class Unclear(Exception):  # noqa: N818 - not an error: the interpreter turns it into a question
    """Raised inside `language` only; `interpret` always turns it into an `unclear` or `refused` answer.

    `is_final`: other breaks between its clauses do not make the text any clearer. `open_text`: the text answers
    another question than was asked; this is what the question stays open of.
    """

    def __init__(
        self, code: str, part: str = "", *, refused: bool = False, is_final: bool = False, open_text: str = ""
    ) -> None:
        self.code = code
        self.part = part
        self.refused = refused
        self.is_final = is_final
        self.open_text = open_text
        super().__init__(f"{code}: {part}")
