"""Read the JSON form of a plan, for tools and models with structured output. pydantic is imported only on reading.

    {"version": "chatrobot-plan/1", "steps": [{"kind": "drive", "distance_m": 1.0}, …]}

Fields are those of the steps' dataclasses; a field that has its default may be left out.
"""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from typing import Any

from chatrobot.core.errors import PlanTextError
from chatrobot.plan.base import MAX_LINES, MAX_NESTING, Block, Plan, Step
from chatrobot.plan.primitive import for_kind, primitives

VERSION = "chatrobot-plan/1"
_STEPS_SCHEMA = {"type": "array", "items": {"$ref": "#/$defs/Step"}, "minItems": 1, "maxItems": MAX_LINES}


def plan_from_json(data: str | bytes | Mapping[str, Any]) -> Plan:
    """Read the JSON form, as text or as parsed already.

    Raises:
        PlanTextError: names the field (as in steps[2].speed_mps) and what is wrong with it.
    """
    if isinstance(data, (str, bytes)):
        try:
            data = json.loads(data)
        except (ValueError, RecursionError) as error:
            raise PlanTextError(f"not valid JSON: {error}") from error
    if not isinstance(data, Mapping):
        raise PlanTextError("a plan is a JSON object", allowed='{"version": …, "steps": […]}')
    unknown = sorted(set(data) - {"version", "steps", "$schema"})
    if unknown:
        raise PlanTextError(f"the field {unknown[0]!r} is unknown", allowed="version, steps")
    if data.get("version", VERSION) != VERSION:
        raise PlanTextError(f"version is {data['version']!r}", allowed=repr(VERSION))
    steps = _read_steps(data.get("steps"), "steps", 0)
    try:
        return Plan(steps)
    except ValueError as error:
        raise PlanTextError(f"steps: {error}") from error


def _read_steps(data: Any, path: str, depth: int) -> tuple[Step, ...]:
    if depth > MAX_NESTING:
        raise PlanTextError(f"{path}: blocks are nested at most {MAX_NESTING} deep")
    if isinstance(data, (str, bytes)) or not isinstance(data, Sequence) or len(data) > MAX_LINES:
        raise PlanTextError(f"{path}: must be a list of at most {MAX_LINES} steps")
    return tuple(_read_step(item, f"{path}[{index}]", depth) for index, item in enumerate(data))


def _read_step(data: Any, path: str, depth: int) -> Step:
    if not isinstance(data, Mapping):
        raise PlanTextError(f"{path}: must be an object with a 'kind'")
    kind = data.get("kind")
    primitive = for_kind(kind) if isinstance(kind, str) else None
    if primitive is None:
        kinds = ", ".join(known.kind for known in primitives())
        raise PlanTextError(f"{path}.kind: {kind!r} is not a kind of step", allowed=kinds)
    values = dict(data)
    if issubclass(primitive.step_type, Block):
        values["steps"] = _read_steps(data.get("steps"), f"{path}.steps", depth + 1)
    return _validate(primitive.step_type, values, path)


def _validate(step_type: type[Step], values: dict[str, Any], path: str) -> Step:
    import pydantic

    try:
        step: Step = _adapter(step_type).validate_python(values)
    except pydantic.ValidationError as error:
        first = error.errors(include_url=False)[0]
        where = ".".join([path, *(str(part) for part in first["loc"])])
        raise PlanTextError(f"{where}: {first['msg']}") from error
    _refuse_conversions(values, step, path)
    return step


def _refuse_conversions(values: Mapping[str, Any], read: Any, path: str) -> None:
    """pydantic would read "1" as 1.0 and "yes" as true; who writes that means something else more often than not.

    (Its strict mode does not take a dataclass from a mapping.)
    """
    for name, value in values.items():
        result = getattr(read, name)
        if isinstance(value, Mapping):
            _refuse_conversions(value, result, f"{path}.{name}")
        elif _json_name(value) != _json_name(result):
            raise PlanTextError(f"{path}.{name}: {value!r} should be a {_json_name(result)}")


def _json_name(value: Any) -> str:
    names = {bool: "boolean", int: "number", float: "number", str: "string"}
    return names.get(type(value), "list or object")


_adapters: dict[type[Step], Any] = {}


def _adapter(step_type: type[Step]) -> Any:
    """pydantic's reader for one kind of step; building one takes about a millisecond."""
    if step_type not in _adapters:
        import pydantic

        _adapters[step_type] = pydantic.TypeAdapter(step_type)
    return _adapters[step_type]


def plan_schema() -> dict[str, Any]:
    """Return the JSON schema (draft 2020-12) of the JSON form, with every primitive that is registered."""
    defs: dict[str, Any] = {}
    kinds = {}
    for primitive in primitives():
        schema = _adapter(primitive.step_type).json_schema(ref_template="#/$defs/{model}")
        defs.update(schema.pop("$defs", {}))
        schema["description"] = primitive.help
        if issubclass(primitive.step_type, Block):
            schema["properties"]["steps"] = _STEPS_SCHEMA
        schema["required"] = sorted({"kind", *schema.get("required", ())})
        defs[primitive.step_type.__name__] = schema
        kinds[primitive.kind] = f"#/$defs/{primitive.step_type.__name__}"
    defs["Step"] = {"oneOf": [{"$ref": ref} for ref in kinds.values()]}
    return {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "$id": VERSION,
        "title": "Plan",
        "description": "What a robot is to do, in order. Metres, seconds, radians; x forward, y left.",
        "type": "object",
        "properties": {"version": {"const": VERSION}, "steps": _STEPS_SCHEMA},
        "required": ["steps"],
        "additionalProperties": False,
        "$defs": defs,
    }
