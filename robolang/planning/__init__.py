"""The motion of a program, known before it runs: branches covered, findings, cycle times."""
