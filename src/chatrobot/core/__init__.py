"""Level 0: what everything else stands on. Imports nothing of ours and nothing heavy."""
