"""Makes message classes from their fields: constructor, checks, repr and equality as ROS's generated classes have."""

from __future__ import annotations

import copy
import math
from array import array
from collections.abc import Callable, Sequence
from typing import Any

REGISTRY: dict[str, type[Any]] = {}
"""Message classes by `package/Name`."""

_INTEGERS = {
    "int8": (-(2**7), 2**7 - 1, "b"), "uint8": (0, 2**8 - 1, "B"), "char": (0, 2**8 - 1, "B"),
    "int16": (-(2**15), 2**15 - 1, "h"), "uint16": (0, 2**16 - 1, "H"),
    "int32": (-(2**31), 2**31 - 1, "i"), "uint32": (0, 2**32 - 1, "I"),
    "int64": (-(2**63), 2**63 - 1, "q"), "uint64": (0, 2**64 - 1, "Q"),
}  # fmt: skip
_FLOATS = {"float32": (3.402823466e38, "f"), "float64": (1.7976931348623157e308, "d")}
_ROS_NAMES = {"float64": "double", "float32": "float", "bool": "boolean", "byte": "octet", "char": "uint8"}

Check = Callable[[str, Any], Any]
"""(field, value) -> what is stored; raises AssertionError with ROS's own words."""
Make = Callable[[], Any]
Field = tuple[Make, Check]


def message(type_name: str, fields: str = "") -> type[Any]:
    """Make a message class.

    Args:
        type_name: `package/Name`.
        fields: as in a .msg file, parted by semicolons: `float64 x; Point[] points; float64 w 1; uint8 SONAR=0`.
    """
    package, name = type_name.split("/")
    return _make(type_name, name, f"{package}.msg._{_snake(name)}", fields)


def service(type_name: str, request: str = "", response: str = "") -> type[Any]:
    """Make a service class with `Request` and `Response`."""
    package, name = type_name.split("/")
    module = f"{package}.srv._{_snake(name)}"
    parts = {
        part: _make(f"{package}/{name}_{part}", f"{name}_{part}", module, fields)
        for part, fields in (("Request", request), ("Response", response))
    }
    return type(name, (), {"__module__": module, "_type_name": f"{package}/srv/{name}", **parts})


def _make(type_name: str, name: str, module: str, text: str) -> type[Any]:
    fields = [field.split() for field in text.split(";") if field.strip()]
    constants = {field.split("=")[0]: int(field.split("=")[1]) for _, field, *_ in fields if "=" in field}
    lines = [line for line in fields if "=" not in line[1]]
    kinds = {line[1]: _qualified(line[0], type_name) for line in lines}
    defaults = {
        line[1]: float(line[2]) if "float" in line[0] else int(line[2]) for line in lines if len(line) > 2
    }
    made = {field: _field(kind) for field, kind in kinds.items()}
    makers = [(field, f"_{field}", _default(made[field][0], defaults.get(field))) for field in kinds]
    body: dict[str, Any] = {
        "__module__": module,
        "__slots__": [f"_{field}" for field in kinds],
        "__init__": _constructor(makers),
        "__repr__": _repr,
        "__eq__": _equals,
        "__hash__": None,
        "_type_name": type_name.replace("/", "/msg/"),
        "_field_names": tuple(kinds),
        "_fields_and_field_types": {field: _ros_name(kind) for field, kind in kinds.items()},
        "get_fields_and_field_types": classmethod(lambda cls: copy.copy(cls._fields_and_field_types)),
        **constants,
    }
    for field, (_, check) in made.items():
        body[field] = _property(field, check)
    kind = REGISTRY[type_name] = type(name, (), body)
    return kind


def _constructor(makers: Sequence[tuple[str, str, Make]]) -> Callable[..., None]:
    known = {field for field, _, _ in makers}

    def __init__(self: Any, **kwargs: Any) -> None:  # noqa: N807
        if kwargs:
            unknown = sorted(key for key in kwargs if key not in known)
            assert not unknown, "Invalid arguments passed to constructor: " + ", ".join(unknown)
        for field, slot, make in makers:
            if field in kwargs:
                setattr(self, field, kwargs[field])
            else:
                setattr(self, slot, make())

    return __init__


def _property(field: str, check: Check) -> property:
    slot = f"_{field}"

    def get(self: Any) -> Any:
        return getattr(self, slot)

    def put(self: Any, value: Any) -> None:
        setattr(self, slot, check(field, value))

    return property(get, put)


def _repr(self: Any) -> str:
    package = type(self).__module__.rsplit("._", 1)[0]
    shown = ", ".join(f"{field}={_shown(getattr(self, field))}" for field in self._field_names)
    return f"{package}.{type(self).__name__}({shown})"


def _shown(value: Any) -> str:
    return repr(value.tolist()) if isinstance(value, array) else repr(value)


def _equals(self: Any, other: Any) -> bool:
    if type(self) is not type(other):
        return False
    for field in self._field_names:
        mine, theirs = getattr(self, field), getattr(other, field)
        same = mine == theirs
        if not (same if isinstance(same, bool) else bool(same.all())):
            return False
    return True


def _qualified(kind: str, type_name: str) -> str:
    """As .msg files have it: `Header` is std_msgs's, other types without a package are of the same one."""
    if not kind[0].isupper():
        return kind
    return f"std_msgs/{kind}" if kind == "Header" else f"{type_name.split('/')[0]}/{kind}"


