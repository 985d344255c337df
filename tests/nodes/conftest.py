"""Every test of the nodes may have a graph of ROS."""

from tests.nodes.ros_graph import ear, guards, ros

__all__ = ["ear", "guards", "ros"]
