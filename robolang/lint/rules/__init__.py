"""Rules, one file for each group; registering is in ``robolang.lint.registry``."""
