"""The interactive console: what a newcomer meets."""
