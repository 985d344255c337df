"""The house keeps its floors: imports go down only, and three names stay where they belong."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import NamedTuple

import pytest

SOURCE = Path(__file__).parent.parent / "src"
LEVELS = {
    "core": 0, "reflex": 0, "options": 0,
    "robots": 1, "wire": 1,
    "sim": 2,
    "plan": 3, "sandbox": 3,
    "language": 4, "models": 4, "execution": 4, "governor": 4, "programs": 4,
    "link": 5, "lessons": 5, "recording": 5,
    "motion": 6, "dialogue": 6,
    "link.in_process": 7,
    "compose": 8,
    "nodes": 9, "web": 9, "mcp_server": 9,
    "cli": 10, "api": 10,
    "__init__": 11, "__main__": 11,
    "testing": 11,
}  # fmt: skip
BESIDE = {"guard": {"core", "wire"}}
"""Packages that stand beside the levels: what each may import. Of the levels, motion alone knows them."""


class Import(NamedTuple):
    """One import, wherever in the file it stands (inside functions too)."""

    importer: str
    line: int
    module: str
    names: tuple[str, ...]
    at_start: bool

    @property
    def where(self) -> str:
        return f"{self.importer}:{self.line} imports {self.module}"


def module_name(file: Path) -> str:
    parts = file.relative_to(SOURCE).with_suffix("").parts
    return ".".join(parts[:-1] if parts[-1] == "__init__" and len(parts) > 2 else parts)


@cache
def modules() -> dict[str, ast.Module]:
    files = sorted((SOURCE / "chatrobot").rglob("*.py"))
    return {module_name(file): ast.parse(file.read_text(encoding="utf-8")) for file in files}


def package(module: str) -> str:
    """The level of a module: `chatrobot.sim.robot` is on `sim`. The in-process link, which sees Motion, has its own."""
    inner = module.removeprefix("chatrobot.")
    return inner if inner in LEVELS else [*module.split("."), "__init__"][1]


@cache
def imports() -> tuple[Import, ...]:
    return tuple(found for name, tree in modules().items() for found in _imports(name, tree))


def _imports(importer: str, tree: ast.Module) -> Iterator[Import]:
    """`at_start` is true for what runs when the module is imported: not for types alone, nor late in a function."""
    late = {
        id(inner)
        for node in ast.walk(tree)
        if isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef))
        or (isinstance(node, ast.If) and "TYPE_CHECKING" in ast.dump(node.test))
        for inner in ast.walk(node)
    }
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            for alias in node.names:
                yield Import(importer, node.lineno, alias.name, (), id(node) not in late)
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"{importer}:{node.lineno}: imports are absolute here"
            names = tuple(alias.name for alias in node.names)
            yield Import(importer, node.lineno, node.module or "", names, id(node) not in late)


def targets(found: Import) -> Iterator[str]:
    """The modules of ours that one import reaches: `from chatrobot.cli import stop` reaches chatrobot.cli.stop."""
    if found.module.split(".")[0] != "chatrobot":
        return
    submodules = [f"{found.module}.{name}" for name in found.names if f"{found.module}.{name}" in modules()]
    if len(submodules) < len(found.names) or not found.names:
        yield found.module
    yield from submodules


def test_every_package_has_a_floor() -> None:
    assert {package(name) for name in modules()} <= {*LEVELS, *BESIDE}


def test_imports_go_down_only() -> None:
    wrong = []
    for found in imports():
        importer = package(found.importer)
        for target in targets(found):
            imported = package(target)
            if imported == importer or (imported == "__init__" and found.names == ("__version__",)):
                continue
            if importer in BESIDE:
                allowed = imported in BESIDE[importer]
            elif imported in BESIDE:
                allowed = importer == "motion"
            else:
                allowed = LEVELS[imported] < LEVELS[importer]
            if not allowed:
                wrong.append(found.where)
    assert not wrong


def test_no_module_imports_itself_in_a_circle() -> None:
    graph: dict[str, set[str]] = {name: set() for name in modules()}
    for found in imports():
        if found.at_start:
            graph[found.importer].update(target for target in targets(found) if target in graph)
    done: set[str] = set()

    def visit(name: str, path: tuple[str, ...]) -> None:
        assert name not in path, " → ".join((*path[path.index(name) :], name))
        if name not in done:
            for target in sorted(graph[name]):
                visit(target, (*path, name))
            done.add(name)

    for name in graph:
        visit(name, ())


@pytest.mark.parametrize("half", ["dialogue", "link", "motion"])
def test_a_package_itself_imports_nothing(half: str) -> None:
    assert not [found for found in imports() if found.importer == f"chatrobot.{half}"]


@pytest.mark.parametrize(
    ("half", "unknown"),
    [
        ("motion", {"dialogue", "language", "models"}),
        ("dialogue", {"motion"}),
        ("link", {"dialogue", "language"}),
    ],
)
def test_neither_half_reaches_the_other(half: str, unknown: set[str]) -> None:
    """By whatever way: nothing that it imports, at the start or late, leads there."""
    reached = {name for name in modules() if package(name) == half}
    waiting = list(reached)
    while waiting:
        importer = waiting.pop()
        for found in imports():
            if found.importer == importer:
                new = {*targets(found)} - reached
                reached |= new
                waiting += new
    assert not {name for name in reached if package(name) in unknown}


def test_only_the_governor_mints_velocities() -> None:
    users = {package(found.importer) for found in imports() if "Mint" in found.names or "*" in found.names}
    assert users == {"governor"}
    for name, tree in modules().items():
        if package(name) not in ("governor", "core"):
            assert "Mint" not in {node.attr for node in ast.walk(tree) if isinstance(node, ast.Attribute)}, (
                name
            )


def test_only_the_test_kit_knows_pytest() -> None:
    assert {package(found.importer) for found in imports() if found.module.startswith("pytest")} == {
        "testing"
    }


@pytest.mark.parametrize("secret", ["TRUTH_TOPIC", "chatrobot/sim/truth"])
def test_only_the_simulation_and_those_who_show_it_know_the_truth(secret: str) -> None:
    for file in sorted((SOURCE / "chatrobot").rglob("*.py")):
        floor = package(module_name(file))
        if floor not in ("sim", "compose", "cli"):
            assert secret not in file.read_text(encoding="utf-8"), file.name


EXTRAS = ("chatrobot.wire.dds.", "chatrobot.wire.ros.", "chatrobot.wire.rosbridge.")
"""Backends that are installed apart, and loaded only by who names them in a wire's address."""


def test_the_light_packages_need_nothing_but_python() -> None:
    """Stop, guard and every start-up stand on these."""
    light = ("core", "reflex", "wire", "guard")
    allowed = {"chatrobot", *__import__("sys").stdlib_module_names}
    wrong = [
        found.where
        for found in imports()
        if package(found.importer) in light
        and (
            found.module.split(".")[0] not in allowed or (found.at_start and found.module.startswith(EXTRAS))
        )
        and not found.importer.startswith(EXTRAS)
    ]
    assert not wrong
