"""Sends requests to a model and follows what becomes of them: local first, one conversation, several turns at once.

Belongs to the pumping thread, but for `cancel`.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Literal

from chatrobot.core.events import Event, Notice
from chatrobot.core.reason import Reason, one_line
from chatrobot.dialogue.llm import prompt
from chatrobot.dialogue.llm.looking import Surroundings
from chatrobot.dialogue.llm.prompt import connects_to_the_robot, is_form
from chatrobot.dialogue.llm.request import ModelRequest
from chatrobot.dialogue.llm.setup import ModelSetup
from chatrobot.dialogue.llm.terms import Ended
from chatrobot.dialogue.observations import Exchange, History, measured
from chatrobot.dialogue.understanding import Understanding
from chatrobot.language.interpretation import Interpretation
from chatrobot.language.phrases import say
from chatrobot.language.sight import asks_to_see
from chatrobot.models.seam import Message

if TYPE_CHECKING:
    from chatrobot.dialogue.programs.requests import ProgramRequests
    from chatrobot.link.motion_link import MotionLink

Interpreter = Literal["auto", "offline", "model"]
Approve = Literal["", "models", "all"]
"""What needs a person's yes: nothing, what a model wrote, or each plan."""

TOGETHER_S = 0.25
"""What is said within this time of the question before belongs to it: a pipe's lines keep their order."""

PATIENCE_S = 2.0
"""So long such a line waits for a model that says nothing; then it is done before the model's turn."""


@dataclass
class _Turn:
    text: str
    request: str
    doing: ModelRequest
    pins: bool


NO_MODEL_HELPS = frozenset(
    {
        "nothing_to_undo", "nothing_undone", "empty", "place_unusable",
        "where_to", "only_in_the_way", "nothing_to_answer",
    }
)  # fmt: skip
"""Codes of what is not done for a reason that no model knows more of."""


