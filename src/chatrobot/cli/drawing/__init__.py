"""Pictures of worlds and ways: as characters for a terminal, as PNG for a page."""
