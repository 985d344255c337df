"""Makes `rclpy`, `geometry_msgs.msg` and the others importable under their own names."""

from __future__ import annotations

import importlib
import pkgutil
import sys
from types import ModuleType

from chatrobot.programs import names

PREFIX = f"{names.__name__}."


def preload() -> list[str]:
    """Import every module of `names`, and what stands behind them: in the sandbox no file can be opened."""
    found = sorted(info.name for info in pkgutil.walk_packages(names.__path__, PREFIX))
    for name in found:
        importlib.import_module(name)
    return found


def install() -> None:
    """Give every loaded module of `names`, and the classes in it, the name that programs know."""
    loaded = {name: module for name, module in sys.modules.items() if name.startswith(PREFIX)}
    for name, module in loaded.items():
        short = name[len(PREFIX) :]
        sys.modules[short] = module
        _rename(module, short)


def _rename(module: ModuleType, short: str) -> None:
    for value in vars(module).values():
        if isinstance(value, type) and value.__module__ == module.__name__:
            value.__module__ = short
