"""Jogging and teaching: what the prompt, a page and an editor share."""
