"""Programs for the robot: taken out of replies, written, read through, run in the sandbox, kept and exported."""
