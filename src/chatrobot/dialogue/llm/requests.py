"""Sends requests to a model and follows what becomes of them: local first, one conversation, several turns at
most at once.

Belongs to the pumping thread, but for `cancel`.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Literal

from chatrobot.core.events import Event, Finished, Looked, Notice
from chatrobot.core.geometry import Pose
from chatrobot.core.reason import Reason
from chatrobot.core.shown import one_line
from chatrobot.dialogue.llm import prompt
from chatrobot.dialogue.llm.camera import Camera
from chatrobot.dialogue.llm.prompt import connects_to_the_robot, is_form
from chatrobot.dialogue.llm.request import ModelRequest
from chatrobot.dialogue.llm.terms import Ended
from chatrobot.dialogue.observations import Exchange, History, measured, observation
from chatrobot.dialogue.understanding import Understanding
from chatrobot.language.interpretation import Interpretation
from chatrobot.language.phrases import say
from chatrobot.language.sight import asks_to_see
from chatrobot.models.seam import Message
from chatrobot.plan.base import Step

if TYPE_CHECKING:
    from chatrobot.link.motion_link import MotionLink

from chatrobot.dialogue.llm.setup import ModelSetup

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


class ModelRequests:
    """The turns of a conversation that a model plans.

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
        self._shown = _Shown(understanding, model_setup.camera if model_setup is not None else None)

    # --- from any thread ---

    def cancel(self, why: Reason) -> None:
        """A stop: end what models are being asked. Returns at once."""
        for turn in tuple(self._turns.values()):
            turn.doing.cancel(why)

    def cancel_unmoved(self, why: Reason) -> None:
        """A pause: end what has no plan with Motion, which would begin after it. Returns at once."""
        for turn in tuple(self._turns.values()):
            if not turn.doing.is_moving:
                turn.doing.cancel(why)

    @property
    def asked_at_s(self) -> float | None:
        """Since when a model is being asked (monotonic); None where none is."""
        asked = [turn.doing.asked_at_s for turn in tuple(self._turns.values())]
        return min((at_s for at_s in asked if at_s is not None), default=None)

    @property
    def has_model(self) -> bool:
        """A model may be asked."""
        return self._model_setup is not None

    def has(self, turn: int) -> bool:
        """A model plans that turn."""
        return turn in self._turns

    @property
    def is_moving(self) -> bool:
        """A plan of a model is with Motion."""
        return any(turn.doing.is_moving for turn in tuple(self._turns.values()))

    # --- the pumping thread ---

    @property
    def is_busy(self) -> bool:
        return bool(self._turns)

    @property
    def is_calling(self) -> bool:
        return self.asked_at_s is not None

    def may_be_overtaken(self, said_s: float) -> bool:
        """Whether what was said at `said_s` (monotonic) and needs no model goes before the model's turn.

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
        """Whether a model is to be asked: what is understood offline is not its business, nor what was refused."""
        if self._model_setup is None or meant.outcome in ("refused", "stop") or not text.strip():
            return False
        if self._interpreter == "model" or meant.outcome == "unclear":
            return True
        if meant.outcome == "answered" and self._shown.camera is not None and asks_to_see(text):
            return True  # the lidar answers such a question only as long as nobody has eyes
        return self._is_tutorial and meant.outcome == "plan" and not is_form(text)

    def without_model(self, text: str, meant: Interpretation) -> Interpretation:
        """What was not understood, the first time with how to set up a model; the tutorial's first instruction is
        answered."""
        if meant.outcome != "unclear" or meant.proposal is not None or self._model_setup is not None:
            return meant
        if connects_to_the_robot(text):
            return replace(meant, outcome="answered", reply=say(meant.language, "tutorial_without_model"))
        has_hinted = self._has_hinted or meant.code in ("nothing_to_undo", "nothing_undone")
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
            turn,
            messages,
            model_setup.model,
            model_setup.options,
            self._link,
            self._shown,
            self._emit,
            mode,
            pauses=self._pauses,
            approve=approve != "",
            frees_form=approve == "models" and self._is_tutorial,
            rehearse_only=rehearse_only,
            only_talks=connects,
        )
        self._turns[turn] = _Turn(text, request, doing, connects)

    def _messages(self, model_setup: ModelSetup, text: str) -> tuple[str, list[Message]]:
        earlier, news = self._history.messages()
        if self._is_tutorial:
            request, system = (
                text.strip()[: prompt.MAX_REQUEST_CHARS],
                prompt.tutorial_prompt(model_setup.profile),
            )
        else:
            understanding = self._understanding
            request = prompt.request(text, understanding.known_pose, [], understanding.usable_places)
            system = prompt.system_prompt(
                model_setup.profile, understanding.main_places, sees=self._shown.camera is not None
            )
            news = [line for line in news if line]
        now = request if self._is_tutorial else "\n".join([*news, request])
        return request, [Message("system", system), *earlier, Message("user", now)]

    def replace(self, but: int = 0) -> None:
        """Something else is to be done instead of what models are planning (but for the turn `but`)."""
        for number, turn in tuple(self._turns.items()):
            if number != but:
                turn.doing.replace()
        self._take_ended()

    def hear(self, event: Event) -> None:
        """An event of Motion's."""
        turn = self._turns.get(event.turn)
        if turn is not None:
            turn.doing.hear(event)
            self._take_ended()

    def pump(self) -> None:
        """Take in what models have said."""
        for turn in tuple(self._turns.values()):
            turn.doing.pump()
        self._take_ended()

    def wait(self, timeout_s: float) -> None:
        """Until a model says something. For simulated time, which stands meanwhile."""
        for turn in self._turns.values():
            if turn.doing.asked_at_s is not None:
                turn.doing.wait(timeout_s)
                return

    def note(self, text: str, plan_text: str, end: str) -> None:
        """A turn that no model was asked about: the next one is told."""
        if self._model_setup is not None:
            self._history.add(Exchange(text, plan_text, end))

    def _take_ended(self) -> None:
        for number, turn in tuple(self._turns.items()):
            ended = turn.doing.ended
            if ended is None:
                continue
            del self._turns[number]
            request = turn.request if ended.answer else ""
            self._history.add(Exchange(turn.text, ended.answer, _end(ended), request), pin=turn.pins)
            self._conclude(number, turn.text, ended)
        if not self._turns:
            self._shown.end_looking()


