"""Level 1: robot profiles. `chatrobot.robots.load.load_profile(name_or_path)` is the door."""
