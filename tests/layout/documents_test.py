#!/usr/bin/python3
"""The documents hold together.

- Each relative link of a page leads to a file, and to a heading, that is there.
- Each link to docs/decisions.md, and each mention of it in a source, carries the anchor of a record.
- Each record there has a date (year-month, newest first within its theme) and at most 120 words, and the
  index at the top names all of them in their order. There are four themes.
- The notebook is linked from docs/decisions.md alone.
- The table of docs/README.md has each page of docs/ and docs/tutorials/ once, with its words: to a fifth, and
  --write counts them anew.
- No line of a page is wider than 110 columns, but for as many as tests/layout/wide_lines.txt allows in that
  page. These numbers only go down: --write writes the smaller ones, and never a greater one.

Prints what is wrong with its place.
"""
import pathlib
import re
import subprocess
import sys

TOP = pathlib.Path(__file__).resolve().parents[2]
sys.dont_write_bytecode = True
sys.path.insert(0, str(TOP / "tools/lib"))
import markdown_pages

WIDTH = 110
WORDS = 120
ALLOWED = TOP / "tests/layout/wide_lines.txt"
DECISIONS = TOP / "docs/decisions.md"
TABLE = TOP / "docs/README.md"
# Tables that a program writes.
GENERATED = ("docs/configuration.md", "docs/man/", "tests/units.md")
SOURCES = {".h", ".hpp", ".c", ".cpp", ".py", ".yaml", ".cmake", ".txt", ".in", ".sh", ""}
DATE = re.compile(r"^\*(\d{4}-(?:0[1-9]|1[0-2]))\.\* ")
# A line that is one address of another site cannot be broken.
ADDRESS = re.compile(r"^\s*<https?://\S+>$")
# | [page.md](page.md) | 1,200 | ...
ROW = re.compile(r"^\| \[[^\]]+\]\(([\w./-]+)(?:#[\w-]+)?\) \| ([\d,]+) \|", re.MULTILINE)
MENTION = re.compile(r"decisions\.md(?:#([\w-]+))?")


def name_of(file):
    return file.relative_to(TOP).as_posix()


def wrong_links(page, text, anchors_of):
    for number, target in markdown_pages.links(text):
        if fault := markdown_pages.fault(TOP, page, target, anchors_of):
            yield f"{name_of(page)}:{number}: {fault}"
            continue
        file, anchor = markdown_pages.resolved(page, target)
        if file == DECISIONS and not anchor:
            yield f"{name_of(page)}:{number}: '{target}' has no anchor; accepted: that of the record which answers"
        if "docs/notebook" in file.as_posix() and page != DECISIONS and page.parent.name != "notebook":
            yield f"{name_of(page)}:{number}: '{target}': the notebook is linked from docs/decisions.md alone"


def wrong_mentions(records):
    """Sources that name docs/decisions.md without a record's anchor."""
    found = subprocess.run(["git", "-C", TOP, "grep", "-nI", "-F", "decisions.md"], capture_output=True, text=True, check=False)
    for line in found.stdout.splitlines():
        name, number, text = line.split(":", 2)
        if pathlib.Path(name).suffix not in SOURCES or name == "tests/layout/documents_test.py" or name.endswith(("wide_lines.txt", "words_baseline.txt")):
            continue
        for match in MENTION.finditer(text):
            if match[1] not in records:
                yield f"{name}:{number}: '{match[0]}' names no record of docs/decisions.md"


def records_of(text):
    """[theme, [(heading, body)]] of docs/decisions.md."""
    themes = []
    for part in re.split(r"^(?=##+ )", text, flags=re.MULTILINE)[1:]:
        heading, _, body = part.partition("\n")
        if heading.startswith("## "):
            themes.append((heading[3:], []))
        elif themes:
            themes[-1][1].append((heading[4:], body))
    return themes


