"""An assembler for seccomp's filters: rules about numbers and arguments become a program for the kernel.

The language is classic BPF (`linux/filter.h`): a 32-bit accumulator, loads from `struct seccomp_data`, and jumps
that go forward only. Jumps reach 255 instructions; every rule is far shorter.
"""

from __future__ import annotations

import struct
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from chatrobot.sandbox.syscalls import NEWEST, Machine

KILL_PROCESS = 0x80000000
ALLOW = 0x7FFF0000
ERRNO = 0x00050000
EPERM = 1
ENOSYS = 38
REFUSE = ERRNO | EPERM
NOT_THERE = ERRNO | ENOSYS

INSTRUCTION = struct.Struct("=HBBI")
_LOAD, _JUMP_EQUAL, _JUMP_GREATER_EQUAL, _RETURN, _AND = 0x20, 0x15, 0x35, 0x06, 0x54
_NUMBER_AT, _ARCH_AT, _ARGUMENTS_AT = 0, 4, 16
_X32_BIT = 0x40000000
_LOW = 0xFFFFFFFF


@dataclass(frozen=True)
class Is:
    """Argument number `index` (from 0), all of its 64 bits, is `value`."""

    index: int
    value: int


@dataclass(frozen=True)
class Masked:
    """The low half of argument `index`, cut to the bits of `mask`, is `value`."""

    index: int
    mask: int
    value: int


Test = Is | Masked


@dataclass(frozen=True)
class Rule:
    """Calls that are answered the same way.

    Args:
        names: system calls; one that a machine does not have is left out there.
        action: what the kernel answers.
        when: any of these sets of tests must hold as a whole; empty: always.
        otherwise: the answer where none holds.
    """

    names: tuple[str, ...]
    action: int = ALLOW
    when: tuple[tuple[Test, ...], ...] = ()
    otherwise: int = REFUSE


Code = list[tuple[int, int, int, int]]


def assemble(machine: Machine, rules: Iterable[Rule], default: int = REFUSE) -> bytes:
    """The filter as an array of `struct sock_filter`.

    Calls of another machine's kind, which would have other numbers, kill.

    Args:
        machine: whose numbers to use.
        rules: the first that names a call counts.
        default: the answer to what no rule names.
    """
    code: Code = [
        (_LOAD, 0, 0, _ARCH_AT),
        (_JUMP_EQUAL, 1, 0, machine.audit_arch),
        (_RETURN, 0, 0, KILL_PROCESS),
        (_LOAD, 0, 0, _NUMBER_AT),
    ]
    if machine.name == "x86_64":
        code += [(_JUMP_GREATER_EQUAL, 0, 1, _X32_BIT), (_RETURN, 0, 0, KILL_PROCESS)]
    for rule in rules:
        for name in rule.names:
            if name in machine.numbers:
                answer = _answer(rule)
                code += [(_JUMP_EQUAL, 0, len(answer), machine.numbers[name]), *answer]
    code += [
        (_JUMP_GREATER_EQUAL, 0, 1, NEWEST),
        (_RETURN, 0, 0, NOT_THERE),
        (_RETURN, 0, 0, default),
    ]
    return b"".join(INSTRUCTION.pack(*each) for each in code)


def _answer(rule: Rule) -> Code:
    code: Code = []
    for tests in rule.when:
        code += _all_of(tests, rule.action)
    return [*code, (_RETURN, 0, 0, rule.otherwise if rule.when else rule.action)]


def _all_of(tests: Sequence[Test], action: int) -> Code:
    """Return `action` if all tests hold, else fall through behind the last instruction."""
    steps: list[tuple[tuple[int, int, int, int], bool]] = []
    for test in tests:
        low_at = _ARGUMENTS_AT + 8 * test.index
        steps.append(((_LOAD, 0, 0, low_at), False))
        if isinstance(test, Masked):
            steps.append(((_AND, 0, 0, test.mask), False))
        steps.append(((_JUMP_EQUAL, 0, 0, test.value & _LOW), True))
        if isinstance(test, Is):
            steps.append(((_LOAD, 0, 0, low_at + 4), False))
            steps.append(((_JUMP_EQUAL, 0, 0, test.value >> 32), True))
    code: Code = []
    for place, ((operation, _, _, operand), is_test) in enumerate(steps):
        to_the_end = len(steps) - place if is_test else 0
        code.append((operation, 0, to_the_end, operand))
    return [*code, (_RETURN, 0, 0, action)]
