"""Chains of moves as one path, timed as a whole (docs/motion.md)."""
