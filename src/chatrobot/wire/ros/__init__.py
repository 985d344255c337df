"""The wire over rclpy, for where ROS 2 is sourced: whatever middleware it runs on, we are a node of it.

`environment` reads ROS's variables, `convert` fills ROS messages, `node` is one node with its thread, `wire` is the
backend. Importing this package imports none of them, and no rclpy.
"""
