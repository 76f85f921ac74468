"""What robots, hands and cells look like: shapes from joint frames and dimensions, for pictures alone."""
