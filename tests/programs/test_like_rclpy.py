"""The classes of `rclpy` in the sandbox have the names that rclpy's have, of the same kind, and no others."""

from __future__ import annotations

import sys
from pathlib import Path
from textwrap import dedent, indent
from typing import Any, NamedTuple

import pytest

from chatrobot.motion.programs.rehearsal import ProgramRehearsal, rehearse_program
from chatrobot.programs.events import Ended, Raised
from chatrobot.programs.inside.top_level import modules
from chatrobot.robots.load import load_profile
from chatrobot.sandbox.warm_server import WarmServer

MODULES = {
    "Node": "node", "Publisher": "publisher", "Subscription": "subscription", "Timer": "timer", "Rate": "timer",
    "Client": "client", "Service": "service", "GuardCondition": "guard_condition", "Executor": "executors",
    "SingleThreadedExecutor": "executors", "MultiThreadedExecutor": "executors", "Context": "context",
    "Future": "task", "Task": "task",
}  # fmt: skip
DERIVED_FROM = ("Node", "Publisher")
"""What programs make subclasses of: not even under an underscore may these have a name of their own."""
LEFT_OUT = {("Executor", "wait_for_ready_callbacks")}
"""For those who write executors of their own."""


class Api(NamedTuple):
    name: str
    read_only: frozenset[str]
    writable: frozenset[str]
    methods: frozenset[str]
    attributes: frozenset[str]
    private: frozenset[str]

    @property
    def everything(self) -> frozenset[str]:
        return self.read_only | self.writable | self.methods | self.attributes | self.private


def _read() -> list[Api]:
    lines = Path(__file__).with_name("rclpy_api.txt").read_text(encoding="utf-8").splitlines()
    found = []
    for line in lines:
        if not line.startswith("#"):
            name, *columns = [column.strip() for column in f"{line} ".split("|")]
            found.append(Api(name, *(frozenset(column.split()) for column in columns)))
    return found


API = {api.name: api for api in _read()}


def ours(name: str) -> type:
    found: type = getattr(modules()[f"rclpy.{MODULES[name]}"], name)
    return found


def names_of(kind: type) -> dict[str, Any]:
    """What the class and its bases define, but for what Python or a `__name` of its own keeps apart."""
    bases = [base for base in kind.__mro__ if base is not object]
    return {
        name: value
        for base in reversed(bases)
        for name, value in vars(base).items()
        if not name.startswith("__") and not any(name.startswith(f"_{each.__name__}__") for each in bases)
    }


@pytest.mark.parametrize("api", API.values(), ids=lambda api: api.name)
def test_every_public_name_is_there_and_of_its_kind(api: Api) -> None:
    found = names_of(ours(api.name))
    for name in api.methods:
        assert callable(found.get(name)) or (api.name, name) in LEFT_OUT, name
    for name in api.read_only | api.writable:
        assert isinstance(found.get(name), property), name
    for name in api.read_only - {"handle"}:  # a node's says that itself
        assert found[name].fset is None, name
    for name in api.writable:
        assert found[name].fset is not None, name


@pytest.mark.parametrize("api", API.values(), ids=lambda api: api.name)
def test_there_is_no_name_that_a_program_could_only_use_here(api: Api) -> None:
    known = {
        name
        for base in ours(api.name).__mro__
        if base.__name__ in API
        for name in API[base.__name__].everything
    }
    found = names_of(ours(api.name))
    extra = set(found) - known - {"PARAM_REL_TOL"}
    assert not {name for name in extra if not name.startswith("_") or api.name in DERIVED_FROM}


HEAD = """
import rclpy
from geometry_msgs.msg import Twist
from std_srvs.srv import Trigger
from rclpy.node import Node
rclpy.init()
class Made(Node):
    def __init__(self):
        super().__init__("made")
        self.pub = self.create_publisher(Twist, "cmd_vel", 10)
        self.sub = self.create_subscription(Twist, "a", print, 10)
        self.clock_tick = self.create_timer(1.0, lambda: None)
        self.cli = self.create_client(Trigger, "b")
        self.srv = self.create_service(Trigger, "b", lambda q, a: a)
        self.guard = self.create_guard_condition(lambda: None)
"""


def run(server: WarmServer, source: str) -> ProgramRehearsal:
    return rehearse_program(server, HEAD + dedent(source), load_profile("wheeltec_mini_mec"))


def test_instances_keep_nothing_under_a_name_that_a_program_may_take(server: WarmServer) -> None:
    source = """
    made = Made()
    for name in ("made", "pub", "sub", "clock_tick", "cli", "srv", "guard"):
        entity = made if name == "made" else getattr(made, name)
        kinds = [kind.__name__ for kind in type(entity).__mro__]
        kept = [n for n in vars(entity) if not any(n.startswith(f"_{kind}__") for kind in kinds)]
        print(kinds[1] if name == "made" else kinds[0], *kept)
    """
    rehearsal = run(server, source)
    assert isinstance(rehearsal.end, Ended), rehearsal.end
    lines = "\n".join(entry.text for entry in rehearsal.log).splitlines()
    assert len(lines) == 7
    for line in lines:
        name, *kept = line.split()
        own = {"pub", "sub", "clock_tick", "cli", "srv", "guard"} if name == "Node" else set()
        assert set(kept) - own <= API[name].everything, name


