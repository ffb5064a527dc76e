#!/usr/bin/python3
"""Comments on declarations and rows of the manual are no fragments: they name their subject (CONTRIBUTING.md, "Style, by example").

"Of the lens." leaves a reader to guess what of the lens is meant. Refused are comments before declarations (all of a header, and those
that begin a line of a source), comments behind code, and meanings of docs/configuration.md that open with such a word. An opening like
"With a budget, returns ..." is accepted where a comma says that a sentence follows.

Prints how many were read, and what is wrong with place and text.
"""
import pathlib
import re
import sys

TOP = pathlib.Path(__file__).resolve().parents[2]
LAYERS = ("emulator", "io", "sensor", "render")
# No sentence of ours that reads alone begins with these.
NEVER = set("of whose what who how whether than".split())
# These begin a sentence only where its clause follows behind a comma.
WITH_COMMA = set("""
    after as at before beside between by during for from in inside into on outside over through to under until when where which
    with within without
""".split())
# Behind code a phrase is enough, if it says what the value is: "at the ground" stands beside a pressure, "of the lens" beside anything.
TRAILING = NEVER | {"as", "with"}


def opening(text):
    return re.split(r"[\s,.:;]", text.strip(), maxsplit=1)[0].lower()


def dangles_before(text):
    """Whether a comment before a declaration opens as a fragment, or is a line of dashes that a banner lost."""
    if re.fullmatch(r"-{10,}", text.strip().rsplit(" ", 1)[-1]):
        return True
    word = opening(text)
    if word in NEVER:
        return True
    return word in WITH_COMMA and "," not in re.split(r"\. |\.$", text, maxsplit=1)[0]


def dangles_behind(text):
    """Whether a comment behind code, or a row of the manual, opens as a fragment."""
    return opening(text) in TRAILING


def comments(path):
    """Place, text, and whether it stands behind code, of each comment on a declaration."""
    lines = path.read_text().splitlines()
    i = 0
    while i < len(lines):
        begin = i
        whole = re.match(r"(\s*)// ?(.*)", lines[i])
        if whole:
            text = []
            while i < len(lines) and (line := re.match(r"\s*// ?(.*)", lines[i])):
                text.append(line[1])
                i += 1
            if path.suffix == ".h" or not whole[1]:
                yield begin + 1, " ".join(text), False
            continue
        behind = re.match(r'(?:[^"/]|"(?:[^"\\]|\\.)*"|/(?!/))*[^\s/"]\s*//(?!/) ?(.+)', lines[i])
        # One that goes on in the next line is read there as a comment before code: its first line counts.
        if behind:
            yield begin + 1, behind[1], True
            while i + 1 < len(lines) and re.match(r"\s{20,}// ?", lines[i + 1]):
                i += 1
        i += 1


def meanings(path):
    for number, line in enumerate(path.read_text().splitlines(), 1):
        if line.startswith("| `"):
            yield number, line.strip().strip("|").split(" | ")[-1].strip()


def check_itself():
    """The rules tell fragments from sentences, or nothing below means anything."""
    for text in ("Of the sphere that holds it.", "Whose three times are one.", "With light.", "What is asked for.", "In the order of the help.",
                 "--- stage 1 ----------------------"):
        assert dangles_before(text), text
    for text in ("The radius of the sphere, of which ...", "With a budget, returns what is left.", "In lockstep, the last frame's time."):
        assert not dangles_before(text), text
    for text in ("of the lens", "as the camera has it", "with light"):
        assert dangles_behind(text), text
    for text in ("radius of the lens", "at the ground", "by node"):
        assert not dangles_behind(text), text


def main():
    check_itself()
    faults, read = [], 0
    for layer in LAYERS:
        for path in sorted(p for p in (TOP / layer).rglob("*") if p.suffix in (".h", ".cpp")):
            for line, text, behind in comments(path):
                read += 1
                if (dangles_behind if behind else dangles_before)(text):
                    faults.append(f"{path.relative_to(TOP).as_posix()}:{line}: '{text[:70]}' opens as a fragment; "
                                  "accepted: a sentence or phrase that names its subject")
    manual = TOP / "docs" / "configuration.md"
    rows = list(meanings(manual))
    for line, text in rows:
        if dangles_behind(text):
            faults.append(f"docs/configuration.md:{line}: the meaning '{text[:70]}' opens as a fragment; accepted: one that reads alone")
    print(f"{read} comments on declarations and {len(rows)} meanings; {len(faults)} fragments")
    print("\n".join(faults))
    sys.exit(1 if faults or read < 1000 or len(rows) < 100 else 0)


main()
