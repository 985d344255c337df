"""Imported by the warm server: everything that a program may import of ours."""

from chatrobot.programs.inside import entry

entry.preload()
