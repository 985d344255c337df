"""Level 3: the plan language, its primitives, the trajectory generator, rehearsal and route planning."""
