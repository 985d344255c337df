"""docs/trace.md names what there is, where it is."""

from __future__ import annotations

import ast
import re
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
PAGE = (ROOT / "docs" / "trace.md").read_text(encoding="utf-8")
FILES = {
    name: file
    for names, file in re.findall(r"^\| (`.+`) \| `(.+\.py)` \|$", PAGE, re.MULTILINE)
    for name in re.findall(r"`(\w+)`", names)
}
METHODS = sorted(set(re.findall(r"`([A-Z]\w+)\.(\w+)`", PAGE)))


def defined(file: str) -> dict[str, set[str]]:
    """The classes of a file with their methods, and its functions with none."""
    tree = ast.parse((ROOT / "src" / "chatrobot" / file).read_text(encoding="utf-8"))
    return {
        node.name: {each.name for each in ast.walk(node) if isinstance(each, ast.FunctionDef)}
        for node in tree.body
        if isinstance(node, (ast.ClassDef, ast.FunctionDef))
    }


@pytest.mark.parametrize(("name", "file"), list(FILES.items()), ids=list(FILES))
def test_a_name_is_where_the_table_says(name: str, file: str) -> None:
    assert name in defined(file)


@pytest.mark.parametrize(("owner", "method"), METHODS, ids=[".".join(each) for each in METHODS])
def test_a_step_of_the_trace_is_a_method_that_there_is(owner: str, method: str) -> None:
    assert method in defined(FILES[owner])[owner]


def test_every_class_of_the_text_is_in_the_table() -> None:
    text = PAGE.split("## Where they are")[0]
    assert not set(re.findall(r"`([A-Z][A-Za-z]+)[.`]", text)) - set(FILES)
    assert len(METHODS) > 10
