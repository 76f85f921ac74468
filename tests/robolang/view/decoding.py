"""Reads a page and the runs in it, written from the description of the format and not from its code."""

import base64
import json
import math
import re
import struct
import zlib
from html.parser import HTMLParser


class Page(HTMLParser):
    """The elements of a page, in order: name, attributes and, of scripts and styles, the text."""

    def __init__(self, path):
        super().__init__()
        self.elements = []
        self.text = path.read_bytes().decode("utf-8")
        self.feed(self.text)
        self.close()

    def handle_starttag(self, tag, attrs):
        self.elements.append([tag, dict(attrs), ""])

    def handle_data(self, data):
        if self.elements:
            self.elements[-1][2] += data

    def of(self, tag):
        return [(attributes, text) for name, attributes, text in self.elements if name == tag]

    @property
    def policy(self):
        (found,) = (attributes["content"] for attributes, _ in self.of("meta") if "http-equiv" in attributes)
        return dict(part.strip().split(" ", 1) for part in found.split(";"))

    @property
    def runs(self):
        return [unpacked(base64.b64decode(text)) for attributes, text in self.of("script") if "data-run" in attributes]


def unpacked(data):
    """Header, and by signal its columns as lists; None where there is no number."""
    raw = zlib.decompress(data, 31)
    (length,) = struct.unpack("<I", raw[:4])
    header = json.loads(raw[4 : 4 + length].decode("utf-8"), parse_constant=refused)
    at, found = 4 + length, {}
    for signal in header["signals"]:
        rows, columns = signal["rows"], list(zip(signal["lo"], signal["step"], strict=True))
        assert len(columns) == signal["columns"]
        size = rows * sum(step > 0 for _, step in columns)
        low, middle, high = (raw[at + k * size : at + (k + 1) * size] for k in range(3))
        at, k = at + 3 * size, 0
        found[signal["name"]] = []
        for lo, step in columns:
            if not step:
                found[signal["name"]].append([lo] * rows)
                continue
            code, column = 0, []
            for row in range(k, k + rows):
                folded = low[row] + 256 * middle[row] + 65536 * high[row]
                code = (code + (-(folded + 1) // 2 if folded % 2 else folded // 2)) % 2**24
                column.append(lo + (code - 1) * step if code else None)
            found[signal["name"]].append(column)
            k += rows
    assert at == len(raw)
    return header, found


def refused(name):
    raise AssertionError(f"{name} is no JSON")


def furthest(values, column):
    """The largest difference of a column that was read and the one that was packed; infinite where gaps differ."""
    pairs = zip(values, column, strict=True)
    return max(
        (
            (0.0 if read is None else math.inf)
            if not math.isfinite(value)
            else math.inf
            if read is None
            else abs(read - value)
            for value, read in pairs
        ),
        default=0.0,
    )


MARKUP = re.compile(r"<(img|script|svg|iframe)\b", re.IGNORECASE)
