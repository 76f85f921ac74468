"""The linter of ``robolang check``: rules and their pages, selection, suppression, fixes. Imports no numerics."""
