"""Inertia and gravity of each axis, and the task that keeps them fresh."""
