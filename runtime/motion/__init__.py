"""From a motion command to joint set-points every 8 ms."""
