#!/usr/bin/python3
"""Comments on declarations and rows of the manual are no fragments: they name their subject (CONTRIBUTING.md, "Style, by example").

"Of the lens." leaves a reader to guess what of the lens is meant. Refused are comments before declarations (all of a header, and those
that begin a line of a source), comments behind code, and meanings of docs/configuration.md that open with such a word. An opening like
"With a budget, returns ..." is accepted where a comma says that a sentence follows.

HARD names turns of phrase that make a reader go back, counted in all comments of the four folders and in Markdown; comment lines of
headers are at most 110 columns wide. words_baseline.txt holds how many of each a file still has. A file with more fails; one with fewer
is named, and `words_test.py --write` lowers its number. --write never raises one. To count everything again, after branches have been
merged or files renamed: delete words_baseline.txt, then `words_test.py --write`.

Prints how many were read, and what is wrong with place and text.
"""
import bisect
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

BASELINE = pathlib.Path(__file__).with_name("words_baseline.txt")
WIDEST = 110
FROM_ELSEWHERE = TOP / "sensor" / "convolution" / "pocketfft"
PAGES = ("README.md", "CONTRIBUTING.md", "docs/**/*.md", *(f"{layer}/**/*.md" for layer in LAYERS))
# A notebook keeps its words as they were written.
NOTEBOOK = TOP / "docs" / "notebook"
HARD = [(re.compile(pattern), reason) for pattern, reason in (
    # "those who", "a client, who" have an antecedent and pass.
    (r"(?i)(?:^|[.;:(] ?|\b(?:of|by|from|for|to|in|with|on|as) )who(?:se)?\b", "who is that? name the person, or the part of the program"),
    (r"\b(?:lies?|lying)\b", "is, stands, falls or rests says it; numbers are within a range"),
    # "LEAN mapping" is a method's name and passes.
    (r"\blean(?:s|t|ing)?\b", "a surface is tilted, a normal deviates"),
    (r"\b[Tt]old\b(?! apart)|\b[Tt]ells? of\b", "a value is passed, given, reported or known"),
    (r"\bhang(?:s|ing)? on\b", "a result depends on its inputs"),
    # What is taken must be one word, or "takes a slot for a frame" would count.
    (r"\b(?:takes?|took|taken) (?:it|them|one|this|these|that|those|the \w+) for (?:the|an?|its|their|those|what|one)\b",
     "mistakes it for, or treats it as"),
    (r"\bnone's\b", "a negation needs its subject"),
    (r"\b[Ll]ikewise\b", "say again what holds, or give both one comment"),
    (r"\b[Ss]o many\b(?! that)", "name the number"),
    (r"(?:^|[.;:] )(?!Of course)[Oo]f\b", "begin with the subject: 'the oldest of them', 'the thread pool's slot'"),
)]


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


def whole_comments(path):
    """Each run of comment lines of a source, as numbered lines of text."""
    run = []
    for number, line in enumerate(path.read_text().splitlines(), 1):
        if comment := re.match(r'(?:[^"/]|"(?:[^"\\]|\\.)*"|/(?!/))*//+ ?(.*)', line):
            run.append((number, comment[1].strip()))
        elif run:
            yield run
            run = []
    if run:
        yield run


def paragraphs(text):
    """Each paragraph, item or row of Markdown, as numbered lines of text without code, targets of links, and marks."""
    run, fenced = [], False
    for number, line in enumerate(text.splitlines() + [""], 1):
        fence = line.strip().startswith("```")
        fenced = fenced != fence
        code = fence or fenced or (not run and line.startswith("    "))
        apart = code or not line.strip() or re.match(r"\s*(?:[-*|#]|\d+\. )", line)
        if apart and run:
            yield run
            run = []
        if line.strip() and not code:
            line = re.sub(r"\]\([^)]*\)", "]", re.sub(r"`[^`]*`", "X", line.strip()))
            run += [(number, re.sub(r"^[-*#| ]+|^\d+\. ", "", line))]


def hard_words(runs):
    """Line, words and reason of each match of HARD in runs of numbered lines; words may stand on two lines."""
    for run in runs:
        begins, text = [], ""
        for _, line in run:
            begins.append(len(text))
            text += line + " "
        for pattern, reason in HARD:
            for match in pattern.finditer(text):
                at = bisect.bisect(begins, match.start() + len(match[0]) - len(match[0].lstrip(" .;:("))) - 1
                yield run[at][0], text[match.start():match.end() + 30].strip(" .;:("), reason


def wide_comments(text):
    """Line and width of each line of a header that has a comment and is too wide."""
    for number, line in enumerate(text.splitlines(), 1):
        if "//" in line and len(line) > WIDEST:
            yield number, len(line)


def to_shrink():
    """By kind and file, the faults that the baseline counts."""
    found = {}

    def add(kind, path, faults):
        if faults:
            found[kind, path.relative_to(TOP).as_posix()] = sorted(faults)

    for layer in LAYERS:
        for path in (TOP / layer).rglob("*"):
            if path.suffix in (".h", ".cpp") and FROM_ELSEWHERE not in path.parents:
                add("words", path, [(n, f"'{words}': {reason}") for n, words, reason in hard_words(whole_comments(path))])
                if path.suffix == ".h":
                    add("wide", path, [(n, f"{width} columns") for n, width in wide_comments(path.read_text())])
    for pattern in PAGES:
        for path in TOP.glob(pattern):
            if NOTEBOOK not in path.parents and FROM_ELSEWHERE not in path.parents:
                add("words", path, [(n, f"'{words}': {reason}") for n, words, reason in hard_words(paragraphs(path.read_text()))])
    return found


