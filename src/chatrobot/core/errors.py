"""The whole tree of errors. Being limited, refused or stopped is a value and an event, never one of these.

ChatRobotError                 something broke or was given to us broken
├── InputError                 a person can mend it: it names the place, what is wrong and what is allowed
│   ├── ProfileError           a robot profile
│   ├── WorldError             a world file
│   ├── LessonError            a lesson sheet
│   ├── PlanTextError          a line of plan text (or its JSON form)
│   ├── PlanError              a plan or a step that cannot be, made by a program; a ValueError, too
│   ├── CorpusError            a file for `chatrobot eval`
│   └── UsageError             a command-line option or an API argument
├── WireError                  the publish/subscribe layer lost its other end
├── LinkError                 Motion could not be started or does not answer
├── SandboxError                   the sandbox for programs could not be built or has fallen; carries the Reason
└── SafetyError                a rule of the safety design would be broken: never caught, always fatal
"""

from __future__ import annotations

from chatrobot.core.reason import Reason


class ChatRobotError(Exception):
    """Base of every error this project raises on purpose."""


class InputError(ChatRobotError):
    """Something a person wrote is wrong.

    Args:
        problem: what is wrong, in one sentence.
        where: file, line or option it was found at.
        allowed: what would be right there.
    """

    def __init__(self, problem: str, *, where: str = "", allowed: str = "") -> None:
        self.problem = problem
        self.where = where
        self.allowed = allowed
        text = f"{where}: {problem}" if where else problem
        super().__init__(f"{text} ({allowed})" if allowed else text)


class ProfileError(InputError):
    """A robot profile cannot be used."""


class WorldError(InputError):
    """A world file cannot be used."""


class LessonError(InputError):
    """A lesson sheet cannot be used."""


class PlanTextError(InputError):
    """A line of plan text cannot be read."""

    def __init__(self, problem: str, *, line_number: int = 0, line: str = "", allowed: str = "") -> None:
        self.line_number = line_number
        self.line = line
        where = f"line {line_number}: {line.strip()!r}" if line_number else ""
        super().__init__(problem, where=where, allowed=allowed)


class PlanError(InputError, ValueError):
    """A plan or one of its steps cannot be."""


class CorpusError(InputError):
    """A corpus file cannot be used."""


class UsageError(InputError):
    """A command or a call was put together wrongly."""


class WireError(ChatRobotError):
    """A wire is closed or its other end is gone."""


class LinkError(ChatRobotError):
    """Motion could not be started, or its process is gone."""


class SandboxError(ChatRobotError):
    """Programs cannot be sandboxed in here, or their warm server is gone.

    Args:
        reason: what a person is told.
    """

    def __init__(self, reason: Reason) -> None:
        self.reason = reason
        super().__init__(f"{reason.code} {dict(reason.values)}")


class SafetyError(ChatRobotError):
    """A safety rule would be broken by this call. There is nothing to recover: the program is wrong."""


# The names of the last release, which programs may catch.
JointError = LinkError
BoxError = SandboxError
