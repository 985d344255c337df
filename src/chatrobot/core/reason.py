"""Why something was refused, limited or ended: a code with numbers, put into words only at the very end.

Motion and the governor know no language. They say `Reason("obstacle_ahead", {"distance_m": 0.4})`; the phrase
tables of `language` turn that into a sentence in the language of the question.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

Value = float | int | str


@dataclass(frozen=True)
class Reason:
    """A machine-readable reason. `code` is snake_case, `values` carry units in their names."""

    code: str
    values: Mapping[str, Value] = field(default_factory=dict)

    def __post_init__(self) -> None:
        if "code" in self.values:
            raise ValueError(
                f"a value of {self.code!r} is named 'code': it would hide the reason's own in JSON"
            )

    def to_json(self) -> dict[str, Any]:
        return {"code": self.code, **self.values}

    @classmethod
    def from_json(cls, data: Mapping[str, Any]) -> Reason:
        values = {key: value for key, value in data.items() if key != "code"}
        return cls(str(data["code"]), values)
