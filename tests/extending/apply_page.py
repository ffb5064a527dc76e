#!/usr/bin/python3
"""Applies what a page says to the sources: apply_page.py PAGE SOURCES OUT HEADING...

Takes the blocks of the page's parts of these headings, in their order. A line "`path`, new:" stands before a block that is a new file, a
line "`path`:" before differences of one that is there: blocks of ```diff, whose lines without + stand in the file, once, in that order.
OUT gets the new files and the changed ones, as they are then; what is there already and the same is left untouched. Says which block does
not fit, and fails.
"""
import pathlib
import re
import sys


def blocks_of(page, heading):
    """(path, is_new, lines of the block) for each block of a part."""
    part = re.search(rf"^## {re.escape(heading)}$(.*?)(?=^## |\Z)", page, re.MULTILINE | re.DOTALL)
    if not part:
        sys.exit(f"the page has no part '{heading}'")
    path, is_new, block = None, False, None
    for line in part.group(1).splitlines():
        named = re.fullmatch(r"`([\w./]+)`(, new)?:", line)
        if block is None and named:
            path, is_new = named.group(1), named.group(2) is not None
        elif block is None and line.startswith("```"):
            block = []
        elif line == "```":
            yield path, is_new, block
            block = None
        elif block is not None:
            block.append(line)


def applied(text, block, path):
    """The text after a difference."""
    before = "\n".join(line[1:] for line in block if line[0] in " -") + "\n"
    after = "\n".join(line[1:] for line in block if line[0] in " +") + "\n"
    count = ("\n" + text).count("\n" + before)
    if count != 1:
        sys.exit(f"{path} has these lines {count} times; the page's difference wants them once:\n{before}")
    at = ("\n" + text).index("\n" + before)
    return text[:at] + after + text[at + len(before):]


def main():
    page, sources, out, headings = pathlib.Path(sys.argv[1]).read_text(), pathlib.Path(sys.argv[2]), pathlib.Path(sys.argv[3]), sys.argv[4:]
    files = {}
    for heading in headings:
        for path, is_new, block in blocks_of(page, heading):
            if is_new:
                if (sources / path).exists():
                    sys.exit(f"{path} is there already; the page has it as new")
                files[path] = "\n".join(block) + "\n"
            else:
                text = files[path] if path in files else (sources / path).read_text()
                files[path] = applied(text, block, path)
    for path, text in files.items():
        file = out / path
        file.parent.mkdir(parents=True, exist_ok=True)
        if not file.exists() or file.read_text() != text:
            file.write_text(text)


main()
