"""What watches a running arm and says, in a code, that it no longer does what it was told."""
