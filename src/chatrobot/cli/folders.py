"""Where a person's settings live."""

from __future__ import annotations

import argparse
from pathlib import Path

from chatrobot.core.errors import UsageError


def config_folder(args: argparse.Namespace) -> Path:
    """Return where places and robot profiles live: `--config-dir`, or the user's configuration folder.

    Raises:
        UsageError: it is a file.
    """
    if args.config_dir is not None:
        folder = Path(args.config_dir).expanduser()
        if folder.exists() and not folder.is_dir():
            raise UsageError(
                f"{folder} is not a folder", where="--config-dir", allowed="a folder, made if need be"
            )
        return folder
    from platformdirs import user_config_path

    return user_config_path("chatrobot")


def profile_folders(args: argparse.Namespace) -> tuple[Path, ...]:
    """Return where a person's own robot profiles live."""
    return (config_folder(args) / "robots",)
