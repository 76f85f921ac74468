"""What a run does when its log can no longer be kept."""

from robolang.execution.result import RunRecord


def check_log(record: RunRecord) -> None:
    """Raise RBL706 where what was recorded cannot be kept: the arm stops on its path, and nothing is lost."""
    controller = record.controller
    failed, controller.recorder.failed = controller.recorder.failed, None
    if failed is not None and not controller.alarms:
        why = failed.strerror or failed
        kept_for = record.kept_for
        without = f", or run without {kept_for}" if kept_for else ""
        hint = f"Make room for the log{without}; the log up to here is complete."
        controller.alarm("RBL706", f"cannot write the temporary file of the log: {why}", hint=hint)
