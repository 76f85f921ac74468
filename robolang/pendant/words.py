"""Words and numbers after the word of a command, read with errors that say what was expected."""

import math

from robolang.pendant.failure import Failure, failure


def misused(form: str, message: str) -> Failure:
    """Return the failure of a command that was not typed in its form (RBL802)."""
    return failure("RBL802", message, f"The form is: {form}")


def nothing(rest: str, form: str) -> None:
    """Refuse text after a command that takes none."""
    if rest:
        raise misused(form, f"nothing may follow this command, found '{rest}'")


def number(text: str, form: str, what: str) -> float:
    """Return a finite number; ``Failure`` RBL802 names what it is the number of."""
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise misused(form, f"'{text}' is not a number for {what}")
    return value


def whole(text: str, form: str, what: str, low: int, high: int) -> int:
    """Return a whole number from ``low`` to ``high``; ``Failure`` RBL802."""
    # twelve digits: int() of a text of thousands would take long, or refuse
    if not text.isascii() or not text.isdigit() or not low <= int(text[:12]) <= high:
        raise misused(form, f"'{text}' is not a whole number from {low} to {high} for {what}")
    return int(text)


def values(text: str, separator: str) -> tuple[str, ...]:
    """Return the parts of a text between separators that are outside of parentheses and of texts in quotes."""
    found, depth, quoted = [""], 0, False
    for character in text:
        quoted ^= character == '"'
        depth += 0 if quoted else {"(": 1, ")": -1}.get(character, 0)
        if character == separator and not depth and not quoted:
            found.append("")
        else:
            found[-1] += character
    return tuple(each.strip() for each in found)


def without_flag(rest: str, flag: str) -> tuple[str, bool]:
    """Return the text without a flag such as ``--yes`` at its end, and whether that was there."""
    # at the end only: an expression or a text may hold the same characters
    words = rest.rsplit(maxsplit=1)
    if words and words[-1] == flag:
        return rest[: rest.rindex(flag)].rstrip(), True
    return rest, False
