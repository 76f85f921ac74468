"""Bounds of a run, rehearsed or real: so that a program that never ends or never stops is carried out nevertheless."""

MAX_CHAIN = 2000
"""Most moves that blend into one another without a stop."""
LONG_CHAIN = 200, 60.0
"""A chain of so many moves that takes so many s at its programmed speeds ends, too: a loop may never stop."""
MAX_RUN_US = 1_800_000_000
"""Longest run, us of simulated time: about a kilobyte of log is kept for every tick."""
