"""The cell: its file, its signals, its sensors, and whether its parts can rest where they are put."""
