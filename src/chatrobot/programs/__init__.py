"""Programs for the robot: taken out of replies, written, checked, kept and exported."""
