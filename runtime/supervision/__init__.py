"""What watches a running arm and reports, with a code, that it no longer follows its commands."""
