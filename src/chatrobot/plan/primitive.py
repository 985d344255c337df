"""The contract of a primitive: its step, its line of plan text, its way down to the core; and all primitives there are.

To add one, list it in `PRIMITIVES` of a module in `plan/primitives`, or, in a package of your own, name it in the
entry-point group `chatrobot.primitives`. Nothing else changes: text, JSON, schema, rehearsal and execution look it up
here. Third parties are looked for only when something is asked for that no built-in answers to, or when everything is
asked for, because scanning installed distributions takes longer than reading a plan.
"""

from __future__ import annotations

import importlib
import pkgutil
from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import replace
from typing import Any, ClassVar, Generic, TypeVar, Union

from chatrobot.core.errors import UsageError
from chatrobot.core.geometry import Pose
from chatrobot.plan.base import Block, Step
from chatrobot.plan.context import Lowered, LoweringContext
from chatrobot.plan.reader import LineReader

StepT = TypeVar("StepT", bound=Step)
BlockT = TypeVar("BlockT", bound=Block)
HeaderT = TypeVar("HeaderT")

StepParts = tuple[Union[Step, None], Union[Step, None]]
"""The part of a step that was done and the part that is left; None for a part that is nothing."""


def divided(step: Any, field: str, parts: tuple[float, float]) -> StepParts:
    """Return the two parts of a step, `field` of which has been divided into `parts`."""
    done, rest = (replace(step, **{field: part}) if part else None for part in parts)
    return done, rest


class PrimitiveInfo:
    """Describes a primitive, simple or block.

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
        """Read what follows the verb; nothing may be left on the line then. Raises PlanTextError (through `line`)."""

    @abstractmethod
    def format(self, step: StepT) -> str:
        """Return the one canonical line, verb included, that parses to an equal step."""

    @abstractmethod
    def lower(self, step: StepT, context: LoweringContext) -> Lowered:
        """Return the core motions that do it from `context.pose`, or why it is impossible."""

    def divide(self, step: StepT, share: float, context: LoweringContext) -> StepParts:  # noqa: ARG002
        """Divide `step` where it was left off. Both None: `plan.split` divides its core motions instead.

        Args:
            share: how much of its core motion was driven, 0 to 1, for a step that lowers to one.
            context: `pose` is where the robot stands now.
        """
        return None, None

    def resolve(self, step: StepT, plan_start: Pose) -> StepT:  # noqa: ARG002
        """Return the same step without the frame `start`, for a plan that begins elsewhere."""
        return step


class BlockPrimitive(PrimitiveInfo, ABC, Generic[BlockT, HeaderT]):
    """A step that holds others, up to its `end`."""

    @abstractmethod
    def parse_header(self, line: LineReader) -> HeaderT:
        """Read what follows the verb on the opening line."""

    @abstractmethod
    def close(self, header: HeaderT, steps: tuple[Step, ...]) -> BlockT:
        """Return the whole step, once its `end` was read. Raises ValueError."""

    @abstractmethod
    def format_header(self, step: BlockT) -> str:
        """Return the canonical opening line."""


ENTRY_POINT_GROUP = "chatrobot.primitives"
BUILT_IN_PACKAGE = "chatrobot.plan.primitives"
RESERVED_VERBS = frozenset({"end"})

AnyPrimitive = Union[Primitive[Any], BlockPrimitive[Any, Any]]

_by_kind: dict[str, AnyPrimitive] = {}
_by_verb: dict[str, AnyPrimitive] = {}
_by_type: dict[type[Step], AnyPrimitive] = {}
_loaded: set[str] = set()


def register(primitive: AnyPrimitive) -> None:
    """Make a primitive known. Doing it twice with the same one changes nothing.

    Raises:
        UsageError: its verb or kind is taken by another.
    """
    if _by_kind.get(primitive.kind) is primitive:
        return
    if primitive.kind in _by_kind or primitive.verb in _by_verb or primitive.verb in RESERVED_VERBS:
        raise UsageError(f"the primitive {primitive.kind!r} (verb {primitive.verb!r}) exists already")
    _by_kind[primitive.kind] = primitive
    _by_verb[primitive.verb] = primitive
    _by_type[primitive.step_type] = primitive


def unregister(primitive: AnyPrimitive) -> None:
    """Take a primitive out again (a plug-in that is switched off, a test)."""
    del _by_kind[primitive.kind], _by_verb[primitive.verb], _by_type[primitive.step_type]


def primitives() -> tuple[AnyPrimitive, ...]:
    """Return every primitive there is, sorted by kind."""
    _load_built_ins()
    _load_third_parties()
    return tuple(_by_kind[kind] for kind in sorted(_by_kind))


def for_verb(verb: str) -> AnyPrimitive | None:
    """Return the primitive whose lines begin with that word, or None."""
    return _find(lambda: _by_verb.get(verb))


def for_kind(kind: str) -> AnyPrimitive | None:
    """Return the primitive of that name in JSON, or None."""
    return _find(lambda: _by_kind.get(kind))


def for_step(step: Step) -> AnyPrimitive:
    """Return the primitive a step belongs to.

    Raises:
        UsageError: nobody registered this type of step.
    """
    found = _find(lambda: _by_type.get(type(step)))
    if found is None:
        raise UsageError(f"no primitive is registered for {type(step).__name__}")
    return found


def _find(look: Callable[[], AnyPrimitive | None]) -> AnyPrimitive | None:
    for load in (_load_built_ins, _load_third_parties):
        load()
        found = look()
        if found is not None:
            return found
    return None


def _load_built_ins() -> None:
    if BUILT_IN_PACKAGE in _loaded:
        return
    package = importlib.import_module(BUILT_IN_PACKAGE)
    for module in pkgutil.iter_modules(package.__path__):
        for primitive in importlib.import_module(f"{BUILT_IN_PACKAGE}.{module.name}").PRIMITIVES:
            register(primitive)
    _loaded.add(BUILT_IN_PACKAGE)


def _load_third_parties() -> None:
    if ENTRY_POINT_GROUP in _loaded:
        return
    _loaded.add(ENTRY_POINT_GROUP)
    import importlib.metadata

    for entry in importlib.metadata.entry_points(group=ENTRY_POINT_GROUP):
        register(entry.load())
