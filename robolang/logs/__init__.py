"""The log of a run: recorded in blocks, written to files, read back with every signal that follows, exported."""
