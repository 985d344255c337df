"""Level 0: recognises the words that must stop a robot, in microseconds, with nothing else loaded."""

from chatrobot.reflex.stop import is_emergency_stop, is_pause, is_release, is_stop, leads_with_stop

__all__ = ["is_emergency_stop", "is_pause", "is_release", "is_stop", "leads_with_stop"]
