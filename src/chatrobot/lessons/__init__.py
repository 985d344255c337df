"""Lessons: sheets of tasks, and what a pupil's robot did of them by its true pose."""
