"""From text to tree and back: grammar, parser, formatter, line numbers."""
