"""Straight moves through a change of the wrist configuration (docs/wrist.md)."""
