"""What an editor or a prompt offers while a statement is written, taken from the declarations."""

from robolang.syntax.declaration import form
from robolang.syntax.statements import STATEMENTS
from runtime.core.record import Record


class Completion(Record):
    """Words to offer, the form that they begin and its meaning; ``after``: the keyword of the statement whose option
    it is, empty where the words begin a statement."""

    words: str
    form: str
    help: str
    after: str = ""


def completions() -> tuple[Completion, ...]:
    """Return the words that begin a statement, and after them the options of moves; assignments begin with no word."""
    statements = [
        Completion(words=words, form=form(each), help=each.help) for each in STATEMENTS for words in each.starts
    ]
    options = [
        Completion(words=words, form=form(option), help=option.help, after=each.keyword)
        for each in STATEMENTS
        for option in each.options
        for words in option.starts
    ]
    return (*statements, *options)
