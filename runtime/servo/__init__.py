"""From joint set-points to drive torque at every servo tick."""