# --- fields ---


def _default(make: Make, value: Any) -> Make:
    return make if value is None else lambda: value


def _field(kind: str) -> Field:
    if kind.endswith("[]"):
        return _sequence(kind[:-2])
    if kind.endswith("]"):
        base, _, size = kind[:-1].partition("[")
        return _sequence(base, int(size[2:])) if size.startswith("<=") else _fixed(base, int(size))
    return _scalar(kind)


def _scalar(kind: str) -> Field:
    if kind in _INTEGERS:
        return _integer(kind)
    if kind in _FLOATS:
        return _float(kind)
    if kind == "bool":
        return lambda: False, _of_type(bool, "bool")
    if kind in ("string", "wstring"):
        return str, _of_type(str, "str")
    if kind == "byte":
        return lambda: b"\x00", _byte
    return _nested(kind)


def _of_type(kind: type[Any], name: str) -> Check:
    def check(field: str, value: Any) -> Any:
        assert isinstance(value, kind), f"The '{field}' field must be of type '{name}'"
        return value

    return check


def _integer(kind: str) -> Field:
    low, high, _ = _INTEGERS[kind]

    def check(field: str, value: Any) -> int:
        assert isinstance(value, int), f"The '{field}' field must be of type 'int'"
        assert low <= value <= high, f"The '{field}' field must be an integer in [{low}, {high}]"
        return value

    return int, check


def _float(kind: str) -> Field:
    largest, _ = _FLOATS[kind]
    name = _ROS_NAMES[kind]

    def check(field: str, value: Any) -> float:
        assert isinstance(value, float), f"The '{field}' field must be of type 'float'"
        assert not (value < -largest or value > largest) or math.isinf(value), (
            f"The '{field}' field must be a {name} in [{-largest}, {largest}]"
        )
        return value

    return float, check


def _byte(field: str, value: Any) -> bytes:
    assert isinstance(value, (bytes, bytearray)) and len(value) == 1, (
        f"The '{field}' field must be of type 'bytes' or 'ByteString' with length 1"
    )
    return bytes(value)


def _nested(kind: str) -> Field:
    """The class is looked up when it is first needed: definitions may come in any order."""
    name = kind.split("/")[1]

    def make() -> Any:
        return REGISTRY[kind]()

    def check(field: str, value: Any) -> Any:
        assert isinstance(value, REGISTRY[kind]), (
            f"The '{field}' field must be a sub message of type '{name}'"
        )
        return value

    return make, check


def _sequence(base: str, most: int | None = None) -> Field:
    _, check_one = _scalar(base)
    code = _code(base)
    name = {"string": "str", "byte": "bytes"}.get(base) or (
        "float" if base in _FLOATS else "int" if code else base.split("/")[-1]
    )

    def check(field: str, value: Any) -> Any:
        if isinstance(value, array) and code:
            assert value.typecode == code, f"The '{field}' array.array() must have the type code of '{code}'"
            return value
        problem = f"The '{field}' field must be a set or sequence and each value of type '{name}'"
        assert hasattr(value, "__iter__") and not isinstance(value, (str, dict)), problem
        items = list(value)
        if code and hasattr(value, "dtype"):
            items = value.tolist()
        for item in items:
            try:
                check_one(field, item)
            except AssertionError as error:
                raise AssertionError(problem) from error
        assert most is None or len(items) <= most, problem
        if code:
            return array(code, value if isinstance(value, (bytes, bytearray)) else items)
        return items

    return (lambda: array(code)) if code else list, check


def _fixed(base: str, size: int) -> Field:
    """Numbers are a numpy array, as in ROS; the rest is a list."""
    _, check_one = _scalar(base)
    code = _code(base)

    def make() -> Any:
        if not code:
            make_one, _ = _scalar(base)
            return [make_one() for _ in range(size)]
        import numpy as np

        return np.zeros(size, dtype=base)

    def check(field: str, value: Any) -> Any:
        problem = f"The '{field}' field must be a set or sequence with length {size}"
        assert hasattr(value, "__len__") and not isinstance(value, str) and len(value) == size, problem
        if not code:
            return [check_one(field, item) for item in value]
        import numpy as np

        if isinstance(value, np.ndarray):
            assert value.dtype == np.dtype(base), (
                f"The '{field}' numpy.ndarray() must have the dtype of '{base}'"
            )
            return value
        return np.array([check_one(field, item) for item in value], dtype=base)

    return make, check


def _code(base: str) -> str:
    if base in _FLOATS:
        return _FLOATS[base][1]
    return _INTEGERS[base][2] if base in _INTEGERS else ""


def _ros_name(kind: str) -> str:
    if kind.endswith("[]"):
        return f"sequence<{_ros_name(kind[:-2])}>"
    base, bracket, rest = kind.partition("[")
    if rest.startswith("<="):
        return f"sequence<{_ros_name(base)}, {rest[2:-1]}>"
    return _ROS_NAMES.get(base, base) + bracket + rest


def _snake(name: str) -> str:
    out = ""
    for at, letter in enumerate(name):
        follows = at + 1 < len(name) and name[at + 1].islower()
        if letter.isupper() and at and (name[at - 1].islower() or name[at - 1].isdigit() or follows):
            out += "_"
        out += letter.lower()
    return out
