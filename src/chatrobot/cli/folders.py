"""Where a person's settings live."""

from __future__ import annotations

import argparse
from pathlib import Path


def config_folder(args: argparse.Namespace) -> Path:
    """Where places and robot profiles live: `--config-dir`, or the user's configuration folder."""
    if args.config_dir is not None:
        return Path(args.config_dir).expanduser()
    from platformdirs import user_config_path

    return user_config_path("chatrobot")


def profile_folders(args: argparse.Namespace) -> tuple[Path, ...]:
    """Where a person's own robot profiles live."""
    return (config_folder(args) / "robots",)
