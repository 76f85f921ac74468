"""docs/tutorial.md in an empty folder: every command of it is carried out, and ends as the page says."""

import pytest

from tests.campaign import WHOLE
from tests.pages import assert_carried_out, blocks_of

# a run, a picture and a check of the motion take seconds each; what makes and changes the files does not
_QUICK = ("robolang new", "robolang teach", "robolang fmt", "sed", "printf", "rm")


def test_the_files_of_the_tutorial_are_those_that_its_ci_accepts(tmp_path):
    lines = [line for block in blocks_of("tutorial") for line in block.splitlines()]
    assert_carried_out("\n".join(line for line in lines if line.startswith(_QUICK)), tmp_path)
    for command in ("robolang new", "robolang fmt --check"):
        assert any(line.startswith(command) for line in lines)
    # what the workflow runs is what the page runs
    workflow = (tmp_path / "out" / "tutorial" / ".github" / "workflows" / "robolang.yml").read_text("utf-8")
    ran = [line.partition("- run: ")[2].strip() for line in workflow.splitlines() if "- run: robolang" in line]
    assert len(ran) == 3
    for command in ran:
        assert any(line.startswith(command) for line in lines), command


@pytest.mark.physics
@pytest.mark.skipif(not WHOLE, reason="a minute; CAMPAIGN=1 runs it")
def test_every_command_of_the_tutorial_is_carried_out(tmp_path):
    assert_carried_out("".join(blocks_of("tutorial")), tmp_path)
