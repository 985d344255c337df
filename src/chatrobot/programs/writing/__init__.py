"""From a plan to a readable rclpy program, as a person would write it: see `program`."""
