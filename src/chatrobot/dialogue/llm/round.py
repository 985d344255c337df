"""One round of a turn that a model plans: one call, what the model said in it, and what became of the run of it."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

from chatrobot.core.events import Finished, Looked
from chatrobot.core.reason import Reason
from chatrobot.dialogue.llm.call import ModelCall
from chatrobot.dialogue.llm.reply_reader import ReplyReader
from chatrobot.dialogue.llm.terms import Surroundings
from chatrobot.models.seam import CallLimits, Message, Model
from chatrobot.plan.base import Step
from chatrobot.plan.primitives.no_motion import Say
from chatrobot.plan.steps import count_steps
from chatrobot.plan.text import format_step

if TYPE_CHECKING:
    from chatrobot.link.motion_link import MotionLink


class ModelRound:
    """Begins the call at once. Belongs to the pumping thread, but for the call's `cancel`.

    Args:
        done: the steps of earlier rounds that this one corrects, and that are not to be done again.
        wake: called when the model has said something.
    """

    def __init__(
        self,
        model: Model,
        messages: Sequence[Message],
        limits: CallLimits,
        wake: Callable[[], None],
        done: tuple[Step, ...],
    ) -> None:
        self._model = model
        self._done = done
        self.reader = ReplyReader()
        self.steps: list[Step] = []
        self.run: Finished | None = None
        self.run_problem: Reason | None = None
        """Why its run did not come to its end."""
        self.is_plan_refused = False
        self.call = ModelCall(model, messages, limits, wake)

    @property
    def is_in_vain(self) -> bool:
        """What the model says from now on counts no more: its run is over."""
        return self.run_problem is not None or self.is_plan_refused

    @property
    def moves(self) -> bool:
        """It is more than an answer."""
        return any(not isinstance(step, Say) for step in self.steps)

    @property
    def plan_text(self) -> str:
        return "\n".join(map(format_step, self.steps))

    @property
    def problem(self) -> Reason | None:
        """What is wrong with the reply."""
        if self.call.end is not None and self.call.end.problem is not None:
            return self.call.end.problem
        if self.reader.error is not None:
            return Reason("plan_text", {"problem": str(self.reader.error)})
        if not self.steps and not self.reader.looks and not self._done:
            return Reason("model_empty", {"model": self._model.name})
        return None

    def last_steps(self) -> list[Step]:
        """Return the steps that are complete only now that the model has said all."""
        return self.reader.finish() if self.call.end is not None and self.call.end.problem is None else []

    def end_run(self, finished: Finished) -> None:
        """Motion has told the end of its run."""
        self.run = finished
        if finished.outcome != "completed":
            self.run_problem = finished.reason or Reason("cause_unknown")

    def forget_what_is_done(self) -> None:
        """A correction that begins with all that is done already is the whole plan once more: that part is left out."""
        count = len(self._done)
        if count and not self.reader.names_rest and tuple(self.steps[:count]) == self._done:
            del self.steps[:count]

    def steps_done(self) -> tuple[Step, ...]:
        """The top-level steps that were done to their end."""
        left = self.run.steps_done if self.run is not None else 0
        done: list[Step] = []
        for step in self.steps:
            left -= count_steps((step,))
            if left < 0:
                break
            done.append(step)
        return tuple(done)


LOOK_S = 3.0
"""How long Motion may take to say what the lidar sees, and the camera to be found and to show something."""


class ObservationWait:
    """Begins at once. `hear` what Motion says, until it `is_over`.

    Args:
        looks: what the model wants to see.
    """

    def __init__(
        self, looks: tuple[str, ...], turn: int, link: MotionLink, surroundings: Surroundings
    ) -> None:
        self.scan: Looked | None = None
        self._surroundings = surroundings
        self._wants_scan, self._wants_picture = "scan" in looks, "camera" in looks
        self._until_s = time.monotonic() + LOOK_S
        if self._wants_scan:
            link.send("look", turn)
        if self._wants_picture:
            surroundings.begin_looking()

    def hear(self, scan: Looked) -> None:
        """What the lidar sees."""
        self.scan = scan

    @property
    def is_over(self) -> bool:
        """All has been seen, or nothing more is waited for."""
        if time.monotonic() > self._until_s:
            return True
        has_scan = self.scan is not None or not self._wants_scan
        return has_scan and (not self._wants_picture or self._surroundings.has_picture)
