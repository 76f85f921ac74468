"""The colours of the terminal, by what a text is. They are the terminal's own sixteen, so that they can be read on a
light and on a dark screen; no meaning is in a colour alone.
"""

from prompt_toolkit.styles import Style

from robolang.pendant.marks import Mark

_OF_MARKS = {
    Mark.KEYWORD: "ansiblue bold",
    Mark.FUNCTION: "ansicyan",
    Mark.COMMAND: "ansimagenta bold",
    Mark.NAME: "",
    Mark.POINT: "ansigreen",
    Mark.OF_CELL: "ansigreen",
    Mark.NUMBER: "",
    Mark.TEXT: "ansiyellow",
    Mark.COMMENT: "italic ansibrightblack",
    Mark.LINE: "ansibrightblack",
    Mark.LABEL: "ansimagenta",
    Mark.SIGN: "",
    Mark.WRONG: "ansired underline",
}
"""Yellow is brown or dark on a light screen in the usual palettes, and red is dark: both can be read there."""

STYLE = Style.from_dict(
    {
        **{f"mark.{mark.value}": colour for mark, colour in _OF_MARKS.items()},
        "prompt": "bold",
        "heading": "bold",
        "unit": "ansibrightblack",
        "strong": "bold",
        "error": "ansired bold",
        "warning": "ansiyellow bold",
        "caret": "ansired",
        "help": "ansicyan",
        "progress": "ansibrightblack",
        "arrow": "ansigreen bold",
        "breakpoint": "ansired bold",
        "bottom-toolbar": "noreverse",
        "status": "reverse",
        "status.mode": "reverse bold",
        "status.alarm": "bg:ansired ansiwhite bold",
        "status.armed": "bg:ansiyellow ansiblack bold",
        "completion-menu.completion": "",
    }
)


def style_of(mark: Mark) -> str:
    """Return the style of a part of a line, as prompt_toolkit names it."""
    return f"class:mark.{mark.value}"
