"""The figures of the house: how far a reader has to go, and how long the pieces are.

python -m scripts.house            print them, beside what tests/house.json holds
python -m scripts.house --files    also the files entered from say to the first velocity
python -m scripts.house --units    also the numbers whose name has no unit, the most frequent first
python -m scripts.house --write    hold them from now on (tests/test_house.py refuses what is worse)

Everything that is shipped is source, chatrobot.testing too; the language is left out but for cycles.
"""

from __future__ import annotations

import ast
import json
import os
import re
import statistics
import subprocess
import sys
from collections.abc import Iterator
from functools import cache
from pathlib import Path

ROOT = Path(__file__).parent.parent
SOURCE = ROOT / "src" / "chatrobot"
HELD = ROOT / "tests" / "house.json"
LONGEST_FILE, LONGEST_FUNCTION, TINY = 350, 40, 45
MORE_IS_BETTER = {
    "public docstrings, percent",
    "numbers with a unit or without a dimension, percent",
}
"""All other figures are better when they are smaller."""
UNITS = "s ms us ns sec hz m mm m2 mps mps2 mps3 rad radps radps2 radps3 deg degps px percent bytes kb mb usd"
DIMENSIONLESS = """
turn number index i j k id pid pidfd fd descriptor port signal code status version sequence epoch seed line column row
position mask flags opcode sign count depth steps times tokens rows columns cells beams calls rounds motions chars
threads tasks descriptors decimals ratio share fraction factor divisor scale weight
"""
"""What numbers a thing, counts things, or is a part of one."""
OF_ANY_UNIT = "value low high least most"
"""For helpers whose caller has the unit."""

WALK = """
import sys, threading
from chatrobot.api import connect
from chatrobot.motion.safety.stop import WireTransport

entered, functions, moved = set(), set(), []

def note(frame, event, _argument):
    code = frame.f_code
    if event == "call" and not moved and "/chatrobot/" in code.co_filename:
        entered.add(code.co_filename)
        functions.add((code.co_filename, code.co_firstlineno))

send = WireTransport.send

def sending(self, twist):
    if any(twist.twist) and not moved:
        moved.append(True)
    return send(self, twist)

with connect(on="sim", fast=True) as robot:
    WireTransport.send = sending
    threading.setprofile(note)
    sys.setprofile(note)
    robot.do("forward 0.5 m")
    sys.setprofile(None)
assert moved, "the robot did not move"
outside = {name for name in entered if "/chatrobot/language/" not in name}
print(len(outside), sum("/chatrobot/language/" not in name for name, _ in functions))
print(*sorted(name.rpartition("/chatrobot/")[2] for name in outside), sep="\\n")
"""


def figures() -> dict[str, float]:
    """Every figure by its name."""
    trees = parsed()
    graph = {_module(file): set(_loaded(tree)) for file, tree in trees.items()}
    lines = {file: len(file.read_text(encoding="utf-8").splitlines()) for file in trees}
    outside = {file: count for file, count in lines.items() if not _is_language(file)}
    pieces = [count for file, count in outside.items() if file.name != "__init__.py"]
    functions = [f for file in outside for f in _functions(trees[file])]
    documented = [bool(d) for file in outside for d in _public(file, trees[file])]
    files, calls = walk()[:2]
    numbers = list(_numbers(trees))
    excepts = [
        has_reason
        for file in outside
        for has_reason in broad_excepts(file.read_text(encoding="utf-8"), trees[file])
    ]
    return {
        "import cycles": len(cycles(graph)),
        "late imports that would close a cycle": late_imports(trees, graph),
        "files entered from say to the first velocity": files,
        "functions entered from say to the first velocity": calls,
        "median lines of a file": statistics.median(pieces),
        f"files over {LONGEST_FILE} lines": sum(count > LONGEST_FILE for count in outside.values()),
        f"files of at most {TINY} lines": sum(count <= TINY for count in pieces),
        "files": len(pieces),
        f"functions over {LONGEST_FUNCTION} lines": sum(_length(f) > LONGEST_FUNCTION for f in functions),
        "public docstrings, percent": round(100.0 * sum(documented) / len(documented), 1),
        "numbers with a unit or without a dimension, percent": round(
            100.0 * sum(says_unit(name) for name, _ in numbers) / len(numbers), 1
        ),
        "broad excepts per 1000 lines": round(1000.0 * len(excepts) / sum(outside.values()), 2),
        "broad excepts without a reason": excepts.count(False),
        "source lines": sum(outside.values()),
    }


