"""The cell: its file, its signals, its sensors, and whether its parts can lie where they are put."""
