"""Bounds of a run, rehearsed or real: so that a program that never ends or never stops is carried out nevertheless."""

MOST_AHEAD = 2000
"""Most moves that are planned ahead of a motion that does not stop; what follows is planned while it runs."""
LONG_AHEAD = 100, 10.0
"""So many moves that take so many s at their programmed speeds are planned ahead, and no more, either."""
MAX_RUN_US = 1_800_000_000
"""Longest run, us of simulated time: about a kilobyte of log is kept for every tick."""
