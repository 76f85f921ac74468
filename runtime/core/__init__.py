"""Numbers and texts, places in programs, faults, files: what everything else stands on."""