def _end(ended: Ended) -> str:
    """What became of a turn, for the model's memory of it."""
    why = f" ({ended.reason.code})" if ended.reason is not None else ""
    how = f": {measured(ended.finished)}" if ended.finished is not None else ""
    return f"{ended.outcome}{why}{how}"


class _Shown:
    """`Surroundings`, out of what Understanding knows."""

    def __init__(self, understanding: Understanding, camera: Camera | None) -> None:
        self._understanding = understanding
        self.camera = camera

    def describe(self, steps: tuple[Step, ...]) -> str:
        return self._understanding.describe(steps)

    def observation(
        self, looks: tuple[str, ...], looked: Looked | None, finished: Finished | None
    ) -> Message:
        places: dict[str, Pose] = {**self._understanding.main_places, **self._understanding.usable_places}
        pose = finished.pose if finished is not None else self._understanding.known_pose
        return observation(looks, pose=pose, places=places, looked=looked, finished=finished, take=self._take)

    def begin_looking(self) -> None:
        if self.camera is not None:
            self.camera.begin()

    @property
    def has_picture(self) -> bool:
        return self.camera is None or self.camera.has_picture

    def give_up_looking(self) -> None:
        self.end_looking()
        self.camera = None

    def end_looking(self) -> None:
        """No model is being asked any more."""
        if self.camera is not None:
            self.camera.end()

    def _take(self) -> bytes | None:
        return self.camera.take() if self.camera is not None else None

    def measured(self, finished: Finished | None) -> str:
        return measured(finished) if finished is not None else "nothing"
