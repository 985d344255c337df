"""What is made of the texts that are known stays as it is, but for what the judge calls better.

A change that is meant is written down: `python -m tests.language.ledger` shows it, `--write` keeps it.
"""

from __future__ import annotations

from tests.language import ledger


def test_nothing_that_was_understood_is_understood_otherwise() -> None:
    worse, _ = ledger.changes()
    assert worse == []
