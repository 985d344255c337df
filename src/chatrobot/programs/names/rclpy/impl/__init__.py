"""rclpy.impl"""
