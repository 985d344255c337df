"""The built-in primitives, one module each with a `PRIMITIVE`. `plan.registry` finds every module in here."""
