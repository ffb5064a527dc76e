#!/usr/bin/python3
"""Pages and comments are spelt right, and the British way.

Debian's codespell reads every Markdown page but the generated ones, and the comments of the four folders. It
knows common misspellings, not all words. Its table of British and American spellings is turned round, so that
it finds American ones. tests/layout/spelling.txt has the words that are right here, one a line, in small letters.

Prints what is wrong with its place; skipped (exit status 77) where codespell is missing.
"""
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

TOP = pathlib.Path(__file__).resolve().parents[2]
sys.dont_write_bytecode = True
sys.path.insert(0, str(TOP / "tools/lib"))
import markdown_pages

LAYERS = ("emulator", "io", "sensor", "render")
WORDS = TOP / "tests/layout/spelling.txt"
# Pages that a program writes of what the four folders say.
GENERATED = ("docs/configuration.md", "docs/man/")
# Spans of code, and addresses of other sites.
CODE = re.compile(r"`[^`\n]*`|https?://\S+")
# A string, a character, or a comment, whichever begins first.
TOKEN = re.compile(r'"(?:[^"\\\n]|\\.)*"|\'(?:[^\'\\\n]|\\.)\'|//[^\n]*|/\*.*?\*/', re.DOTALL)


def lines_only(text):
    """The line breaks of a text, so that what follows stays in its line."""
    return "\n" * text.count("\n")


def prose(text):
    """A page without its boxes and spans of code, each line in its place."""
    shown = dict(markdown_pages.prose(text))
    return "\n".join(CODE.sub("", shown.get(number, "")) for number in range(1, text.count("\n") + 2))


def comments(text):
    """The comments of a source, each in its line."""
    found, end = [], 0
    for token in TOKEN.finditer(text):
        found.append(lines_only(text[end:token.start()]))
        found.append(CODE.sub("", token[0]) if token[0].startswith("/") else lines_only(token[0]))
        end = token.end()
    return "".join(found)


def read_texts():
    """{file: what of it is read}."""
    texts = {}
    for page in markdown_pages.pages(TOP):
        if not page.relative_to(TOP).as_posix().startswith(GENERATED):
            texts[page] = prose(page.read_text())
    for layer in LAYERS:
        for source in (TOP / layer).rglob("*"):
            if source.suffix in (".h", ".cpp"):
                texts[source] = comments(source.read_text())
    return texts


def american(folder):
    """A dictionary for codespell that says the British spelling of American words; None where it has no table of them."""
    where = subprocess.run(["/usr/bin/python3", "-c", "import codespell_lib; print(codespell_lib.__path__[0])"],
                           capture_output=True, text=True, check=False)
    table = pathlib.Path(where.stdout.strip() or "/nowhere") / "data/dictionary_en-GB_to_en-US.txt"
    if not table.is_file():
        return None
    pairs = (line.split("->") for line in table.read_text().splitlines() if "->" in line)
    turned = folder / "american.txt"
    turned.write_text("".join(f"{us.split(',')[0].strip()}->{gb}\n" for gb, us in pairs))
    return turned


def faults(texts):
    """What codespell says of texts, {name: text}, as lines "name:line: word ==> what was meant"."""
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        for name, text in texts.items():
            file = folder / "texts" / name
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_text(text)
        turned = american(folder)
        dictionaries = ["--dictionary", "-"] + (["--dictionary", turned] if turned else [])
        said = subprocess.run(["codespell", *dictionaries, "--ignore-words", WORDS, "."], cwd=folder / "texts",
                              capture_output=True, text=True, check=False)
        if said.returncode not in (0, 65) and not said.stdout:
            sys.exit(f"codespell: {said.stderr}")
        return sorted(line.removeprefix("./") for line in said.stdout.splitlines() if "==>" in line)


def check_itself():
    """Mistakes are found in their lines, and none in code, or nothing below means anything."""
    page = "# A page\n\nThis is teh page of `teh` colours.\n\n    teh box\n"
    source = '#include "teh.h"\n// "a" and teh comment\nauto teh = "// teh";  // right\n/* two\nteh lines */\n'
    found = faults({"page.md": prose(page), "source.cpp": comments(source), "right.md": "Colours of a characterised lens."})
    assert [line.split(" ==> ")[0] for line in found] == ["page.md:3: teh", "source.cpp:2: teh", "source.cpp:5: teh"], found


def main():
    if shutil.which("codespell") is None:
        print("skipped: codespell is not installed")
        sys.exit(77)
    check_itself()
    texts = {file.relative_to(TOP).as_posix(): text for file, text in read_texts().items()}
    found = faults(texts)
    print(f"{len(texts)} files, {len(found)} faults")
    print("\n".join(found))
    sys.exit(1 if found or len(texts) < 1000 else 0)


main()
