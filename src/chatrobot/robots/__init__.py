"""Level 1: robot profiles. `load_profile(name_or_path)` is the door."""