@cache
def parsed() -> dict[Path, ast.Module]:
    """Every file of the source, parsed once."""
    return {file: ast.parse(file.read_text(encoding="utf-8")) for file in sorted(SOURCE.rglob("*.py"))}


@cache
def _nodes(tree: ast.Module) -> tuple[ast.AST, ...]:
    """Every node of a file, walked once: most of what the figures take is walking."""
    return tuple(ast.walk(tree))


def says_unit(name: str) -> bool:
    """Return whether the last word of a number's name is its unit, or says that it has none; but for `steps_done`."""
    last = re.sub("_(done|before)$", "", name.lower().strip("_")).rpartition("_")[2]
    return last in f"{UNITS} {DIMENSIONLESS} {OF_ANY_UNIT}".split()


def _numbers(trees: dict[Path, ast.Module]) -> Iterator[tuple[str, str]]:
    """The fields and parameters that are annotated as numbers, each with its place. ROS's own names are not ours."""
    for file, tree in trees.items():
        if _is_language(file) or _is_of_ros(file):
            continue
        for node in _nodes(tree):
            if isinstance(node, ast.arg) and _is_number(node.annotation):
                yield node.arg, f"{file.relative_to(SOURCE)}:{node.lineno}"
            elif isinstance(node, ast.AnnAssign) and _is_number(node.annotation):
                target = node.target
                if isinstance(target, ast.Attribute):
                    yield target.attr, f"{file.relative_to(SOURCE)}:{node.lineno}"
            elif isinstance(node, ast.ClassDef):
                for field in node.body:
                    if isinstance(field, ast.AnnAssign) and _is_number(field.annotation):
                        yield ast.unparse(field.target), f"{file.relative_to(SOURCE)}:{field.lineno}"


def _is_number(annotation: ast.expr | None) -> bool:
    """`float`, `int`, either or none, and these as class variables."""
    written = ast.unparse(annotation) if annotation else ""
    kinds = set(re.sub(r"^(?:ClassVar|Final)\[(.*)\]$", r"\1", written).split(" | "))
    return bool(kinds & {"float", "int"}) and kinds <= {"float", "int", "None"}


def broad_excepts(source: str, tree: ast.Module) -> Iterator[bool]:
    """Yield for each except that catches everything whether a comment on its line or above says why."""
    lines = source.splitlines()
    for node in _nodes(tree):
        if isinstance(node, ast.ExceptHandler):
            caught = node.type.elts if isinstance(node.type, ast.Tuple) else [node.type]
            if any(kind is None or ast.unparse(kind) in ("Exception", "BaseException") for kind in caught):
                comment = lines[node.lineno - 1].partition("#")[2]
                above = lines[node.lineno - 2].strip()
                said = re.sub(r"noqa(: \w+)?|\W", "", comment) or above.startswith("#")
                yield bool(said)


def walk() -> tuple[int, int, list[str]]:
    """Files and functions outside the language that `do("forward 0.5 m")` enters before the first velocity."""
    done = subprocess.run(
        [sys.executable, "-c", WALK],
        capture_output=True,
        text=True,
        check=True,
        cwd=ROOT,
        env={**os.environ, "PYTHONPATH": str(SOURCE.parent)},
    )
    counts, *names = done.stdout.split("\n")
    files, functions = map(int, counts.split())
    return files, functions, [name for name in names if name]


def cycles(graph: dict[str, set[str]]) -> list[list[str]]:
    """Groups of modules that reach each other by what they import when they are loaded."""
    reached = {name: _reached(name, graph) for name in graph}
    groups = {
        tuple(sorted(other for other in graph if other in reached[name] and name in reached[other]))
        for name in graph
        if name in reached[name]
    }
    return [list(group) for group in sorted(groups)]


def _reached(name: str, graph: dict[str, set[str]]) -> set[str]:
    found: set[str] = set()
    waiting = [name]
    while waiting:
        new = (graph.get(waiting.pop(), set()) & graph.keys()) - found
        found |= new
        waiting += new
    return found


def _module(file: Path) -> str:
    return ".".join(file.relative_to(SOURCE.parent).with_suffix("").parts).removesuffix(".__init__")


def _is_language(file: Path) -> bool:
    return SOURCE / "language" in file.parents


def _is_of_ros(file: Path) -> bool:
    """Whether it bears the names of ROS's own, which are documented there."""
    return SOURCE / "programs" / "names" in file.parents


