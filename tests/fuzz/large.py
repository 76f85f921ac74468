"""``make large``: time and memory of ``check`` and ``fmt`` on the largest programs.

Programs of 1 MB of every kind of text that costs much for its size: many lines, long lines, many names, many mistakes.
Each command is a process of its own; CPU time and peak of resident memory are the operating system's. Each is compared
with the CPU time for half of the text. The promises: 300 MB, 2.3.
"""

import os
import random
import subprocess
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory

from tests.bench import figures
from tests.bench.figures import Row

SIZE = 1_000_000
MOST_MB = 300.0
MOST_RATIO = 2.3
SHORT_S = 1.0
"""Below that a ratio of times says nothing."""
COMMANDS = {"check": ("check",), "fmt": ("fmt", "--check")}


def _chaos(pieces, seed=1992):
    chance = random.Random(seed)
    return "".join(chance.choice(pieces) for _ in range(SIZE))


REPEATED = {
    "assignments": "A=1\n",
    "labels": "*A\n",
    "blank lines": "\n",
    "numbers": "1\n",
    "words": "END\n",
    "comments": "'\n",
    "settings": "MOVE P\n",
    "texts": 'A$="a"\n',
    "noqa": "a=1'noqa\n",
    "poses": "P=POSE(1,2,3,4,5,6)\n",
    "moves": "APPROACH P1,100,SPEED 50,ZONE 3\n",
    "hands": "HAND ON\nHAND OFF\n",
    "waits": "WAIT a,TIMEOUT 1,GOTO 1\n",
    "one-line IFs": "IF a THEN a=1 ELSE a=2\n",
    "loops": "FOR I=1 TO 2\nNEXT\n",
    "arrays": "DIM A(1)\n",
    "blocks": "IF 1 THEN\n" * 99 + "ENDIF\n" * 99,
    "lists": "PRINT " + "a;" * 4000 + "a\n",
    "sums": "A=" + "1+" * 900 + "1\n",
    "products": "A=" + "a*" * 900 + "1\n",
    "powers": "A=" + "2^" * 900 + "1\n",
    "signs": "A=" + "-" * 90 + "1\n",
    "parentheses": "A=" + "(" * 90 + "1" + ")" * 90 + "\n",
    "NOTs": "A=" + "NOT " * 90 + "1\n",
    "ways": "MOVE P1" + "*(1,1,1)" * 900 + "\n",
    "cases": "CASE " + "1," * 4000 + "1\n",
    "elements": "PRINT " + "a(1);" * 1800 + "a\n",
    "components": "PRINT " + "a.X;" * 2000 + "a\n",
    "options": "MOVE P" + ",FINE" * 1800 + "\n",
    "held": "WRIST HOLD " + "TILT," * 1500 + "TILT\n",
    "parameters": "SUB A(" + "a," * 4000 + "a)\nENDSUB\n",
    "arguments": "CALL F(" + "a," * 4000 + "a)\n",
    "mistakes": "a;a;\n",
    "one letter": "a\n",
    "suspicious": "é\n",
    "open IFs": "IF 1 THEN\n",
    "open WHILEs": "WHILE 1\n",
    "open SUBs": "SUB a\n",
    "open SELECTs": "SELECT 1\nCASE 1\n",
    "ELSEs": "ELSE\n",
}
COUNTED = {
    "names": "x{n}=y{n}\n",
    "line numbers": "{n} A={n}\n",
    "jumps": "{n} GOTO {n}\n",
    "constants": "CONST k{n}=1\n",
    "labels of their own": "*L{n}\n",
    "subroutines": "SUB s{n}\nENDSUB\n",
    "calls": "CALL s{n}\n",
    "points": "MOVE P{n}\n",
    "jumps to nowhere": "GOTO {n}\n",
}
KINDS = (*REPEATED, *COUNTED, "anything", "any characters")


