"""Beside the levels: the guard, a tiny process that halts the robot when Motion dies, freezes or skips beats.

Imports `core` and `wire` alone, knows nothing but how to halt, and dies last.
"""
