"""``python -m tests.fuzz.large [KIND ...]``: time and memory of ``check`` and ``fmt`` on the largest programs.

One row for each kind of text that costs much for its size: programs of 1 MB of many lines, long lines, many names or
many mistakes. Each command is a process of its own; CPU time and peak of resident memory are the operating system's.
The last column is the CPU time for 1 MB by that for half of it. The promises: 20 s, 300 MB, 2.3.
"""

import os
import random
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory

SIZE = 1_000_000
MOST_S = 20.0
MOST_MB = 300.0
MOST_RATIO = 2.3
SHORT_S = 1.0
"""Below that a ratio of times says nothing."""
COMMANDS = {"check": ("check",), "fmt": ("fmt", "--check")}


def _chaos(pieces, seed=1992):
    chance = random.Random(seed)
    return "".join(chance.choice(pieces) for _ in range(SIZE))


REPEATED = {
    "assignments": "A=1\n", "labels": "*A\n", "blank lines": "\n", "numbers": "1\n", "words": "END\n",
    "comments": "'\n", "settings": "MOVE P\n", "texts": 'A$="a"\n', "noqa": "a=1'noqa\n",
    "poses": "P=POSE(1,2,3,4,5,6)\n", "moves": "APPROACH P1,100,SPEED 50,ZONE 3\n", "hands": "HAND ON\nHAND OFF\n",
    "waits": "WAIT a,TIMEOUT 1,GOTO 1\n", "one-line IFs": "IF a THEN a=1 ELSE a=2\n",
    "loops": "FOR I=1 TO 2\nNEXT\n", "arrays": "DIM A(1)\n", "blocks": "IF 1 THEN\n" * 99 + "ENDIF\n" * 99,
    "lists": "PRINT " + "a;" * 4000 + "a\n", "sums": "A=" + "1+" * 900 + "1\n",
    "products": "A=" + "a*" * 900 + "1\n", "powers": "A=" + "2^" * 900 + "1\n", "signs": "A=" + "-" * 90 + "1\n",
    "parentheses": "A=" + "(" * 90 + "1" + ")" * 90 + "\n", "NOTs": "A=" + "NOT " * 90 + "1\n",
    "ways": "MOVE P1" + "*(1,1,1)" * 900 + "\n", "cases": "CASE " + "1," * 4000 + "1\n",
    "elements": "PRINT " + "a(1);" * 1800 + "a\n", "components": "PRINT " + "a.X;" * 2000 + "a\n",
    "options": "MOVE P" + ",FINE" * 1800 + "\n", "held": "WRIST HOLD " + "TILT," * 1500 + "TILT\n",
    "parameters": "SUB A(" + "a," * 4000 + "a)\nENDSUB\n", "arguments": "CALL F(" + "a," * 4000 + "a)\n",
    "mistakes": "a;a;\n", "one letter": "a\n", "suspicious": "é\n",
}  # fmt: skip
COUNTED = {
    "names": "x{n}=y{n}\n", "line numbers": "{n} A={n}\n", "jumps": "{n} GOTO {n}\n", "constants": "CONST k{n}=1\n",
    "labels of their own": "*L{n}\n", "subroutines": "SUB s{n}\nENDSUB\n", "calls": "CALL s{n}\n",
    "points": "MOVE P{n}\n",
}  # fmt: skip
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
    process = subprocess.Popen([sys.executable, "-c", _MEASURE, *COMMANDS[command], str(path)],
                               stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)  # fmt: skip
    said = process.stderr.read()
    _, status, usage = os.wait4(process.pid, 0)
    process.stderr.close()
    process.returncode = os.waitstatus_to_exitcode(status)
    return Cost(cpu_s=usage.ru_utime + usage.ru_stime, rss_mb=int(said.rpartition("peak ")[2]) / 1024,
                code=process.returncode)  # fmt: skip


def measured(kind, command, folder, size=SIZE):
    """What a command costs on a program of a kind, written to a folder."""
    path = Path(folder) / "large.rbl"
    path.write_text(text(kind, size), encoding="utf-8", newline="")
    return cost(path, command)


def main():
    bad = []
    print(f"{'kind':20s} {'command':8s} {'CPU s':>6s} {'MB':>5s} {'exit':>4s} {'t(1 MB) / t(0.5 MB)':>20s}")
    with TemporaryDirectory() as folder:
        for kind in sys.argv[1:] or KINDS:
            for command in COMMANDS:
                whole, half = (measured(kind, command, folder, size) for size in (SIZE, SIZE // 2))
                print(f"{kind:20s} {command:8s} {whole.cpu_s:6.2f} {whole.rss_mb:5.0f} {whole.code:4d} "
                      f"{whole.cpu_s / half.cpu_s:20.2f}", flush=True)  # fmt: skip
                linear = whole.cpu_s < SHORT_S or whole.cpu_s / half.cpu_s <= MOST_RATIO
                if not (linear and whole.cpu_s <= MOST_S and whole.rss_mb <= MOST_MB and whole.code in (0, 1, 2)):
                    bad.append(kind)
    sys.exit(f"over the limit: {', '.join(bad)}" if bad else 0)


if __name__ == "__main__":
    main()