def _fails(server: WarmServer, members: str) -> Raised:
    source = f"class Mine(Made):\n{indent(dedent(members), '    ')}\nMine()\n"
    end = run(server, source).end
    assert isinstance(end, Raised), f"{members}: {end}"
    return end


@pytest.mark.skipif(
    sys.version_info < (3, 11), reason="Python 3.10 calls it an AttributeError, under ROS too"
)
def test_a_method_named_handle_fails_in_the_constructor(server: WarmServer) -> None:
    end = _fails(server, "def handle(self): pass")
    assert (end.type_name, "context manager" in end.message) == ("TypeError", True)


@pytest.mark.parametrize(
    "members",
    [
        "def create_publisher(self): pass",
        "def declare_parameter(self): pass",
        "def declare_parameters(self): pass",
        "def has_parameter(self): pass",
        "def resolve_topic_name(self): pass",
    ],
)
def test_a_method_that_the_constructor_calls_fails_there_if_it_takes_something_else(
    server: WarmServer, members: str
) -> None:
    assert _fails(server, members).type_name == "TypeError"


@pytest.mark.parametrize("name", ["timers", "subscriptions", "clients", "services", "guards"])
def test_a_method_that_hides_what_an_executor_looks_through_fails_there(
    server: WarmServer, name: str
) -> None:
    end = run(server, f"class Mine(Made):\n    def {name}(self): pass\nrclpy.spin_once(Mine())\n").end
    assert isinstance(end, Raised)
    assert (end.type_name, "not iterable" in end.message) == ("TypeError", True)


@pytest.mark.parametrize(
    "attribute",
    [*sorted(API["Node"].read_only), "pub.topic_name", "pub.handle", "sub.topic_name", "sub.handle", "cli.service_name",
     "srv.service_name", "clock_tick.clock", "clock_tick.handle", "guard.handle"],
)  # fmt: skip
def test_what_is_read_only_cannot_be_set(server: WarmServer, attribute: str) -> None:
    end = run(server, f"made = Made()\nmade.{attribute} = None\n").end
    assert isinstance(end, Raised)
    assert end.type_name == "AttributeError"


def test_names_that_rclpy_leaves_free_belong_to_the_program(server: WarmServer) -> None:
    """The class of defect: an attribute of the program took the place of one of ours."""
    source = """
    class Mine(Made):
        def __init__(self):
            self._name = self._namespace = self._executor = self._overrides = self._rates = "mine"
            self._is_destroyed = True
            super().__init__()
            self._name = self._namespace = self._executor = self._overrides = self._rates = "mine"
            self._on_set = self._post_set = self._is_destroyed = "mine"
        def _add(self): raise RuntimeError
        def _group(self): raise RuntimeError
        def _problem(self): raise RuntimeError
        def _check_context(self): raise RuntimeError
    mine = Mine()
    mine.create_rate(1)
    print(mine.declare_parameter("a", 1).value, mine.get_name(), mine.get_namespace())
    mine.create_timer(0.1, lambda: print("tick"))
    rclpy.spin_once(mine)
    mine.destroy_node()
    """
    rehearsal = run(server, source)
    assert isinstance(rehearsal.end, Ended), rehearsal.end
    assert "\n".join(entry.text for entry in rehearsal.log).splitlines() == ["1 made /", "tick"]


@pytest.mark.parametrize(
    ("statement", "printed"),
    [
        ("print([p.topic_name for p in made.publishers])", "['/parameter_events', '/cmd_vel']"),
        ("print(made.list_parameters([], 0).names)", "['use_sim_time', 'start_type_description_service']"),
        ("made.declare_parameter('p.q', 1); print(made.list_parameters(['p'], 0).names)", "['p.q']"),
        ("print(made.count_clients('b'), made.count_services('b'))", "1 1"),
        ("print(made.get_fully_qualified_node_names())", "['/made']"),
        (
            "print(made.get_publisher_names_and_types_by_node('made', '/')[0])",
            "('/cmd_vel', ['geometry_msgs/msg/Twist'])",
        ),
        ("print([i.node_name for i in made.get_subscriptions_info_by_topic('a')])", "['made']"),
        ("print(made.wait_for_node('/nobody', 0.2))", "False"),
        ("made.add_waitable(1); print(list(made.waitables))", "[1]"),
    ],
)
def test_what_a_node_knows(server: WarmServer, statement: str, printed: str) -> None:
    rehearsal = run(server, f"made = Made()\n{statement}\n")
    assert isinstance(rehearsal.end, Ended), rehearsal.end
    assert "".join(entry.text for entry in rehearsal.log).strip() == printed


@pytest.mark.parametrize(
    ("statement", "message"),
    [
        ("made.create_subscription(Twist, 'a', print)", "Node.create_subscription() missing 1 required"),
        ("made.declare_parameter()", "Node.declare_parameter() missing 1 required"),
        ("made.declare_parameter(5, 1)", "First element 5 at index 0 in parameters list is not a str."),
    ],
)
def test_a_complaint_names_what_rclpy_names(server: WarmServer, statement: str, message: str) -> None:
    end = run(server, f"made = Made()\n{statement}\n").end
    assert isinstance(end, Raised)
    assert (end.type_name, message in end.message) == ("TypeError", True)


def test_a_callback_that_takes_no_message_is_refused_when_it_is_given(server: WarmServer) -> None:
    end = run(server, "Made().create_subscription(Twist, 'c', lambda: None, 10)\n").end
    assert isinstance(end, Raised)
    assert (end.type_name, "callable with one argument" in end.message) == ("RuntimeError", True)
