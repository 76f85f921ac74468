"""The prompt ``robolang repl``: commands, screen, keys and scripts."""
