"""Writes a plan as a readable rclpy program, as a person would: see `program`."""
