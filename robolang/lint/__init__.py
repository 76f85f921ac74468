"""The linter behind ``robolang check``: rules and their pages, selection, suppression, fixes. Imports no numerics."""
