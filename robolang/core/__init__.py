"""Source text and places, diagnostics and their codes, limits, files that are written whole."""