def wrong_records(text):
    themes = records_of(text)
    if len(themes) != 4:
        yield f"docs/decisions.md: {len(themes)} themes; accepted: 4"
    for theme, records in themes:
        last = "9999-12"
        for heading, body in records:
            words, date = len(body.split()), DATE.match(body.strip())
            if words > WORDS:
                yield f"docs/decisions.md: '{heading}' has {words} words; accepted: {WORDS}"
            if not date:
                yield f"docs/decisions.md: '{heading}' does not begin with its date; accepted: *2026-11.*"
            elif date[1] > last:
                yield f"docs/decisions.md: '{heading}' is newer than the record before it in '{theme}'"
            last = date[1] if date else last
    index = re.findall(r"^- \[(.+)\]\(#[\w-]+\)$", text.split("\n## ")[0], re.MULTILINE)
    headings = [heading for _, records in themes for heading, _ in records]
    for heading in headings:
        if headings.count(heading) > 1 or index.count(heading) != 1:
            yield f"docs/decisions.md: '{heading}' is {headings.count(heading)} times a record, {index.count(heading)} times in the index"
    if not index or sorted(index) == sorted(headings) and index != headings:
        yield "docs/decisions.md: the index is not in the order of the records"


def words_of(text):
    """The words of a page, to two figures."""
    count = len(text.split())
    step = 10 ** max(len(str(count)) - 2, 0)
    return round(count / step) * step


def wrong_rows(texts):
    """Pages that the tables of docs/README.md lack, have twice, or give other words."""
    rows = [((TABLE.parent / row[1]).resolve(), int(row[2].replace(",", ""))) for row in ROW.finditer(texts[TABLE])]
    wanted = {page for page in texts if page.parent in (TOP / "docs", TOP / "docs/tutorials") and page != TABLE}
    for page in sorted(wanted | {page for page, _ in rows if page in texts}):
        said = [words for row, words in rows if row == page]
        count = words_of(texts[page])
        if len(said) != 1:
            yield f"docs/README.md: {name_of(page)} is {len(said)} times in the tables; accepted: once"
        elif abs(said[0] - count) > 0.2 * count:
            yield f"docs/README.md: {name_of(page)} has {count:,} words, not {said[0]:,}: documents_test.py --write"


def write_words(texts):
    """Counts the words of the tables of docs/README.md anew."""
    def counted(row):
        page = (TABLE.parent / row[1]).resolve()
        return row[0].replace(f"| {row[2]} |", f"| {words_of(texts[page]):,} |") if page in texts else row[0]

    texts[TABLE] = ROW.sub(counted, texts[TABLE])
    TABLE.write_text(texts[TABLE])


def wide_lines(text):
    return [number for number, line in enumerate(text.split("\n"), 1) if len(line) > WIDTH and not ADDRESS.match(line)]


def allowed_lines():
    pairs = (line.split(None, 1) for line in ALLOWED.read_text().splitlines() if line and not line.startswith("#"))
    return {name: int(count) for count, name in pairs}


def write(wide, allowed):
    """Writes the counts that have become smaller."""
    kept = {name: min(count, len(wide.get(name, []))) for name, count in allowed.items()}
    ALLOWED.write_text("# Lines wider than 110 columns that a page may have. Numbers only go down: documents_test.py --write\n"
                       + "".join(f"{count} {name}\n" for name, count in sorted(kept.items()) if count))


def wrong_widths(wide, allowed):
    for name in sorted({*wide, *allowed}):
        lines, most = wide.get(name, []), allowed.get(name, 0)
        if len(lines) > most:
            yield f"{name}: {len(lines)} lines wider than {WIDTH} columns; accepted: {most} (lines {', '.join(map(str, lines[:20]))})"
        elif len(lines) < most:
            yield f"{name}: {len(lines)} wide lines, and tests/layout/wide_lines.txt allows {most}: documents_test.py --write"


def main():
    texts = {page: page.read_text() for page in markdown_pages.pages(TOP)}
    if "--write" in sys.argv[1:]:
        write_words(texts)
    anchors = {page: markdown_pages.anchors(text) for page, text in texts.items()}
    wide = {name_of(page): lines for page, text in texts.items()
            if not name_of(page).startswith(GENERATED) and (lines := wide_lines(text))}
    if "--write" in sys.argv[1:]:
        write(wide, allowed_lines())
    faults = [line for page, text in texts.items() for line in wrong_links(page, text, anchors.get)]
    faults += wrong_mentions(anchors[DECISIONS])
    faults += wrong_records(texts[DECISIONS])
    faults += wrong_rows(texts)
    faults += wrong_widths(wide, allowed_lines())
    print(f"{len(texts)} pages, {sum(map(len, anchors.values()))} headings, {len(faults)} faults")
    print("\n".join(faults))
    sys.exit(1 if faults or len(texts) < 100 else 0)


main()
