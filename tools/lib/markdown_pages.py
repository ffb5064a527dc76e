"""The Markdown pages of the source tree: their headings, as GitHub makes anchors of them, and their links.

tools/make_site and tests/layout/documents_test.py look at pages by it. Standard library alone.
"""
import html
import re
import subprocess
import urllib.parse

FENCE = re.compile(r"^\s*(```|~~~)")
HEADING = re.compile(r"^#{1,6}\s+(.*?)\s*#*$")
LIST_ITEM = re.compile(r"^\s*([-*+]|\d+[.)])\s")
LINK = re.compile(r"\]\(\s*<?([^)\s>]+)>?(?:\s+\"[^\"]*\")?\s*\)|\b(?:href|src)=\"([^\"]+)\"")
OTHER_SITE = re.compile(r"[a-z][a-z+.-]*:|//")


def pages(top):
    """Every Markdown file of a source tree, new ones, too, that git does not ignore."""
    found = subprocess.run(["git", "-C", top, "ls-files", "-z", "--cached", "--others", "--exclude-standard", "*.md"],
                           capture_output=True, text=True, check=False)
    if found.returncode == 0:
        files = [top / name for name in found.stdout.split("\0") if name]
    else:  # a source package
        files = [p for p in top.rglob("*.md") if not {"build", "out"} & set(p.relative_to(top).parts[:1])]
    return sorted({p for p in files if p.is_file() and not p.is_symlink()})


def prose(text):
    """(number, line) of the lines of a page outside boxes of code; numbers begin with 1."""
    is_fenced = is_box = is_list = False
    before = ""
    for number, line in enumerate(text.split("\n"), 1):
        if FENCE.match(line):
            is_fenced = not is_fenced
        elif not is_fenced:
            if line.strip() and not line.startswith(" "):
                is_list = bool(LIST_ITEM.match(line))
            is_box = line.startswith("    ") and not is_list and (is_box or not before.strip())
            if not is_box:
                yield number, line
        before = line


def slug(text, separator="-"):
    """The anchor of a heading as GitHub makes it."""
    text = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", text)
    return re.sub(r"[^\w\- ]", "", text.lower()).strip().replace(" ", separator)


def anchors(text):
    """The anchors of a page. The second of two equal headings has a -1 behind it, and so on."""
    found, times = set(re.findall(r"\b(?:id|name)=\"([^\"]+)\"", text)), {}
    for _, line in prose(text):
        if match := HEADING.match(line):
            name = slug(match[1])
            times[name] = times.get(name, -1) + 1
            found.add(f"{name}-{times[name]}" if times[name] else name)
    return found


def links(text):
    """(line number, target) of a page's links and pictures, other sites' left out."""
    for number, line in prose(text):
        for match in LINK.finditer(re.sub(r"`[^`]*`", "", line)):
            target = html.unescape(match[1] or match[2])
            if not OTHER_SITE.match(target):
                yield number, target


def resolved(page, target):
    """(file, anchor) that a relative link of a page leads to; a folder is its README.md."""
    path, _, anchor = urllib.parse.unquote(target).partition("#")
    file = (page.parent / path).resolve() if path else page
    return (file / "README.md" if file.is_dir() and (file / "README.md").exists() else file), anchor


def fault(top, page, target, anchors_of):
    """What is wrong with a relative link of a page, or None. anchors_of: a page's anchors; None of what is no page."""
    file, anchor = resolved(page, target)
    if not file.exists() or top not in (file, *file.parents):
        return f"'{target}' is not there"
    known = anchors_of(file)
    if anchor and known is not None and anchor not in known:
        return f"'{target}': no such heading"
    return None