def _loaded(tree: ast.Module) -> Iterator[str]:
    """The modules that the body of a module imports, but for those that only the type checker sees."""
    waiting: list[ast.AST] = [*tree.body]
    while waiting:
        node = waiting.pop()
        if isinstance(node, ast.ImportFrom) and node.module:
            for alias in node.names:
                whole = f"{node.module}.{alias.name}"
                is_module = (SOURCE.parent / (whole.replace(".", "/") + ".py")).is_file()
                yield whole if is_module else node.module
        elif isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif not isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef)) and not _is_for_types(node):
            waiting += ast.iter_child_nodes(node)


def _is_for_types(node: ast.AST) -> bool:
    return isinstance(node, ast.If) and "TYPE_CHECKING" in ast.unparse(node.test)


def late_imports(trees: dict[Path, ast.Module], graph: dict[str, set[str]]) -> int:
    """Imports inside functions that could not stand at the top: their module imports this one."""
    late = 0
    for file, tree in trees.items():
        for function in _functions(tree):
            for target in _loaded(ast.Module([*function.body], [])):
                late += target != _module(file) and _module(file) in _reached(target, graph)
    return late


def _functions(tree: ast.Module) -> Iterator[ast.FunctionDef | ast.AsyncFunctionDef]:
    for node in _nodes(tree):
        if isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef)):
            yield node


def _length(function: ast.FunctionDef | ast.AsyncFunctionDef) -> int:
    """Its lines without its docstring."""
    first = function.body[0]
    is_doc = isinstance(first, ast.Expr) and isinstance(first.value, ast.Constant)
    doc = (first.end_lineno or 0) - first.lineno + 1 if is_doc and ast.get_docstring(function) else 0
    return (function.end_lineno or 0) - function.lineno + 1 - doc


def _public(file: Path, tree: ast.Module) -> Iterator[str | None]:
    """The docstrings of what others may use: the module, its public classes and functions, their public methods.

    A module that bears the names of ROS's own is documented there; a test's name says what it asks. A method that does
    what a base class says has the docstring of that one, as `help` shows it.
    """
    if _is_of_ros(file):
        return
    if tree.body:
        yield ast.get_docstring(tree)
    for node in tree.body:
        if isinstance(node, (ast.FunctionDef, ast.ClassDef)) and not node.name.startswith("_"):
            yield ast.get_docstring(node)
            for inner in node.body if isinstance(node, ast.ClassDef) else ():
                if isinstance(inner, ast.FunctionDef) and not inner.name.startswith(("_", "test_")):
                    yield ast.get_docstring(inner) or _inherited(inner.name, node)


@cache
def _classes() -> dict[str, ast.ClassDef]:
    """The classes by their names; of two with one name, either."""
    return {
        node.name: node for tree in parsed().values() for node in tree.body if isinstance(node, ast.ClassDef)
    }


def _inherited(method: str, owner: ast.ClassDef) -> str | None:
    """The docstring that a method has from a base class."""
    for base in owner.bases:
        above = _classes().get(ast.unparse(base).partition("[")[0])
        if above is None or above is owner:
            continue
        own = next((n for n in above.body if isinstance(n, ast.FunctionDef) and n.name == method), None)
        found = (ast.get_docstring(own) if own is not None else None) or _inherited(method, above)
        if found:
            return found
    return None


def worse(now: dict[str, float], held: dict[str, float]) -> list[str]:
    """Those figures that are worse than they were, each as a sentence."""
    return [
        f"{name}: {now.get(name)}, was {was}"
        for name, was in held.items()
        if name not in now or ((now[name] < was) if name in MORE_IS_BETTER else (now[name] > was))
    ]


def _print_units() -> None:
    places: dict[str, list[str]] = {}
    for name, place in _numbers(parsed()):
        if not says_unit(name):
            places.setdefault(name, []).append(place)
    for name, found in sorted(places.items(), key=lambda item: -len(item[1])):
        print(f"{len(found):4d} {name:24s} {' '.join(found[:4])}")


def main() -> None:
    now = figures()
    held = json.loads(HELD.read_text(encoding="utf-8")) if HELD.is_file() else {}
    for name, value in now.items():
        print(f"{name:52s} {value:>8g}   {'' if name not in held else f'held: {held[name]:g}'}")
    if "--files" in sys.argv:
        print(*walk()[2], sep="\n")
    if "--units" in sys.argv:
        _print_units()
    if "--write" in sys.argv:
        HELD.write_text(json.dumps(now, indent=2) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
