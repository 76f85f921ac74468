"""JUnit XML: a test suite for each program, a failed test case for each finding.

A program without findings is one case that passes, so that a report is never empty. An info fails nothing: it is the
output of a case that passes. Times are left out, so that equal results give equal bytes. A case has no attributes but
those that the schema of Jenkins knows, and its place in words: a reader that holds to the schema refuses a whole report
for a ``line`` or a ``file``.
"""

import re
from collections.abc import Sequence
from pathlib import Path
from xml.sax.saxutils import escape, quoteattr

from robolang.core.diagnostics import Severity
from robolang.lint.engine import Checked
from robolang.lint.reporters.finding import Finding, findings, relative

# all but the characters of XML 1.0, production 2 (Char)
_FORBIDDEN = re.compile("[^\t\n\r\x20-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")


def render(results: Sequence[Checked], root: Path) -> str:
    """Return the document."""
    suites = [_suite(result, root) for result in results]
    cases = sum(len(cases) for _, cases, _ in suites)
    failed = sum(failures for _, _, failures in suites)
    head = f'<testsuites name="robolang" tests="{cases}" failures="{failed}">'
    lines = ['<?xml version="1.0" encoding="UTF-8"?>', head]
    for name, inner, failures in suites:
        lines.append(f'  <testsuite name={name} tests="{len(inner)}" failures="{failures}" errors="0">')
        lines += [line for case in inner for line in case]
        lines.append("  </testsuite>")
    return "\n".join([*lines, "</testsuites>"]) + "\n"


def _suite(result: Checked, root: Path) -> tuple[str, list[list[str]], int]:
    """Return the quoted name of a program, its cases as lines and how many of them fail."""
    name = quoted(relative(result.source.path, root))
    found = findings([result])
    if not found:
        return name, [[f'    <testcase name="robolang" classname={name}/>']], 0
    return name, [_case(item, root) for item in found], sum(item.severity is not Severity.INFO for item in found)


def _case(item: Finding, root: Path) -> list[str]:
    region = item.region
    text = f"line {region.line}, column {region.column}: {item.message}"
    name, path = quoted(f"{item.code} {item.name}"), quoted(relative(item.path, root))
    head = f"    <testcase name={name} classname={path}>"
    body = escape(_legal(f"{text}\nhelp: {item.hint}"))
    if item.severity is Severity.INFO:
        return [head, f"      <system-out>{body}</system-out>", "    </testcase>"]
    kind = f'type="{item.severity.value}"'
    return [head, f"      <failure message={quoted(text)} {kind}>{body}</failure>", "    </testcase>"]


def quoted(text: str) -> str:
    """Return text as the value of an attribute, with its quotes; what XML cannot hold is replaced."""
    return quoteattr(_legal(text))


def _legal(text: str) -> str:
    """Return text without what XML 1.0 cannot hold."""
    return _FORBIDDEN.sub("\ufffd", text)
