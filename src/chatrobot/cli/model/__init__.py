"""`chatrobot model`: language models set up, listed, tested, chosen."""
