"""Programs carried out: lowering to SI, the run, its result, report and logs, and the dry run."""
