"""Programs as pulse tables: export, the arm driven by them, plots."""
