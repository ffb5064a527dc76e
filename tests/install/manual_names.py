"""The files that the pages of an installed manual name: each is there, or its sentence says that it is the source tree's.

A name is a link's target, or a word that begins with a folder of the source tree. It is sought beside the page, in the manual's
folder, among the installed headers, and, of folders of the prefix, in the prefix. "Source tree" in a paragraph speaks for that
paragraph, at its end for the list, table or box that follows, and in a heading for its section; a page with PAGE_MARK is about the
source tree as a whole.
"""
import pathlib
import re

PAGE_MARK = "Files named on this page are those of the source tree."
MARK = re.compile(r"\bsource\s+tree\b", re.IGNORECASE)
LINK = re.compile(r"\]\(([^)#\s]+)[^)]*\)")
ADDRESS = re.compile(r"[a-z]+://\S*|\b[a-z]+:[^\s)]*@\S*")
WORD = re.compile(r"(?<![\w./~$\"-])(?:build|cmake|configs|docs|emulator|io|render|sensor|tests|tools)/[\w./*-]*\w"
                  r"|(?<![\w./~$-])(?:bin|include|lib|libexec|share)/[\w./@-]*hilcam[\w./@-]*\w"
                  r"|(?<![\w./-])(?:CONTRIBUTING\.md|CMakeLists\.txt|Containerfile)\b")
# Folders under which a part's text is a line of a box, not a file: of Linux's gadgets, and what users name themselves.
OTHERS = re.compile(r"configs/c\.1\b")


def pages(prefix):
    """Every text of the manual below a prefix; links to folders are not followed."""
    doc = prefix / "share/doc"
    found = [p for p in doc.rglob("*") if p.is_file() and (p.suffix == ".md" or p.name == "NOTICE")]
    found += (prefix / "share/hilcam").rglob("*.md")
    return sorted(found + list((prefix / "share/man").rglob("*.1")))


def paragraphs(text):
    """(paragraph, whether the source tree is spoken of) of a page."""
    section_is_marked, before = False, ""
    for paragraph in re.split(r"\n\s*\n", text):
        if paragraph.startswith("#"):
            section_is_marked = bool(MARK.search(paragraph.split("\n")[0]))
        follows = paragraph.startswith(("    ", "|", "- ", "```")) and before.rstrip().endswith(":")
        yield paragraph, section_is_marked or bool(MARK.search(paragraph)) or (follows and bool(MARK.search(before)))
        if not follows:
            before = paragraph


def names_in(paragraph):
    text = ADDRESS.sub("", paragraph)
    links = [target for target in LINK.findall(text) if not re.match(r"[a-z]+:", target)]
    return links, [w for w in WORD.findall(LINK.sub("]", text)) if not OTHERS.match(w)]


def is_there(name, page, prefix):
    roots = (page.parent, prefix / "share/doc/hilcam", prefix / "include/hilcam", prefix)
    return any(root.exists() and (any(root.glob(name)) if "*" in name else (root / name).exists()) for root in roots)


def missing_names(page, text, prefix):
    """A line for each name of a page that leads nowhere and is not marked as the source tree's."""
    if PAGE_MARK in re.sub(r"\s+", " ", text):
        return []
    missing = []
    for paragraph, is_marked in paragraphs(text):
        links, words = names_in(paragraph)
        lost = [t for t in links if not (page.parent / t).exists()]
        lost += [] if is_marked else [w for w in words if not is_there(w, page, prefix)]
        missing += [f"{page.relative_to(prefix)}: {name}" for name in lost]
    if "/usr/share/doc" in text:
        missing.append(f"{page.relative_to(prefix)}: /usr/share/doc, which is not every prefix's")
    return missing


def missing_in(prefix):
    return [line for page in pages(prefix) for line in missing_names(page, page.read_text(), prefix)]


if __name__ == "__main__":
    import sys
    print("\n".join(missing_in(pathlib.Path(sys.argv[1]))))
