"""Numbers and texts, places in programs, faults, files: the base of all other rooms."""
