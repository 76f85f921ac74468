"""Built-in robots, one TOML file each."""
