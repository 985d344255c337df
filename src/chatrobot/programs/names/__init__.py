"""The packages that programs import, as they see them: `rclpy`, messages, `tf_transformations`. Our own work.

Each behaves as recorded of ROS 2 (Jazzy; float fields as Humble), behind it stands one pipe to the governor.
"""
