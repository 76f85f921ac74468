"""Projects to begin with: templates of jobs, placed in front of a robot, and the example programs.

``library`` holds the templates, each a program with its files that runs as it is; ``folder`` what stands beside it in a
project. ``placing`` puts a job where an arm reaches it, ``fitting`` checks that by a rehearsal, ``writing`` writes all
files or none.
"""
