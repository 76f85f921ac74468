"""What a program is expected to do: test files, golden logs, verdicts."""
