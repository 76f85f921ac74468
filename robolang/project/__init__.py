"""A program and what lies beside it: cell, taught points, settings; the built-in cell."""
