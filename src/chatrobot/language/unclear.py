"""How a rule says that it does not understand: with the part of the sentence, and why."""

from __future__ import annotations


class Unclear(Exception):  # noqa: N818 - not an error: the interpreter turns it into a question
    """Raised inside `language` only; `interpret` always turns it into an `unclear` or `refused` answer.

    `is_final`: other breaks between its clauses do not make the text any clearer.
    """

    def __init__(self, code: str, part: str = "", *, refused: bool = False, is_final: bool = False) -> None:
        self.code = code
        self.part = part
        self.refused = refused
        self.is_final = is_final
        super().__init__(f"{code}: {part}")
