"""Signals as people name them: ``q_fb``, ``q_fb:2`` or ``q_fb:J2`` for an axis, ``parts:box`` for a part."""

import difflib
from collections.abc import Iterable

import robolang.core.codes  # noqa: F401 - the codes raised here must be registered
from robolang.logs.quantities import Column, SignalSource, columns
from runtime.core.faults import Fault


def selected(log: SignalSource, names: Iterable[str], text: str) -> tuple[Column, ...]:
    """Return the columns that a text names; ``names`` are all signals. ``Fault`` RBL838 for one that is not there."""
    known = list(names)
    name, _, label = (part.strip() for part in text.partition(":"))
    if name not in known:
        raise Fault("RBL838", f"{log.source} has no signal '{name}'", _offer(name, known))
    found = columns(log, name)
    if not label:
        return found
    # a part may be called J1, and then it is no axis
    matching = _labelled(found, label) or _labelled(found, _axis(label))
    if not matching:
        labels = [each.label for each in found if each.label]
        raise Fault("RBL838", f"{name} of {log.source} has no column '{label}'", _offer(label, labels))
    return matching


def _labelled(found: tuple[Column, ...], label: str) -> tuple[Column, ...]:
    return tuple(each for each in found if each.label == label or each.label.startswith(f"{label}."))


def _axis(label: str) -> str:
    # J alone is no axis, and x of a place is no J
    return label.removeprefix("J") if label[1:].isdecimal() else label


def _offer(word: str, known: list[str]) -> str:
    """Return what is near a word, and all that there is."""
    if not known:
        return "it is one number: leave the colon out"
    near = difflib.get_close_matches(word, known, n=3, cutoff=0.6)
    near += [each for each in known if each.casefold() == word.casefold() and each not in near]
    there = f"there are {', '.join(known)}"
    return f"did you mean {' or '.join(near)}? {there}" if near else there
