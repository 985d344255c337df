"""How a session behaves."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from chatrobot.dialogue.llm.requests import Interpreter
from chatrobot.language.interpretation import LanguageCode


@dataclass(frozen=True)
class Options:
    """How a session behaves.

    `while_moving` decides what a new instruction does to a running one: `queue` (pipes, programs) or `replace`
    (a person at the keyboard). `approve` asks for a yes before each plan, `approve_models` before what a model wrote,
    but for a few seconds of the tutorial's form; `rehearse_only` moves nothing. Of programs,
    `ask_findings` asks where rehearsal found something, `ask_new` before each that was written just now.
    `interpreter`: who understands; with `auto` a model is asked what is not understood without it.
    `answers_in_turn`: a yes counts in its turn, though it was said before its plan was shown.
    `language`: the one to speak before anything was said.
    """

    while_moving: Literal["queue", "replace"] = "queue"
    approve: bool = False
    approve_models: bool = False
    rehearse_only: bool = False
    ask_findings: bool = True
    ask_new: bool = False
    answers_in_turn: bool = False
    interpreter: Interpreter = "auto"
    language: LanguageCode = "en"
