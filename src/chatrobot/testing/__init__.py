"""Tests of a robot profile, a wire or a primitive of your own: docs/testing.md. Nothing of the product imports this."""
