"""The console's own words, in the language of the last question: `language/data/<code>/console.toml`."""

from __future__ import annotations

import math
import os
from collections.abc import Mapping

from chatrobot.core.geometry import Pose, wrap_angle
from chatrobot.core.reason import fixed
from chatrobot.language.data_files import filled, load_table
from chatrobot.language.interpretation import LanguageCode, language_of_tags

_TABLE = "console"


class Words:
    """Says things. `follow` sets it to that of a question."""

    def __init__(self, language: LanguageCode = "en") -> None:
        self.language: LanguageCode = language

    def follow(self, text: str) -> None:
        """Speak the language of `text` from now on; plan text, or one without letters, changes nothing."""
        from chatrobot.cli.console.pasted import is_plan  # late: the list of words needs no plans

        if any(char.isalpha() for char in text) and not is_plan(text):
            from chatrobot.language.detect import language_of  # the words are not needed to begin

            self.language = language_of(text, self.language)

    def say(self, code: str, **values: object) -> str:
        """Return the words of that code."""
        return filled(str(load_table(self.language, _TABLE)[code]), self.language, values)

    def pose(self, pose: Pose) -> str:
        """Write a pose as `(1.00, -0.50) 90°`: metres and heading in the odom frame."""
        heading_deg = round(math.degrees(wrap_angle(pose.yaw_rad)))
        heading_deg = 180 if heading_deg == -180 else heading_deg
        return f"({fixed(pose.x_m, 2)}, {fixed(pose.y_m, 2)}) {heading_deg}°"


def language_of_environment(environment: Mapping[str, str] = os.environ) -> LanguageCode:
    """Return the language of the person's system, as POSIX orders the variables."""
    value = next(
        (environment[name] for name in ("LC_ALL", "LC_MESSAGES", "LANG") if environment.get(name)), ""
    )
    return language_of_tags(value)
