"""``python -m tests.fuzz.run TARGET [SECONDS]``: fuzz one target, led by the coverage of the code that it reaches.

Starts from the corpus, the programs of the repository and what earlier runs found (``out/fuzz/TARGET``). An input that
breaks a promise is written to ``out/fuzz``, and the exit code is not 0. Make it small with ``-minimize_crash=1``,
correct the defect, and put the input into ``tests/fuzz/corpus``, which ``test_corpus.py`` gives to every target.
Needs atheris, which ``make fuzz`` installs.
"""

import sys
from pathlib import Path

import atheris

CORPUS = Path(__file__).with_name("corpus")
PROGRAMS = Path(__file__).parents[2] / "programs"
OUT = Path("out/fuzz")

with atheris.instrument_imports(include=["robolang", "runtime"]):
    from robolang.syntax.keywords import FUNCTIONS, KEYWORDS, VALUES
    from tests.fuzz import targets

_TOML = (
    "schema = 1",
    "[points.P1]",
    "pose = [",
    "joints = [",
    "]",
    "robot = ",
    "[[parts]]",
    "[home]",
    "[hand]",
    "= ",
    "nan",
    "inf",
    "1e308",
    '\\"\\"\\"',
    "''",
    "{",
    "}",
    "1979-05-27",
    "0x1F",
    "true",
)
_XML = (
    "<robot name=",
    "<mujoco>",
    "<link name=",
    "<joint name=",
    " type=",
    "<origin xyz=",
    " rpy=",
    "<axis xyz=",
    "<limit lower=",
    " upper=",
    "<inertial>",
    "<mass value=",
    "<inertia ixx=",
    "<body pos=",
    " quat=",
    "<compiler ",
    "<default>",
    "</",
    "/>",
    "<!--",
    "-->",
    "<![CDATA[",
    "<!DOCTYPE",
    "&lt;",
    "&#0;",
    "nan",
    "inf",
    "1e308",
)
_ZIP = (
    "PK\\x03\\x04",
    "PK\\x01\\x02",
    "PK\\x05\\x06",
    "PK\\x06\\x07",
    "\\x93NUMPY\\x01\\x00",
    "q.npy",
    "line.npy",
    "'descr': ",
    "'<f4'",
    "'<i4'",
    "'|O'",
    "'shape': (20, 6), ",
    "'fortran_order': False, ",
)
_SIGNS = (
    "\\x22",
    "'",
    "REM ",
    "noqa: RBL301",
    "fmt: off",
    "fmt: on",
    "\\x0d\\x0a",
    "\\x0d",
    "\\xef\\xbb\\xbf",
    "\\xe2\\x80\\xae",
    "\\xff",
    "1E999",
    "<>",
    "<=",
    "P1",
    "P2",
    "*L",
    "GOTO *L",
    ".X",
)

_WORDS = {"points": _TOML, "cell": _TOML, "model": _XML, "golden": _ZIP}


def main():
    target = sys.argv[1]
    seconds = sys.argv[2] if len(sys.argv) > 2 else "60"
    kept = OUT / target
    kept.mkdir(parents=True, exist_ok=True)
    words = _WORDS.get(target, (*KEYWORDS, *FUNCTIONS, *VALUES, *_SIGNS))
    dictionary = OUT / f"{target}.dict"
    dictionary.write_text("".join(f'"{word}"\n' for word in words), encoding="utf-8")
    options = [
        f"-max_total_time={seconds}",
        "-max_len=4096",
        "-timeout=10",
        f"-dict={dictionary}",
        f"-artifact_prefix={OUT}/{target}-",
        "-print_final_stats=1",
        "-verbosity=0",
        *sys.argv[3:],
    ]
    seeds = CORPUS / targets.SEEDS.get(target, "program")
    atheris.Setup([sys.argv[0], *options, str(kept), str(seeds), str(PROGRAMS)], lambda data: targets.run(target, data))
    atheris.Fuzz()


if __name__ == "__main__":
    main()
