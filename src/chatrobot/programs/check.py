"""Reads a program for syntax errors, imports, risky lines and another robot's topic. This is advice, never the fence.

What contains a program is the sandbox, whatever this file overlooks.
"""

from __future__ import annotations

import ast
import sys
from collections.abc import Iterator
from dataclasses import dataclass

from chatrobot.core.reason import Reason, Value
from chatrobot.plan.context import Severity
from chatrobot.robots.profile import RobotProfile

MAX_SOURCE_CHARS = 60_000

ROBOT_MODULES = frozenset(
    {
        "rclpy", "rclpy.node", "rclpy.qos", "rclpy.duration", "rclpy.time", "rclpy.clock", "rclpy.executors",
        "rclpy.callback_groups", "rclpy.parameter", "rclpy.logging", "rclpy.signals", "rclpy.timer",
        "rclpy.publisher", "rclpy.subscription", "rclpy.exceptions", "rclpy.task", "rclpy.utilities",
        "rclpy.action", "rclpy.client", "rclpy.clock_type", "rclpy.constants", "rclpy.context", "rclpy.event_handler",
        "rclpy.guard_condition", "rclpy.impl", "rclpy.impl.logging_severity", "rclpy.impl.rcutils_logger",
        "rclpy.service", "rclpy.wait_for_message", "rclpy._rclpy_pybind11",
        "geometry_msgs.msg", "std_msgs.msg", "sensor_msgs.msg", "nav_msgs.msg", "std_srvs.srv",
        "builtin_interfaces.msg", "rcl_interfaces.msg", "turtlesim.msg", "tf_transformations", "turtlesim.srv",
        "example_interfaces.msg", "example_interfaces.srv",
    }
)  # fmt: skip
"""What stands in the sandbox for ROS 2."""

FORBIDDEN_MODULES = frozenset(
    {
        "socket", "socketserver", "ssl", "http", "urllib", "ftplib", "smtplib", "poplib", "imaplib", "telnetlib",
        "xmlrpc", "subprocess", "multiprocessing", "ctypes", "_ctypes", "cffi", "shutil", "pickle", "cPickle",
        "marshal", "shelve", "dbm", "sqlite3", "pty", "fcntl", "mmap", "importlib", "imp", "runpy", "webbrowser",
        "requests", "httpx", "aiohttp", "paramiko", "cyclonedds", "zenoh", "roslibpy", "serial", "smbus", "pexpect",
        "psutil",
    }
)  # fmt: skip
"""Nothing of these is of use to a robot's program, and all of them reach out of it."""

_RISKY_CALLS = {
    "eval": "runs_text", "exec": "runs_text", "compile": "runs_text", "__import__": "runs_text",
    "open": "touches_files", "os.system": "runs_commands", "os.popen": "runs_commands", "os.fork": "runs_commands",
    "os.kill": "runs_commands", "os._exit": "leaves_at_once", "sys.settrace": "looks_inside",
    "os.remove": "touches_files", "os.unlink": "touches_files", "os.rename": "touches_files",
    "os.open": "touches_files", "os.write": "touches_files", "signal.signal": "takes_signals",
}  # fmt: skip
_RISKY_PREFIXES = {"os.exec": "runs_commands", "os.spawn": "runs_commands", "subprocess.": "runs_commands"}
_INSIDES = frozenset(
    {"__subclasses__", "__globals__", "__builtins__", "__code__", "__closure__", "f_back", "f_globals", "gi_frame",
     "tb_frame", "__mro__", "__bases__", "__reduce__", "_getframe"}
)  # fmt: skip
_TWISTS = frozenset({"Twist", "TwistStamped"})
_FIELDS = {(vector, axis) for vector in ("linear", "angular") for axis in "xyz"}


@dataclass(frozen=True)
class Mark:
    """One line that a person should look at. `line` counts from 1; 0 is the program as a whole."""

    severity: Severity
    line: int
    reason: Reason


@dataclass(frozen=True)
class Checked:
    """The marks of a program that was read. `remap` leads other topics for velocities to the robot's, if agreed to."""

    marks: tuple[Mark, ...]
    remap: tuple[tuple[str, str], ...] = ()

    @property
    def refusal(self) -> Mark | None:
        """Return why it cannot run at all."""
        return next((mark for mark in self.marks if mark.severity == "refuse"), None)


def check(source: str, profile: RobotProfile) -> Checked:
    """Read `source` for a robot of that profile. Never raises, whatever the source; nothing of it is run."""
    problem = no_python(source)
    if problem is not None:
        return Checked((problem,))
    try:
        reader = _Reader(ast.parse(source), profile)
        found = {(mark.line, str(mark.reason)): mark for mark in reader.marks()}
    except RecursionError:  # nested too deep for us
        return Checked((_mark("refuse", 0, "program_unreadable"),))
    return Checked(tuple(found[key] for key in sorted(found)), tuple(sorted(reader.remap.items())))


def no_python(source: str) -> Mark | None:
    """Return why `source` is no program at all; None where it is one. Never raises."""
    if len(source) > MAX_SOURCE_CHARS:
        return _mark("refuse", 0, "program_too_long", characters=len(source), limit=MAX_SOURCE_CHARS)
    try:
        if not ast.parse(source).body:
            return _mark("refuse", 0, "program_empty")
    except SyntaxError as error:
        line = error.lineno or 0
        return _mark("refuse", line, "program_syntax", line=line, problem=str(error.msg))
    except (ValueError, RecursionError, MemoryError):  # nested too deep for this Python's parser
        return _mark("refuse", 0, "program_unreadable")
    return None


def _mark(severity: Severity, at_line: int, code: str, **values: Value) -> Mark:
    return Mark(severity, at_line, Reason(code, values))


