"""Every test of the command line has the command."""

from tests.cli.running import chatrobot

__all__ = ["chatrobot"]
