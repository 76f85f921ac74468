"""Values of expressions: numbers, texts, poses; what the text alone gives."""