def text(kind, size=SIZE):
    """A program of a kind, at most of a size and whole lines of it."""
    if kind in REPEATED:
        return REPEATED[kind] * (size // len(REPEATED[kind].encode()))
    if kind in COUNTED:
        found = "".join(COUNTED[kind].format(n=n) for n in range(size // len(COUNTED[kind])))
        return found[: found.rindex("\n", 0, size) + 1]
    if kind == "anything":
        return _chaos(["A", "1", " ", "\n", "=", "+", "(", ")", ",", ";", "MOVE ", "IF ", " THEN "])[:size]
    return _chaos([chr(code) for code in range(32, 127)] + ["\n"] * 9)[:size]


@dataclass(frozen=True, slots=True, kw_only=True)
class Cost:
    """What a process cost: CPU time, peak of resident memory, exit code."""

    cpu_s: float
    rss_mb: float
    code: int


_MEASURE = """
import atexit, sys
from robolang.__main__ import main
def say():
    status = open("/proc/self/status").read()
    sys.stderr.write("peak " + status.split("VmHWM:")[1].split()[0])
atexit.register(say)
main()
"""
# The peak of getrusage would not do: it is handed on by fork and exec, so a child of a large process begins with that.


def cost(path, command):
    """Run a command on a program and return what it cost."""
    process = subprocess.Popen(
        [sys.executable, "-c", _MEASURE, *COMMANDS[command], str(path)],
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        text=True,
    )
    said = process.stderr.read()
    _, status, usage = os.wait4(process.pid, 0)
    process.stderr.close()
    process.returncode = os.waitstatus_to_exitcode(status)
    return Cost(
        cpu_s=usage.ru_utime + usage.ru_stime, rss_mb=int(said.rpartition("peak ")[2]) / 1024, code=process.returncode
    )


def measured(kind, command, folder, size=SIZE):
    """What a command costs on a program of a kind, written to a folder."""
    path = Path(folder) / "large.rbl"
    path.write_text(text(kind, size), encoding="utf-8", newline="")
    return cost(path, command)


@dataclass(frozen=True, slots=True, kw_only=True)
class Pair:
    """What one command costs on a program of one kind, whole and half as large."""

    kind: str
    command: str
    whole: Cost
    half: Cost

    @property
    def ratio(self) -> float:
        """Return the ratio of times, 1 where they say nothing."""
        return self.whole.cpu_s / self.half.cpu_s if self.whole.cpu_s >= SHORT_S else 1.0

    def __str__(self) -> str:
        return (
            f"{self.kind:20s} {self.command:5s} {self.whole.cpu_s:6.2f} s {self.whole.rss_mb:5.0f} MB, exit "
            f"{self.whole.code}, {self.whole.cpu_s / self.half.cpu_s:.2f} times its half"
        )


def rows(smallest: bool) -> Iterator[Row]:
    """Measure every kind with every command; times of the smallest size are not held to the promises."""
    kinds, size = (("comments",), 2000) if smallest else (KINDS, SIZE)
    with TemporaryDirectory() as folder:
        pairs = [
            Pair(
                kind=kind,
                command=command,
                whole=measured(kind, command, folder, size),
                half=measured(kind, command, folder, size // 2),
            )
            for kind in kinds
            for command in COMMANDS
        ]
    slowest, biggest, steepest = (
        max(pairs, key=key)
        for key in (lambda pair: pair.whole.cpu_s, lambda pair: pair.whole.rss_mb, lambda pair: pair.ratio)
    )
    ended = all(pair.whole.code in (0, 1, 2) for pair in pairs)
    yield Row(
        figure=f"programs of 1 MB of {len(KINDS)} kinds, `check` and `fmt`: longest CPU time",
        form=f"{{:.1f}} s ({slowest.kind}, {slowest.command})",
        values=(slowest.whole.cpu_s,),
        good=ended,
        details=tuple(map(str, pairs)),
    )
    yield Row(
        figure="their largest memory",
        form=f"{{:.0f}} MB ({biggest.kind}, {biggest.command})",
        values=(biggest.whole.rss_mb,),
        good=biggest.whole.rss_mb <= MOST_MB,
    )
    yield Row(
        figure="largest ratio of times, 1 MB to 0.5 MB",
        form=f"{{:.1f}} ({steepest.kind}, {steepest.command})",
        values=(steepest.ratio,),
        good=smallest or steepest.ratio <= MOST_RATIO,
    )


if __name__ == "__main__":
    figures.run(rows)
