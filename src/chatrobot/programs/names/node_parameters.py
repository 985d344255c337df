"""The part of `rclpy.node.Node` that keeps its parameters."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

from chatrobot.programs.inside.interfaces import kind
from chatrobot.programs.names.errors import (
    InvalidParameterException,
    InvalidParameterTypeException,
    InvalidParameterValueException,
    ParameterAlreadyDeclaredException,
    ParameterImmutableException,
    ParameterNotDeclaredException,
    ParameterUninitializedException,
)
from chatrobot.programs.names.parameter import Parameter, parameter_value_to_python

ListParametersResult = kind("rcl_interfaces/ListParametersResult")
ParameterDescriptor = kind("rcl_interfaces/ParameterDescriptor")
SetParametersResult = kind("rcl_interfaces/SetParametersResult")
_NOT_SET = Parameter.Type.NOT_SET
Result = Any


class NodeParameters:
    """Declares, reads and sets; types are static unless a descriptor says otherwise."""

    PARAM_REL_TOL = 1e-6

    def __init__(self, overrides: Mapping[str, Any], allow_undeclared: bool, declare_overrides: bool) -> None:
        self._parameters: dict[str, Parameter] = {}
        self._descriptors: dict[str, Any] = {}
        self._parameter_overrides = {name: Parameter(name, value=value) for name, value in overrides.items()}
        self._allow_undeclared_parameters = allow_undeclared
        self._on_set_parameters_callbacks: list[Callable[[list[Parameter]], Result]] = []
        self._post_set_parameters_callbacks: list[Callable[[list[Parameter]], None]] = []
        self._pre_set_parameters_callbacks: list[Callable[[list[Parameter]], list[Parameter]]] = []
        if declare_overrides:
            declared = [(name, value, ParameterDescriptor()) for name, value in overrides.items()]
            self.declare_parameters("", declared, ignore_override=True)
        for name, value in (("use_sim_time", False), ("start_type_description_service", True)):
            if not self.has_parameter(name):  # as rclpy's own parts do, one after the other
                self.declare_parameter(name, value)

    def declare_parameter(
        self, name: str, value: Any = None, descriptor: Any = None, ignore_override: bool = False
    ) -> Parameter:
        descriptor = ParameterDescriptor() if descriptor is None else descriptor
        return self.declare_parameters("", [(name, value, descriptor)], ignore_override)[0]

    def __declare(self, name: str, value: Any, descriptor: Any, ignore_override: bool) -> Parameter:
        if not name or name.startswith(".") or name.endswith("."):
            raise InvalidParameterException(name)
        if name in self._parameters:
            raise ParameterAlreadyDeclaredException([name])
        descriptor = ParameterDescriptor() if descriptor is None else descriptor
        kind, value = _typed(value)
        if not ignore_override and name in self._parameter_overrides:
            value = self._parameter_overrides[name].value
        descriptor.name = name
        parameter = Parameter(name, value=value)
        if (
            value is not None
            and kind is not _NOT_SET
            and not descriptor.dynamic_typing
            and not kind.check(value)
        ):
            raise InvalidParameterTypeException(parameter, kind.name)
        descriptor.type = (kind if kind is not _NOT_SET else parameter.type_).value
        problem = _out_of_range(descriptor, value)
        if problem:
            raise InvalidParameterValueException(name, value, problem)
        result = self.__ask_callbacks([parameter])
        if not result.successful:
            raise InvalidParameterValueException(name, value, result.reason)
        self._parameters[name], self._descriptors[name] = parameter, descriptor
        return parameter

    def declare_parameters(
        self, namespace: str, parameters: Sequence[Sequence[Any]], ignore_override: bool = False
    ) -> list[Parameter]:
        prefix = f"{namespace}." if namespace else ""
        for entry in parameters:
            if not isinstance(entry, Sequence) or isinstance(entry, str):
                raise TypeError(f"Each parameter must be a tuple, got {entry!r}")
        declared = []
        for index, (name, *rest) in enumerate(parameters):
            if not isinstance(name, str):
                raise TypeError(f"First element {name} at index {index} in parameters list is not a str.")
            value, descriptor = [*rest, None, None][:2]
            declared.append(self.__declare(f"{prefix}{name}", value, descriptor, ignore_override))
        return declared

    def undeclare_parameter(self, name: str) -> None:
        if name not in self._parameters:
            raise ParameterNotDeclaredException(name)
        if self._descriptors[name].read_only:
            raise ParameterImmutableException(name)
        del self._parameters[name], self._descriptors[name]

    def has_parameter(self, name: str) -> bool:
        return name in self._parameters

    def get_parameter(self, name: str) -> Parameter:
        if name in self._parameters:
            parameter = self._parameters[name]
            if parameter.type_ is _NOT_SET and self._descriptors[name].type != 0:
                raise ParameterUninitializedException(name)
            return parameter
        if self._allow_undeclared_parameters:
            return Parameter(name, _NOT_SET, None)
        raise ParameterNotDeclaredException(name)

    def get_parameters(self, names: Sequence[str]) -> list[Parameter]:
        if not all(isinstance(name, str) for name in names):
            raise TypeError("All names must be instances of type str")
        return [self.get_parameter(name) for name in names]

    def get_parameter_or(self, name: str, alternative_value: Parameter | None = None) -> Parameter:
        default = Parameter(name, _NOT_SET) if alternative_value is None else alternative_value
        found = self._parameters.get(name)
        return default if found is None or found.type_ is _NOT_SET else found

    def get_parameters_by_prefix(self, prefix: str) -> dict[str, Parameter]:
        start = f"{prefix}." if prefix else ""
        return {name[len(start) :]: p for name, p in self._parameters.items() if name.startswith(start)}

    def get_parameter_types(self, names: Sequence[str]) -> list[int]:
        return [self.get_parameter_type(name) for name in names]

    def get_parameter_type(self, name: str) -> int:
        return int(self.get_parameter(name).type_.value)

    def describe_parameter(self, name: str) -> Any:
        if name not in self._descriptors:
            raise ParameterNotDeclaredException(name)
        return self._descriptors[name]

    def describe_parameters(self, names: Sequence[str]) -> list[Any]:
        return [self.describe_parameter(name) for name in names]

    def set_descriptor(self, name: str, descriptor: Any, alternative_value: Any = None) -> Any:
        """The value afterwards, as a message."""
        if self.describe_parameter(name).read_only:
            raise ParameterImmutableException(name)
        parameter = self.get_parameter(name)
        if alternative_value is not None:
            parameter = Parameter(name, value=parameter_value_to_python(alternative_value))
        descriptor.name, descriptor.type = name, parameter.type_.value
        problem = _out_of_range(descriptor, parameter.value)
        if problem:
            raise InvalidParameterValueException(name, parameter.value, problem)
        self._parameters[name], self._descriptors[name] = parameter, descriptor
        return parameter.get_parameter_value()

    def list_parameters(self, prefixes: Sequence[str], depth: int) -> Any:
        """`depth` counts names between dots below a prefix; 0 is all of them."""
        if not isinstance(prefixes, list) or not all(isinstance(prefix, str) for prefix in prefixes):
            raise TypeError("The prefixes argument must be a list of strings")
        if not isinstance(depth, int) or depth < 0:
            raise TypeError("The depth must be an integer that is not negative")
        found = ListParametersResult()
        for name in self._parameters:
            below = [name[len(prefix) + 1 :] for prefix in prefixes if name.startswith(f"{prefix}.")]
            below = below or [name for prefix in prefixes if name == prefix] or ([] if prefixes else [name])
            if below and (depth == 0 or min(rest.count(".") for rest in below) < depth):
                found.names = [*found.names, name]
                prefix = name.rpartition(".")[0]
                if prefix and prefix not in found.prefixes:
                    found.prefixes = [*found.prefixes, prefix]
        return found

    def set_parameters(self, parameter_list: Sequence[Parameter]) -> list[Result]:
        return [self.set_parameters_atomically([parameter]) for parameter in parameter_list]

    def set_parameters_atomically(self, parameter_list: Sequence[Parameter]) -> Result:
        parameters = list(parameter_list)
        for before in self._pre_set_parameters_callbacks:
            parameters = before(parameters)
        if not all(isinstance(parameter, Parameter) for parameter in parameters):
            raise TypeError(f"parameter must be instance of type '{Parameter!r}'")
        unknown = [parameter.name for parameter in parameters if parameter.name not in self._parameters]
        if unknown and not self._allow_undeclared_parameters:
            raise ParameterNotDeclaredException([])  # rclpy has used up the names by then
        for parameter in parameters:
            problem = self.__problem(parameter)
            if problem:
                return SetParametersResult(successful=False, reason=problem)
        result = self.__ask_callbacks(parameters)
        if result.successful:
            for parameter in parameters:
                self._parameters[parameter.name] = parameter
                self._descriptors.setdefault(parameter.name, ParameterDescriptor(name=parameter.name))
            for callback in self._post_set_parameters_callbacks:
                callback(parameters)
        return result

    def __problem(self, parameter: Parameter) -> str:
        descriptor = self._descriptors.get(parameter.name)
        if descriptor is None:
            return ""
        if descriptor.read_only:
            return f"Trying to set a read-only parameter: {parameter.name}."
        expected = Parameter.Type(descriptor.type)
        if not descriptor.dynamic_typing and expected is not _NOT_SET and not expected.check(parameter.value):
            return f"Wrong parameter type, expected '{expected}' got '{parameter.type_}'"
        return _out_of_range(descriptor, parameter.value)

    def __ask_callbacks(self, parameters: list[Parameter]) -> Result:
        for callback in self._on_set_parameters_callbacks:
            result = callback(parameters)
            if not result.successful:
                return result
        return SetParametersResult(successful=True)

    def add_on_set_parameters_callback(self, callback: Callable[[list[Parameter]], Result]) -> None:
        self._on_set_parameters_callbacks.insert(0, callback)

    def remove_on_set_parameters_callback(self, callback: Callable[[list[Parameter]], Result]) -> None:
        self._on_set_parameters_callbacks.remove(callback)

    def add_post_set_parameters_callback(self, callback: Callable[[list[Parameter]], None]) -> None:
        self._post_set_parameters_callbacks.insert(0, callback)

    def remove_post_set_parameters_callback(self, callback: Callable[[list[Parameter]], None]) -> None:
        self._post_set_parameters_callbacks.remove(callback)

    def add_pre_set_parameters_callback(self, callback: Callable[[list[Parameter]], list[Parameter]]) -> None:
        self._pre_set_parameters_callbacks.insert(0, callback)

    def remove_pre_set_parameters_callback(
        self, callback: Callable[[list[Parameter]], list[Parameter]]
    ) -> None:
        self._pre_set_parameters_callbacks.remove(callback)


def _typed(value: Any) -> tuple[Parameter.Type, Any]:
    """The type a declaration fixes, and its value: it may name a type instead of a value."""
    if isinstance(value, Parameter.Type):
        return value, None
    return Parameter.Type.from_parameter_value(value), value


def _out_of_range(descriptor: Any, value: Any) -> str:
    for ranges, point in ((descriptor.floating_point_range, ""), (descriptor.integer_range, ".")):
        for bounds in ranges:
            if isinstance(value, (int, float)) and not bounds.from_value <= value <= bounds.to_value:
                limits = f"Min: {bounds.from_value}, Max: {bounds.to_value}, value: {value}"
                return f"Parameter {descriptor.name} out of range{point} {limits}"
    return ""
