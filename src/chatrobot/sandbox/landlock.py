"""Landlock: the kernel's own wall around files, TCP ports and abstract sockets, for this process and for ever."""

from __future__ import annotations

import struct

from chatrobot.sandbox.libc import PR_SET_NO_NEW_PRIVS, prctl, system_call
from chatrobot.sandbox.syscalls import Machine

_VERSION = 1
"""The flag that asks for the version of the interface instead of making a rule set."""
_RIGHTS_OF_VERSION = {1: 13, 2: 14, 3: 15, 4: 15, 5: 16}
"""How many rights over files (bits from 0) each version knows; later ones have no more."""
_TCP_BIND_AND_CONNECT = 0b11
_SIGNALS_AND_ABSTRACT_SOCKETS = 0b11


def version(machine: Machine) -> int:
    """The version of Landlock here.

    Raises:
        OSError: this kernel has none, or it is switched off.
    """
    return system_call(machine.numbers["landlock_create_ruleset"], None, 0, _VERSION)


def restrict(machine: Machine) -> int:
    """Deny every right over files, and over TCP and signals where this kernel's Landlock knows them.

    Returns:
        The version that is in force.

    Raises:
        OSError: it cannot be had here.
    """
    found = version(machine)
    files = (1 << _RIGHTS_OF_VERSION[min(found, max(_RIGHTS_OF_VERSION))]) - 1
    attributes = struct.pack("=Q", files)
    if found >= 4:
        attributes += struct.pack("=Q", _TCP_BIND_AND_CONNECT)
    if found >= 6:
        attributes += struct.pack("=Q", _SIGNALS_AND_ABSTRACT_SOCKETS)
    rules = system_call(machine.numbers["landlock_create_ruleset"], attributes, len(attributes), 0)
    prctl(PR_SET_NO_NEW_PRIVS, 1)
    system_call(machine.numbers["landlock_restrict_self"], rules, 0)
    return found
