"""rclpy.parameter"""

from __future__ import annotations

from array import array
from collections.abc import Iterable
from enum import Enum
from typing import Any

from chatrobot.programs.inside.interfaces import kind

ParameterMsg, ParameterValue = kind("rcl_interfaces/Parameter"), kind("rcl_interfaces/ParameterValue")
_FIELDS = {
    "BOOL": "bool_value", "INTEGER": "integer_value", "DOUBLE": "double_value", "STRING": "string_value",
    "BYTE_ARRAY": "byte_array_value", "BOOL_ARRAY": "bool_array_value", "INTEGER_ARRAY": "integer_array_value",
    "DOUBLE_ARRAY": "double_array_value", "STRING_ARRAY": "string_array_value",
}  # fmt: skip
_SCALARS: dict[type, str] = {bool: "BOOL", int: "INTEGER", float: "DOUBLE", str: "STRING"}


class Parameter:
    """A name and a value of one of ROS's types."""

    class Type(Enum):
        """What a parameter may be."""

        NOT_SET = 0
        BOOL = 1
        INTEGER = 2
        DOUBLE = 3
        STRING = 4
        BYTE_ARRAY = 5
        BOOL_ARRAY = 6
        INTEGER_ARRAY = 7
        DOUBLE_ARRAY = 8
        STRING_ARRAY = 9

        @classmethod
        def from_parameter_value(cls, parameter_value: Any) -> Parameter.Type:
            if parameter_value is None:
                return cls.NOT_SET
            kind = _SCALARS.get(type(parameter_value))
            if kind is not None:
                return cls[kind]
            if isinstance(parameter_value, (list, tuple, array)):
                return cls._of_array(parameter_value)
            raise TypeError(f"The given value is not one of the allowed types '{parameter_value}'.")

        @classmethod
        def _of_array(cls, values: Iterable[Any]) -> Parameter.Type:
            items = list(values)
            if items and all(isinstance(item, bytes) for item in items):
                return cls.BYTE_ARRAY
            kinds = {_SCALARS.get(type(item), "") for item in items}
            if not items:
                return cls.BYTE_ARRAY
            if len(kinds) == 1 and "" not in kinds:
                return cls[f"{kinds.pop()}_ARRAY"]
            raise TypeError("The given value is not a list of one of the allowed types")

        def check(self, parameter_value: Any) -> bool:
            if self is Parameter.Type.NOT_SET:
                return parameter_value is None
            found = Parameter.Type.from_parameter_value(parameter_value)
            return found is self or (self.name.endswith("_ARRAY") and parameter_value == [])

    def __init__(self, name: str, type_: Parameter.Type | None = None, value: Any = None) -> None:
        if type_ is None:
            type_ = Parameter.Type.from_parameter_value(value)
        if not isinstance(type_, Parameter.Type):
            raise TypeError("type must be an instance of 'Parameter.Type'")
        if value is not None and not type_.check(value):
            raise ValueError(f"Type '{type_}' and value '{value}' do not agree")
        self._name, self._type, self._value = name, type_, value

    @property
    def name(self) -> str:
        return self._name

    @property
    def type_(self) -> Parameter.Type:
        return self._type

    @property
    def value(self) -> Any:
        return self._value

    def get_parameter_value(self) -> Any:
        message = ParameterValue(type=self._type.value)
        if self._type is not Parameter.Type.NOT_SET and self._value is not None:
            setattr(message, _FIELDS[self._type.name], self._value)
        return message

    def to_parameter_msg(self) -> Any:
        return ParameterMsg(name=self.name, value=self.get_parameter_value())

    @classmethod
    def from_parameter_msg(cls, param_msg: Any) -> Parameter:
        return cls(param_msg.name, value=parameter_value_to_python(param_msg.value))


def parameter_value_to_python(parameter_value: Any) -> Any:
    """What a `ParameterValue` holds."""
    kind = Parameter.Type(parameter_value.type)
    if kind is Parameter.Type.NOT_SET:
        return None
    value = getattr(parameter_value, _FIELDS[kind.name])
    return value.tolist() if isinstance(value, array) else value