def read_baseline(text):
    return {(kind, name): int(count) for kind, count, name in (line.split() for line in text.splitlines() if not line.startswith("#"))}


def baseline_text(counts):
    head = "# What words_test.py still accepts: kind, count, file. Numbers only fall; `words_test.py --write` lowers them.\n"
    return head + "".join(f"{kind} {count} {name}\n" for (kind, name), count in sorted(counts.items(), key=lambda row: (row[0][1], row[0][0])))


def lowered(found, baseline):
    """The baseline that --write writes: the counts found, where they are lower; all of them when there is no baseline."""
    if baseline is None:
        return {key: len(faults) for key, faults in found.items()}
    return {key: min(count, len(found[key])) for key, count in baseline.items() if key in found}


def compare(found, baseline):
    """Faults where a file has more than its count, and rows of the baseline that can be lowered."""
    faults, lower = [], []
    for (kind, name), at in sorted(found.items()):
        allowed = baseline.get((kind, name), 0)
        if len(at) > allowed:
            faults.append(f"{name}: {len(at)} {kind}; accepted: {allowed} (words_baseline.txt)")
            faults += [f"    {name}:{line}: {text}" for line, text in at]
    for (kind, name), count in sorted(baseline.items()):
        if len(found.get((kind, name), ())) < count:
            lower.append(f"{name}: {len(found.get((kind, name), ()))} {kind}, the baseline has {count}")
    return faults, lower


def check_hard_words():
    """The counted rules find what they name, and pass what is good English."""
    def words_in(text):
        return [words for _, words, _ in hard_words([[(1, text)]])]
    for text in ("Who asks makes memory.", "The rest; whose it is.", "For who stops it.", "It lies in the cache.", "Parts that lean away.",
                 "It was told by the sink.", "One ray tells of all.", "The sum hangs on two rays.", "NAIF takes them for the same.",
                 "and none's tails", "Row likewise.", "Levels of so many triangles.", "Rays. Of these one is traced.", "slot: of the pool"):
        assert len(words_in(text)) == 1, (text, words_in(text))
    for text in ("A client, who waits for it.", "The value of whoever reads.", "those who have it", "For whom it is.", "LEAN mapping", "A clean boolean.",
                 "Both are told apart.", "The loop takes a slot for a frame.", "There are so many that it waits.", "Of course it is.",
                 "a list, of which one is read", "It relies on believing."):
        assert not words_in(text), (text, words_in(text))
    assert [n for n, _, _ in hard_words([[(7, "There are so"), (8, "many. It"), (9, "lies there.")]])] == [9, 7]
    page = "# Who waits\n\nText `lies` [there](#who-lies) and\nlies.\n\n```\nlies\n```\n\n    lies\n\n- One lies.\n| a | lies |\n"
    assert [n for n, _, _ in hard_words(paragraphs(page))] == [1, 4, 12, 13], list(hard_words(paragraphs(page)))
    assert list(wide_comments("int a;  // " + "b" * 100 + "\nint " + "c" * 120 + ";\nint d;  // e\n")) == [(1, 111)]
    counts = {("words", "a.h"): 2, ("wide", "a.h"): 1}
    assert read_baseline(baseline_text(counts)) == counts
    three, one = [(1, "x")] * 3, [(1, "x")]
    assert compare({("words", "a.h"): three}, counts)[0] and compare({("words", "b.h"): one}, {})[0]
    faults, lower = compare({("words", "a.h"): one}, counts)
    assert not faults and len(lower) == 2
    assert lowered({("words", "a.h"): one, ("words", "b.h"): three}, counts) == {("words", "a.h"): 1}
    assert lowered({("words", "a.h"): three}, counts) == {("words", "a.h"): 2}
    assert lowered({("words", "b.h"): three}, None) == {("words", "b.h"): 3}


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
    check_hard_words()


def main():
    check_itself()
    found = to_shrink()
    baseline = read_baseline(BASELINE.read_text()) if BASELINE.is_file() else None
    if sys.argv[1:] == ["--write"]:
        baseline = lowered(found, baseline)
        BASELINE.write_text(baseline_text(baseline))
    faults, lower = compare(found, baseline or {})
    read = 0
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
    hard = sum(len(at) for (kind, _), at in found.items() if kind == "words")
    wide = sum(len(at) for (kind, _), at in found.items() if kind == "wide")
    print(f"{read} comments on declarations and {len(rows)} meanings; {hard} hard words and {wide} wide comment lines in "
          f"{len({name for _, name in found})} files")
    if lower:
        print("\n".join([f"{len(lower)} rows can be lowered by {pathlib.Path(__file__).name} --write:", *lower]))
    print(f"{len(faults)} faults")
    print("\n".join(faults))
    sys.exit(1 if faults or read < 1000 or len(rows) < 100 else 0)


main()
