"""Models over real HTTP, against the scripted server."""