class _Reader:
    """One look through the tree."""

    def __init__(self, tree: ast.Module, profile: RobotProfile) -> None:
        self._tree = tree
        self._profile = profile
        self.remap: dict[str, str] = {}

    def marks(self) -> Iterator[Mark]:
        for node in ast.walk(self._tree):
            if isinstance(node, ast.Import):
                for alias in node.names:
                    yield from self._import(alias.name, (), node.lineno)
            elif isinstance(node, ast.ImportFrom):
                names = tuple(alias.name for alias in node.names)
                yield from self._import(("." * node.level) + (node.module or ""), names, node.lineno)
            elif isinstance(node, ast.Call):
                yield from self._call(node)
            elif isinstance(node, ast.Attribute) and node.attr in _INSIDES:
                yield _mark("warn", node.lineno, "looks_inside", what=node.attr)
            elif isinstance(node, ast.Assign):
                yield from self._assignment(node)
            elif isinstance(node, ast.While):
                yield from self._loop(node)
            elif isinstance(node, ast.ExceptHandler) and node.type is None:
                yield _mark("note", node.lineno, "catches_everything")
        yield from self._whole()

    def _import(self, module: str, names: tuple[str, ...], line: int) -> Iterator[Mark]:
        root = module.split(".")[0]
        if module.startswith(".") or root in FORBIDDEN_MODULES:
            yield _mark("refuse", line, "import_forbidden", module=module, line=line)
        elif root in _ROBOT_ROOTS:
            if module not in ROBOT_MODULES and module not in _ROBOT_ROOTS:
                yield _mark("refuse", line, "import_unknown", module=module, line=line)
        elif root not in sys.stdlib_module_names and root != "numpy":
            yield _mark("refuse", line, "import_unknown", module=module, line=line)
        elif root == "os" and set(names) & {"system", "popen", "fork"}:
            yield _mark("warn", line, "runs_commands", what=module)

    def _call(self, node: ast.Call) -> Iterator[Mark]:
        name = ast.unparse(node.func) if isinstance(node.func, (ast.Name, ast.Attribute)) else ""
        code = _RISKY_CALLS.get(name) or next(
            (code for prefix, code in _RISKY_PREFIXES.items() if name.startswith(prefix)), None
        )
        if code is not None:
            yield _mark("warn", node.lineno, code, what=name)
        elif name.endswith(".create_publisher") and len(node.args) >= 2:
            yield from self._publisher(node)

    def _publisher(self, node: ast.Call) -> Iterator[Mark]:
        kind, topic = ast.unparse(node.args[0]).split(".")[-1], _text(node.args[1])
        if kind not in _TWISTS or topic is None:
            return
        wiring, line = self._profile.wiring, node.lineno
        if topic.strip("/") != wiring.cmd_vel_topic.strip("/"):
            self.remap[topic] = wiring.cmd_vel_topic
            yield _mark("warn", line, "other_topic", topic=topic, robot_topic=wiring.cmd_vel_topic, line=line)
        if kind != wiring.cmd_vel_type:
            yield _mark("note", line, "other_type", type=kind, robot_type=wiring.cmd_vel_type, line=line)

    def _assignment(self, node: ast.Assign) -> Iterator[Mark]:
        value, line = _number(node.value), node.lineno
        if value is None:
            return
        for target in node.targets:
            field = _velocity_field(target)
            if field is None:
                continue
            if isinstance(value, int):
                yield _mark("warn", line, "float_field", field=".".join(field), value=value, line=line)
            limits = self._profile.limits
            most = {("linear", "x"): limits.max_speed_mps, ("linear", "y"): limits.max_sideways_mps,
                    ("angular", "z"): limits.max_rate_radps}.get(field)  # fmt: skip
            if most is not None and abs(value) > most:
                yield _mark(
                    "warn", line, "beyond_limit", field=".".join(field), value=value, max=most, line=line
                )

    def _loop(self, node: ast.While) -> Iterator[Mark]:
        is_endless = isinstance(node.test, ast.Constant) and bool(node.test.value)
        leaves = any(isinstance(inner, (ast.Break, ast.Return, ast.Raise)) for inner in ast.walk(node))
        if is_endless and not leaves:
            yield _mark("note", node.lineno, "endless_loop", line=node.lineno)

    def _whole(self) -> Iterator[Mark]:
        called = {ast.unparse(node.func) for node in ast.walk(self._tree) if isinstance(node, ast.Call)}
        publishes = any(name.endswith(".publish") for name in called)
        if not publishes:
            yield _mark("note", 0, "publishes_nothing")
        has_init = any(name.split(".")[-1] in ("init", "Context") for name in called)
        if publishes and not has_init:
            yield _mark("warn", 0, "no_init")


_ROBOT_ROOTS = frozenset(module.split(".")[0] for module in ROBOT_MODULES)


def _text(node: ast.expr) -> str | None:
    return node.value if isinstance(node, ast.Constant) and isinstance(node.value, str) else None


def _number(node: ast.expr) -> float | int | None:
    if isinstance(node, ast.UnaryOp) and isinstance(node.op, (ast.USub, ast.UAdd)):
        inner = _number(node.operand)
        return None if inner is None else -inner if isinstance(node.op, ast.USub) else inner
    if isinstance(node, ast.Constant) and isinstance(node.value, (int, float)):
        return None if isinstance(node.value, bool) else node.value
    return None


def _velocity_field(target: ast.expr) -> tuple[str, str] | None:
    """(linear, x) for `twist.linear.x`."""
    if isinstance(target, ast.Attribute) and isinstance(target.value, ast.Attribute):
        field = (target.value.attr, target.attr)
        return field if field in _FIELDS else None
    return None
