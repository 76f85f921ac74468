"""What the drives act on: the simulated arm, hand and parts."""
