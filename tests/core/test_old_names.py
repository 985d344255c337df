"""What a program of the last release imports from the documented places is still there."""

from __future__ import annotations

from chatrobot.core import errors


def test_errors_are_caught_by_the_names_they_had() -> None:
    assert errors.JointError is errors.LinkError
    assert errors.BoxError is errors.SandboxError
