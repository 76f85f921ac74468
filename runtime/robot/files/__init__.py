"""Files of robots: TOML, URDF and MJCF, read without trust."""
