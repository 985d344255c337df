"""ROS names: which are allowed, and what a relative one means.

Rules: design.ros2.org/articles/topic_and_service_names.
"""

from __future__ import annotations

import re
from collections.abc import Mapping

_SUBSTITUTION = re.compile(r"\{(\w*)\}")


def node_name_problem(name: str) -> tuple[str, int] | None:
    """What is wrong with a node's name and where; None where nothing is."""
    if not name:
        return "node name must not be empty", 0
    if name[0].isdigit():
        return "node name must not start with a number", 0
    return _bad_character("node name", name, "")


def topic_name_problem(name: str) -> tuple[str, int] | None:
    """What is wrong with a topic's or service's name as a program writes it, and where."""
    if not name:
        return "topic name must not be empty string", 0
    if name.endswith("/"):
        return "topic name must not end with a forward slash", len(name) - 1
    bad = _bad_character("topic name", name, "/~{}")
    if bad is not None:
        return bad
    if "~" in name[1:]:
        return "topic name must not have tilde '~' unless it is the first character", name.index("~", 1)
    if "//" in name:
        return "topic name must not contain repeated '/'", name.index("//") + 1
    at = 0
    for token in name.split("/"):
        if token[:1].isdigit():
            return "topic name token must not start with a number", at
        at += len(token) + 1
    return None


def namespace_problem(namespace: str) -> tuple[str, int] | None:
    if not namespace.startswith("/"):
        return "namespace must be absolute, it must lead with a '/'", 0
    problem = None if namespace == "/" else topic_name_problem(namespace)
    if problem is None:
        return None
    words = problem[0].replace(
        "topic name token must not start", "namespace must not have a token that starts"
    )
    return words.replace("topic name", "namespace").replace("'_', '~', '{', or '}'", "'_', or '/'"), problem[
        1
    ]


def resolve(name: str, node_name: str, namespace: str, remaps: Mapping[str, str]) -> str:
    """The full name, after remapping (by the written or by the full name)."""
    full = _expand(name, node_name, namespace)
    for source, target in remaps.items():
        if source == name or _expand(source, node_name, namespace) == full:
            return _expand(target, node_name, namespace)
    return full


def _expand(name: str, node_name: str, namespace: str) -> str:
    base = namespace.rstrip("/")
    name = _SUBSTITUTION.sub(lambda found: _substitute(name, found.group(1), node_name, base), name)
    if name.startswith("/"):
        return name
    if name.startswith("~"):
        return f"{base}/{node_name}{name[1:]}"
    return f"{base}/{name}"


def _substitute(name: str, word: str, node_name: str, namespace: str) -> str:
    values = {"node": node_name, "ns": namespace, "namespace": namespace}
    if word not in values:
        raise ValueError(f"topic name '{name}' is invalid: unknown substitution: {{{word}}}")
    return values[word].lstrip("/")


def _bad_character(what: str, name: str, also: str) -> tuple[str, int] | None:
    others = ", '_', '~', '{', or '}'" if also else " or '_'"
    for at, letter in enumerate(name):
        if not (letter.isascii() and (letter.isalnum() or letter == "_" or letter in also)):
            return f"{what} must not contain characters other than alphanumerics{others}", at
    return None
