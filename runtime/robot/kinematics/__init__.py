"""Where the flange is for given joint angles, and which joint angles put it there."""
