"""The built-in primitives, by kind; each module lists its own in `PRIMITIVES`, where `plan.primitive` finds them."""
