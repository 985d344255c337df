"""The filter's decisions, read by an interpreter of its language: for this machine and for the others."""

from __future__ import annotations

import re
import struct
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from chatrobot.sandbox.seccomp import (
    ALLOW,
    INSTRUCTION,
    KILL_PROCESS,
    NOT_THERE,
    REFUSE,
    RULES,
    Filter,
    assemble,
)
from chatrobot.sandbox.syscalls import AARCH64, NEWEST, X86_64, Machine

MACHINES = [X86_64, AARCH64]
PID = 4711
PROGRAMS = {machine.name: Filter(machine).for_process(PID) for machine in MACHINES}
WORDS = st.integers(0, 2**64 - 1)


def decide(machine: Machine, name_or_number: str | int, *arguments: int, arch: int | None = None) -> int:
    """What the kernel would answer, or an AssertionError where it would not take the filter."""
    number = machine.numbers[name_or_number] if isinstance(name_or_number, str) else name_or_number
    padded = (*arguments, 0, 0, 0, 0, 0, 0)[:6]
    data = struct.pack("=IIQ6Q", number, arch or machine.audit_arch, 0, *padded)
    code = list(INSTRUCTION.iter_unpack(PROGRAMS[machine.name]))
    assert len(code) <= 4096
    place, accumulator = 0, 0
    while True:
        operation, if_true, if_false, operand = code[place]
        place += 1
        if operation == 0x20:
            (accumulator,) = struct.unpack_from("=I", data, operand)
        elif operation == 0x54:
            accumulator &= operand
        elif operation in (0x15, 0x35):
            holds = accumulator == operand if operation == 0x15 else accumulator >= operand
            place += if_true if holds else if_false
        else:
            assert operation == 0x06
            return int(operand)


@pytest.fixture(params=MACHINES, ids=lambda machine: machine.name)
def machine(request: pytest.FixtureRequest) -> Machine:
    return request.param  # type: ignore[no-any-return]


def test_what_is_not_named_is_refused(machine: Machine) -> None:
    named = {machine.numbers[name] for rule in RULES for name in rule.names if name in machine.numbers}
    for number in range(NEWEST):
        if number not in named:
            assert decide(machine, number) == REFUSE, number
    for number in (NEWEST, 500, 9999, 0x3FFFFFFF):
        assert decide(machine, number) == NOT_THERE


def test_nothing_opens_connects_or_starts(machine: Machine) -> None:
    unnamed = {"x86_64": (2, 257, 437, 42, 43, 49, 50, 41, 46, 47, 57, 58, 59, 322, 72 + 1000),
               "aarch64": (56, 437, 203, 202, 200, 201, 198, 211, 212, 221, 281)}  # fmt: skip
    for number in unnamed[machine.name]:
        assert decide(machine, number, 0, 0, 0) in (REFUSE, NOT_THERE)


def test_another_kind_of_machine_kills(machine: Machine) -> None:
    other = AARCH64 if machine is X86_64 else X86_64
    assert decide(machine, "read", arch=other.audit_arch) == KILL_PROCESS
    assert decide(machine, "read", arch=0x40000003) == KILL_PROCESS


def test_the_second_set_of_calls_of_x86_64_kills() -> None:
    for number in (0, 1, 39, 512, 545):
        assert decide(X86_64, 0x40000000 | number) == KILL_PROCESS


@given(WORDS, WORDS, WORDS)
def test_no_memory_is_ever_runnable(address: int, protection: int, flags: int) -> None:
    for machine in MACHINES:
        runnable = protection | 4
        assert decide(machine, "mmap", address, 4096, runnable, flags, 2**64 - 1, 0) == REFUSE
        assert decide(machine, "mprotect", address, 4096, runnable) == REFUSE
        assert decide(machine, "mmap", address, 4096, 3, flags & ~0x20, 3, 0) == REFUSE
        assert decide(machine, "mmap", 0, 4096, 3, 0x22, 2**64 - 1, 0) == ALLOW


@given(WORDS)
def test_only_threads_are_cloned(flags: int) -> None:
    for machine in MACHINES:
        expected = ALLOW if flags in (0x3D0F00, 0x7D0F00) else REFUSE
        assert decide(machine, "clone", flags) == expected
        assert decide(machine, "clone", 0x3D0F00 | 1 << 32) == REFUSE
        assert decide(machine, "clone3", flags) == NOT_THERE


@given(WORDS, st.sampled_from(["kill", "tgkill"]))
def test_signals_reach_oneself_only(pid: int, call: str) -> None:
    for machine in MACHINES:
        assert decide(machine, call, pid, 9) == (ALLOW if pid == PID else REFUSE)
        assert decide(machine, call, PID, 9) == ALLOW


@given(st.integers(1, 2**64 - 1))
def test_nobody_is_addressed(address: int) -> None:
    for machine in MACHINES:
        assert decide(machine, "sendto", 3, 0, 0, 0, address, 0) == REFUSE
        assert decide(machine, "sendto", 3, 0, 0, 0x4000, 0, 0) == ALLOW
        assert decide(machine, "prlimit64", 0, 7, address, 0) == REFUSE


@given(WORDS)
def test_socket_pairs_are_streams_on_this_machine(kind: int) -> None:
    for machine in MACHINES:
        is_stream = kind & 0xF == 1
        assert decide(machine, "socketpair", 1, kind) == (ALLOW if is_stream else REFUSE)
        assert decide(machine, "socketpair", 2, kind) == REFUSE


@given(WORDS)
def test_descriptors_are_not_made_to_send_signals(value: int) -> None:
    for machine in MACHINES:
        for set_owner in (8, 10, 15):
            assert decide(machine, "fcntl", 3, set_owner, value) == REFUSE
        assert decide(machine, "ioctl", 3, 0x5412, value) == REFUSE  # TIOCSTI types into a terminal


def test_jumps_stay_inside(machine: Machine) -> None:
    code = list(INSTRUCTION.iter_unpack(assemble(machine, RULES)))
    for place, (operation, if_true, if_false, _) in enumerate(code):
        if operation in (0x15, 0x35):
            assert place + 1 + max(if_true, if_false) < len(code)
    assert code[-1][0] == 0x06


@pytest.mark.parametrize(
    ("machine", "header", "pattern"),
    [
        (X86_64, "/usr/include/x86_64-linux-gnu/asm/unistd_64.h", r"#define __NR_(\w+) (\d+)"),
        (AARCH64, "/usr/include/asm-generic/unistd.h", r"#define __NR(?:3264)?_(\w+)\s+(\d+)"),
    ],
    ids=["x86_64", "aarch64"],
)
def test_numbers_are_those_of_the_kernel(machine: Machine, header: str, pattern: str) -> None:
    if not Path(header).exists():
        pytest.skip("no kernel headers here")
    theirs = {name: int(number) for name, number in re.findall(pattern, Path(header).read_text())}
    ours = {name: number for name, number in machine.numbers.items() if name in theirs or number < 450}
    assert ours == {name: theirs[name] for name in ours}
    missing = {name for rule in RULES for name in rule.names} - machine.numbers.keys()
    assert not missing & theirs.keys()
