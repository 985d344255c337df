"""All primitives, by verb, by kind and by step. Built-ins and third parties come in by the same door, `register`.

Built-ins are the modules of `plan/primitives`; third parties name theirs in the entry-point group
`chatrobot.primitives`. Those are looked for only when something is asked for that no built-in answers to, or when
everything is asked for, because scanning installed distributions takes longer than reading a plan.
"""

from __future__ import annotations

import importlib
import pkgutil
from collections.abc import Callable
from typing import Any, Union

from chatrobot.core.errors import UsageError
from chatrobot.plan.base import Step
from chatrobot.plan.primitive import BlockPrimitive, Primitive

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
    """Every primitive there is, sorted by kind."""
    _load_built_ins()
    _load_third_parties()
    return tuple(_by_kind[kind] for kind in sorted(_by_kind))


def for_verb(verb: str) -> AnyPrimitive | None:
    return _find(lambda: _by_verb.get(verb))


def for_kind(kind: str) -> AnyPrimitive | None:
    return _find(lambda: _by_kind.get(kind))


def for_step(step: Step) -> AnyPrimitive:
    """The primitive a step belongs to.

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
        register(importlib.import_module(f"{BUILT_IN_PACKAGE}.{module.name}").PRIMITIVE)
    _loaded.add(BUILT_IN_PACKAGE)


def _load_third_parties() -> None:
    if ENTRY_POINT_GROUP in _loaded:
        return
    _loaded.add(ENTRY_POINT_GROUP)
    import importlib.metadata

    for entry in importlib.metadata.entry_points(group=ENTRY_POINT_GROUP):
        register(entry.load())
