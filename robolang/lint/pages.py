"""The pages of the rules as Markdown: ``python -m robolang.lint.pages [FOLDER]`` writes docs/rules anew.

Everything on a page comes from the registries; nothing is written twice.
"""

import sys
from pathlib import Path

from robolang.core.bounds import Bound, of_rule
from robolang.lint.registry import rule, rules
from robolang.lint.rule import Rule
from runtime.core.faults import lookup

_INDEX = """\
# Rules

What `robolang check` finds. `robolang rules` prints this list, `robolang explain RBL113` a page. How to select,
ignore and suppress them is in [ci.md](../ci.md).

These pages are generated: `python -m robolang.lint.pages`.

| code | name | severity | fix |
|---|---|---|---|
"""


def page(code: str) -> str:
    """Return the page of a registered code; a short one when only name, meaning and remedy are known."""
    entry, known = lookup(code), rule(code)
    parts = [f"# {entry.code} {entry.name}"]
    if known is not None:
        parts.append(_summary(known))
    parts += ["## What it finds", entry.meaning]
    if known is not None:
        parts += _story(known)
    parts += ["## What to do", entry.remedy]
    if bounds := of_rule(code):
        parts += [f"Or set another bound in robolang.toml:\n\n```toml\n{_bounds(bounds)}\n```"]
    if known is not None and known.fix:
        parts += ["## Fix", f"{known.fix} The fix is safe: `robolang check --fix` applies it."]
    return "\n\n".join(parts) + "\n"


def index() -> str:
    """Return the table of all rules that have a page."""
    return _INDEX + "".join(f"{_row(item)}\n" for item in rules().values())


def pages() -> dict[str, str]:
    """Return every page by the name of its file."""
    return {"README.md": index(), **{f"{code}.md": page(code) for code in rules()}}


def write(folder: Path) -> None:
    """Write every page, and remove those of rules that are gone."""
    folder.mkdir(parents=True, exist_ok=True)
    current = pages()
    for old in folder.glob("*.md"):
        if old.name not in current:
            old.unlink()
    for name, text in current.items():
        (folder / name).write_text(text, "utf-8")


def _summary(known: Rule) -> str:
    fix = "safe fix" if known.fix else "no fix"
    return f"{known.severity.value} · {fix} · found by `robolang {known.found_by}`"


def _story(known: Rule) -> list[str]:
    place = f"{known.code} is found in line {known.line}{' of the points file' if known.points else ''}."
    return [
        "## Why it matters",
        known.why,
        "## Example",
        f"```text\n{known.example}\n```",
        *([place] if known.line else []),
        "Instead:",
        f"```{'toml' if known.points else 'rbl'}\n{known.instead}\n```",
    ]


def _bounds(bounds: tuple[Bound, ...]) -> str:
    width = max(len(f"{bound.key} = {bound.default:g}") for bound in bounds)
    lines = [f"[lint.{bounds[0].rule}]"]
    for bound in bounds:
        key = f"{bound.key} = {bound.default:g}"
        lines.append(f"{key:<{width}}  # {bound.low:g} to {bound.high:g} {bound.unit}: {bound.meaning}")
    return "\n".join(lines)


def _row(known: Rule) -> str:
    entry = known.entry
    return f"| [{entry.code}]({entry.code}.md) | {entry.name} | {known.severity.value} | {'yes' if known.fix else ''} |"


if __name__ == "__main__":
    write(Path(sys.argv[1]) if len(sys.argv) > 1 else Path("docs/rules"))
