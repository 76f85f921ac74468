"""The hooks for pre-commit and the pipelines of docs/ci.md are what their readers take, and name real commands."""

import re
import shlex
from pathlib import Path

import pytest
import yaml
from typer.main import get_command

from robolang.cli.main import app
from tests.robolang.lint.schemas import problems, validator

ROOT = Path(__file__).parents[3]
BLOCKS = re.findall(r"^```yaml\n(.*?)^```$", (ROOT / "docs" / "ci.md").read_text("utf-8"), re.MULTILINE | re.DOTALL)


class Yaml12(yaml.SafeLoader):
    """YAML as its readers take it: ``on`` is a word, not true."""


Yaml12.yaml_implicit_resolvers = {
    first: [rule for rule in rules if rule[0] != "tag:yaml.org,2002:bool"]
    for first, rules in yaml.SafeLoader.yaml_implicit_resolvers.items()
}
Yaml12.add_implicit_resolver("tag:yaml.org,2002:bool", re.compile("^(?:true|false)$"), list("tf"))


def read(text):
    return yaml.load(text, Yaml12)


HOOKS = read((ROOT / ".pre-commit-hooks.yaml").read_text("utf-8"))
GITHUB, GITLAB, LOCAL = map(read, BLOCKS)


@pytest.mark.parametrize(("name", "block"), [("github", BLOCKS[0]), ("gitlab", BLOCKS[1])])
def test_the_pipelines_of_the_page_are_files_to_copy(name, block):
    assert (ROOT / "docs" / "ci" / f"{name}.yml").read_text("utf-8") == block


def parse(words):
    """Return the parameters of what a hook or a step calls; a usage error for an option that is none."""
    program, name, *rest = words
    assert program == "robolang"
    return vars(get_command(app))["commands"][name].make_context("robolang", rest).params


def steps():
    """The commands of ``robolang`` in the pipelines and in the local hooks."""
    lines = [step.get("run", "") for step in GITHUB["jobs"]["check"]["steps"]]
    lines += GITLAB["robot programs"]["script"]
    lines += [hook["entry"] for hook in LOCAL["repos"][0]["hooks"]]
    return [line for line in lines if line.startswith("robolang ")]


@pytest.mark.parametrize(
    ("name", "document"),
    [
        (".pre-commit-hooks.yml", HOOKS),
        (".pre-commit-config.yml", read((ROOT / ".pre-commit-config.yaml").read_text("utf-8"))),
        (".pre-commit-config.yml", LOCAL),
        ("GitHub Workflow", GITHUB),
        ("gitlab-ci", GITLAB),
    ],
)
def test_the_files_obey_their_schemas(name, document):
    assert problems(validator(name), document) == []


@pytest.mark.parametrize(
    ("name", "document"),
    [
        (".pre-commit-hooks.yml", [{"id": "x", "name": "x", "language": "python"}]),
        (".pre-commit-config.yml", {"repos": [{"repo": "local", "hooks": [{"id": "x", "language": "cobol"}]}]}),
        ("GitHub Workflow", {"name": "x", "on": "push", "jobs": {"check": {"steps": [{"run": 1}]}}}),
        ("gitlab-ci", {"check": {"script": 1}}),
    ],
)
def test_the_schemas_refuse_what_their_readers_would(name, document):
    assert problems(validator(name), document) != []


def test_hooks_are_whole():
    assert [hook["id"] for hook in HOOKS] == ["robolang-check", "robolang-format"]
    for hook in HOOKS:
        assert {"id", "name", "description", "entry", "language", "files"} <= hook.keys()
        assert hook["language"] == "python"
        assert re.search(hook["files"], "cell/pick.rbl")
        assert not re.search(hook["files"], "cell/pick.points.toml")


@pytest.mark.parametrize("hook", HOOKS, ids=lambda hook: hook["id"])
def test_hooks_run_commands_that_exist(hook):
    params = parse([*shlex.split(hook["entry"]), *hook.get("args", []), "pick.rbl", "place.rbl"])
    assert params["paths"] == ("pick.rbl", "place.rbl")


@pytest.mark.parametrize("line", steps())
def test_steps_run_commands_that_exist(line):
    assert parse(shlex.split(line))


def test_a_command_that_is_none_is_noticed():
    assert len(steps()) == 9
    with pytest.raises(KeyError):
        parse(["robolang", "format", "pick.rbl"])
    with pytest.raises(Exception, match="--chek"):
        parse(["robolang", "fmt", "--chek", "pick.rbl"])
