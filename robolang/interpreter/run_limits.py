"""Bounds of a run, as counts: a program ends the same on every computer, however fast that is."""

MAX_IDLE = 100_000
"""Most rounds of a loop without a statement that takes time (RBL508)."""
MAX_STEPS = 10_000_000
"""Most statements (RBL505)."""
MAX_CALLS = 100
"""Deepest nesting of CALLs, and of GOSUBs (RBL504)."""
MAX_LOOPS = 10_000
"""Most FORs of one scope that have begun and have been left by a jump (RBL504)."""
MAX_SHOWN = 1_000_000
"""Most characters of PRINT (RBL506)."""
MAX_ROUNDS = 1e15
"""Most rounds of a FOR (RBL502): above this, a float no longer counts single rounds."""
UNCAUGHT = frozenset({"RBL505", "RBL506", "RBL508", "RBL509"})
"""Bounds that no ON ERROR catches: a program that exceeds one would go on for ever."""