class ModelRequests:
    """Turns of a conversation that a model plans.

    Args:
        model_setup: None where no model is set up.
        conclude: hears how each turn ended.
        pauses: how many there were by now.
    """

    def __init__(
        self,
        model_setup: ModelSetup | None,
        interpreter: Interpreter,
        link: MotionLink,
        understanding: Understanding,
        emit: Callable[[Event], None],
        conclude: Callable[[int, str, Ended], None],
        pauses: Callable[[], int],
    ) -> None:
        self._pauses = pauses
        self._model_setup = model_setup if interpreter != "offline" else None
        self._has_hinted = False
        self._interpreter = interpreter
        self._link = link
        self._understanding = understanding
        self._emit = emit
        self._conclude = conclude
        self._history = History()
        self._turns: dict[int, _Turn] = {}
        self._is_tutorial = False
        self.writer: ProgramRequests | None = None
        """Asks the model for programs; it is pumped, waited for and cancelled with the rest."""
        self._surroundings = Surroundings(
            understanding, model_setup.camera if model_setup is not None else None
        )

    # --- from any thread ---

    def cancel(self, why: Reason) -> None:
        """End what models are being asked, for a stop. Returns at once."""
        for turn in tuple(self._turns.values()):
            turn.doing.cancel(why)
        self._cancel_writing()

    def cancel_unmoved(self, why: Reason) -> None:
        """End what has no plan with Motion, for a pause: it would begin after it. Returns at once."""
        for turn in tuple(self._turns.values()):
            if not turn.doing.is_moving:
                turn.doing.cancel(why)
        self._cancel_writing()

    def _cancel_writing(self) -> None:
        if self.writer is not None:
            self.writer.cancel()

    @property
    def asked_at_s(self) -> float | None:
        """Return since when a model is being asked (monotonic); None where none is."""
        asked = [turn.doing.asked_at_s for turn in tuple(self._turns.values())]
        asked += [self.writer.asked_at_s] if self.writer is not None else []
        return min((at_s for at_s in asked if at_s is not None), default=None)

    @property
    def has_model(self) -> bool:
        """True where a model may be asked."""
        return self._model_setup is not None

    def has(self, turn: int) -> bool:
        """Tell whether a model plans that turn."""
        return turn in self._turns

    @property
    def is_moving(self) -> bool:
        """True while a plan of a model is with Motion."""
        return any(turn.doing.is_moving for turn in tuple(self._turns.values()))

    # --- the pumping thread ---

    @property
    def is_busy(self) -> bool:
        """True while a model plans a turn, or its plan is driven."""
        return bool(self._turns)

    @property
    def is_writing(self) -> bool:
        """True while a model writes a program: what is said then, but for a stop or a pause, waits."""
        return self.writer is not None and self.writer.is_writing

    @property
    def is_calling(self) -> bool:
        """True while a model is being asked."""
        return self.asked_at_s is not None

    def may_be_overtaken(self, said_s: float) -> bool:
        """Tell whether what was said at `said_s` (monotonic) and needs no model goes before the model's turn.

        A hung model holds nobody up; and yet what came in one go stays in its order.
        """
        for turn in self._turns.values():
            silent_s = turn.doing.silent_s
            if turn.doing.is_moving or silent_s is None:
                return False
            if said_s < turn.doing.began_s + TOGETHER_S and silent_s < PATIENCE_S:
                return False
        return True

    def wants(self, text: str, meant: Interpretation) -> bool:
        """Tell whether a model is to be asked: what is understood offline is not its business, nor what was refused."""
        if self._model_setup is None or meant.outcome in ("refused", "stop") or not text.strip():
            return False
        if self._interpreter == "model" or (meant.outcome == "unclear" and not meant.is_held):
            return True
        if meant.outcome == "answered" and self._surroundings.camera is not None and asks_to_see(text):
            return True  # the lidar answers such a question only as long as nobody has eyes
        return self._is_tutorial and meant.outcome == "plan" and not is_form(text)

    def without_model(self, text: str, meant: Interpretation) -> Interpretation:
        """Return what was not understood, the first time with how to set up a model; the tutorial's first instruction
        is answered."""
        if meant.outcome != "unclear" or meant.proposal is not None or self._model_setup is not None:
            return meant
        if connects_to_the_robot(text):
            return replace(meant, outcome="answered", reply=say(meant.language, "tutorial_without_model"))
        has_hinted = self._has_hinted or meant.code in NO_MODEL_HELPS
        if self._interpreter == "offline" or has_hinted:
            return meant
        self._has_hinted = True
        return replace(meant, reply=f"{meant.reply} {say(meant.language, 'no_model_hint')}")

    def begin(
        self,
        turn: int,
        text: str,
        meant: Interpretation,
        mode: Literal["queue", "replace", "append"],
        *,
        approve: Approve,
        rehearse_only: bool,
    ) -> None:
        """Ask the model about `text`, which offline was understood as `meant`."""
        model_setup = self._model_setup
        assert model_setup is not None
        connects = connects_to_the_robot(text)
        if connects:
            self._is_tutorial, self._history = True, History()
            model_setup.model.forget()
        elif self._interpreter == "auto" and not self._is_tutorial:
            part = one_line(meant.unaccounted or text, 80)
            why = self._understanding.say("asks_model", text, model=model_setup.model.name, part=part)
            reason = Reason("asks_model", {"model": model_setup.model.name, "part": part, "why": meant.code})
            self._emit(Notice(turn, reason, why))
        request, messages = self._messages(model_setup, text)
        doing = ModelRequest(
            turn, messages, model_setup.model, model_setup.options, self._link, self._surroundings, self._emit, mode,
            pauses=self._pauses, approve=approve != "", frees_form=approve == "models" and self._is_tutorial,
            rehearse_only=rehearse_only, only_talks=connects,
        )  # fmt: skip
        self._turns[turn] = _Turn(text, request, doing, connects)

    def _messages(self, model_setup: ModelSetup, text: str) -> tuple[str, list[Message]]:
        """Return what the person says as the model is told it, and all that the model is told."""
        earlier, news = self._history.messages()
        if self._is_tutorial:
            request, news = text.strip()[: prompt.MAX_REQUEST_CHARS], []
            system = prompt.tutorial_prompt(model_setup.profile)
        else:
            known, sees = self._understanding, self._surroundings.camera is not None
            request = prompt.request(text, known.known_pose, known.usable_places)
            system = prompt.system_prompt(model_setup.profile, known.main_places, sees=sees)
        now = "\n".join([*filter(None, news), request])
        return request, [Message("system", system), *earlier, Message("user", now)]

    def replace(self) -> None:
        """Give up what models are planning for something else."""
        for turn in tuple(self._turns.values()):
            turn.doing.replace()
        self._take_ended()

    def hear(self, event: Event) -> None:
        """Take in an event of Motion's."""
        turn = self._turns.get(event.turn)
        if turn is not None:
            turn.doing.hear(event)
            self._take_ended()

    def pump(self) -> None:
        """Take in what models have said."""
        for turn in tuple(self._turns.values()):
            turn.doing.pump()
        self._take_ended()
        if self.writer is not None:
            self.writer.pump()

    def wait(self, timeout_s: float) -> None:
        """Wait until a model says something. For simulated time, which stands meanwhile."""
        doing = (self.writer, *(turn.doing for turn in self._turns.values()))
        calling = next((one for one in doing if one is not None and one.asked_at_s is not None), None)
        if calling is not None:
            calling.wait(timeout_s)

    def note(self, text: str, plan_text: str, end: str) -> None:
        """Note a turn that no model was asked about: the next one is told."""
        if self._model_setup is not None:
            self._history.add(Exchange(text, plan_text, end))

    def _take_ended(self) -> None:
        was_busy = self.is_busy
        for number, turn in tuple(self._turns.items()):
            ended = turn.doing.ended
            if ended is None:
                continue
            del self._turns[number]
            request = turn.request if ended.answer else ""
            self._history.add(Exchange(turn.text, ended.answer, _end(ended), request), pin=turn.pins)
            self._conclude(number, turn.text, ended)
        if was_busy and not self.is_busy:
            self._surroundings.end_looking()


def _end(ended: Ended) -> str:
    """Return what became of a turn, for the model's memory of it."""
    why = f" ({ended.reason.code})" if ended.reason is not None else ""
    how = f": {measured(ended.finished)}" if ended.finished is not None else ""
    return f"{ended.outcome}{why}{how}"
