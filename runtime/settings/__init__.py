"""What a controller may be set to: the profile, its servo options, the limits of supervision."""
