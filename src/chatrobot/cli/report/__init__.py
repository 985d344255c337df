"""`chatrobot report`: what was recorded as a page, a figure, an animation or a table."""
