# SPDX-License-Identifier: Apache-2.0
"""Woodcock's scene files as text."""


def quoted(text):
    text = text.replace("\\", "\\\\").replace('"', '\\"')
    return '"' + "".join(c if c >= " " else "\\u%04x" % ord(c) for c in text) + '"'


def path(text):
    """Woodcock expands $NAME and a leading ~ in paths."""
    text = text.replace("$", "$$")
    return quoted("./" + text if text.startswith("~") else text)


def number(value):
    return repr(int(value)) if float(value) == int(value) and abs(value) < 1e15 else repr(float(value))


def value(v):
    if isinstance(v, bool):
        return "true" if v else "false"
    if isinstance(v, (int, float)):
        return number(v)
    if isinstance(v, str):
        return v  # text that is TOML already
    if isinstance(v, dict):
        return "{ %s }" % ", ".join("%s = %s" % (key, value(x)) for key, x in v.items())
    return "[%s]" % ", ".join(value(x) for x in v)


def colour(c):
    """One number where it is grey."""
    c = [float(x) for x in c]
    return number(c[0]) if c[0] == c[1] == c[2] else value(c)


def matrix(rows):
    return value([[float(x) for x in row] for row in rows])


class Section:
    def __init__(self, heading):
        self.lines = ["", heading]

    def set(self, key, text):
        """`text` is TOML, or a number, flag, list or dict of such."""
        self.lines.append("%s = %s" % (key, value(text)))
        return self

    def text(self):
        return "\n".join(self.lines) + "\n"
