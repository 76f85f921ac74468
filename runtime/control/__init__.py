"""The running controller: its cycle, its background task, its memory areas and its recorder."""
