"""A scripted stand-in for a language model, over real HTTP: for tests, and to try model mode without a key."""
