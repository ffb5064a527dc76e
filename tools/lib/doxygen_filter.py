#!/usr/bin/python3
"""Gives a header to Doxygen: docs/Doxyfile calls it for each of them.

Our comments are plain: `// ...` over a declaration or behind it. Doxygen reads `///` and `///<`. The comment at a header's top is the
file's. Lines that are set in (tables, formulas, samples) stay as they stand. Signs that Doxygen would take for commands are escaped.
"""
import re
import sys

COMMENT = re.compile(r"^(\s*)// ?(.*)$")
# Code, then a comment behind it; a // inside of quotes is none.
BEHIND = re.compile(r"^((?:[^\"'/]|\"(?:[^\"\\]|\\.)*\"|'(?:[^'\\]|\\.)*'|/(?!/))*[^\s/])(\s+)//(?!/) ?(.+)$")


def escaped(text):
    return re.sub(r"([\\@<>&$#%])", r"\\\1", text)


def block(indent, lines, is_file):
    """A comment over a declaration, as Doxygen's."""
    out = [indent + "/// \\file"] if is_file else []
    fixed = False
    for line in lines:
        wants = bool(re.match(r"\s{2,}\S|\|", line))
        if wants != fixed:
            out.append(indent + ("/// \\verbatim" if wants else "/// \\endverbatim"))
            fixed = wants
        out.append(indent + "/// " + (line if wants else escaped(line)))
    if fixed:
        out.append(indent + "/// \\endverbatim")
    return out


def filtered(text):
    lines, out, i = text.split("\n"), [], 0
    is_first = True
    while i < len(lines):
        match = COMMENT.match(lines[i])
        if match:
            indent, body = match[1], []
            while i < len(lines) and (line := COMMENT.match(lines[i])):
                body.append(line[2])
                i += 1
            # A banner belongs to several declarations, a comment before an empty line to none.
            loose = body[0].startswith("---") or (i < len(lines) and not lines[i].strip() and not is_first)
            out += [f"{indent}// {line}" for line in body] if loose else block(indent, body, is_first)
            is_first = False
            continue
        match = BEHIND.match(lines[i])
        # Enumerators, members and constants; what closes a scope is no declaration.
        if match and re.search(r"[,;]$", match[1]) and "#" not in match[1][:1]:
            out.append(f"{match[1]}{match[2]}///< {escaped(match[3])}")
        else:
            out.append(lines[i])
        i += 1
    return "\n".join(out)


sys.stdout.write(filtered(open(sys.argv[1], encoding="utf-8").read()))
