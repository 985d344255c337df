"""The contract of a primitive: its step, its line of plan text, its way down to the core, and one line of help.

To add one, put a module beside those in `plan/primitives` (or, in a package of your own, name it in the entry-point
group `chatrobot.primitives`) with a `PRIMITIVE`. Nothing else changes: text, JSON, schema, rehearsal and execution
find it through `plan.registry`.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable
from typing import ClassVar, Generic, TypeVar, Union

from chatrobot.core.geometry import Pose
from chatrobot.plan.base import Block, Step
from chatrobot.plan.context import Lowered, LoweringContext
from chatrobot.plan.reader import LineReader

StepT = TypeVar("StepT", bound=Step)
BlockT = TypeVar("BlockT", bound=Block)
HeaderT = TypeVar("HeaderT")

StepParts = tuple[Union[Step, None], Union[Step, None]]
"""The part of a step that was done and the part that is left; None for a part that is nothing."""


def step_parts(extents: tuple[float, float], make: Callable[[float], Step]) -> StepParts:
    """The two parts of a step that `make` makes of an extent."""
    done, rest = extents
    return make(done) if done else None, make(rest) if rest else None


class PrimitiveInfo:
    """What every primitive, simple or block, tells about itself.

    `kind` is its name in JSON, `verb` the first word of its line, `step_type` its dataclass, `usage` its grammar
    on one line, `help` what it does in one line, `examples` whole texts that parse. `needs_pose`: it means something
    only where the robot's place is known.
    """

    kind: ClassVar[str]
    verb: ClassVar[str]
    usage: ClassVar[str]
    help: ClassVar[str]
    examples: ClassVar[tuple[str, ...]]
    step_type: ClassVar[type[Step]]
    needs_pose: ClassVar[bool] = False


class Primitive(PrimitiveInfo, ABC, Generic[StepT]):
    """A step of one line."""

    @abstractmethod
    def parse(self, line: LineReader) -> StepT:
        """Read what follows the verb, to the end of the line. Raises PlanTextError (through `line`)."""

    @abstractmethod
    def format(self, step: StepT) -> str:
        """The one canonical line, verb included, that parses to an equal step."""

    @abstractmethod
    def lower(self, step: StepT, context: LoweringContext) -> Lowered:
        """The core motions that do it from `context.pose`, or why it is impossible."""

    def divide(self, step: StepT, share: float, context: LoweringContext) -> StepParts:  # noqa: ARG002
        """Divide `step` where it was left off. Both None: `plan.split` divides its core motions instead.

        Args:
            share: how much of its core motion was driven, 0 to 1, for a step that lowers to one.
            context: `pose` is where the robot stands now.
        """
        return None, None

    def resolve(self, step: StepT, plan_start: Pose) -> StepT:  # noqa: ARG002
        """The same step without the frame `start`, for a plan that begins elsewhere."""
        return step


class BlockPrimitive(PrimitiveInfo, ABC, Generic[BlockT, HeaderT]):
    """A step that holds others, up to its `end`."""

    @abstractmethod
    def parse_header(self, line: LineReader) -> HeaderT:
        """Read what follows the verb on the opening line."""

    @abstractmethod
    def close(self, header: HeaderT, steps: tuple[Step, ...]) -> BlockT:
        """The whole step, once its `end` was read. Raises ValueError."""

    @abstractmethod
    def format_header(self, step: BlockT) -> str:
        """The canonical opening line."""
