#!/usr/bin/python3
"""Does what a tutorial's page tells its reader to do, and compares what is printed with what the page says.

    tutorial_test.py HILCAM SOURCE_DIR PAGE.md

Blocks of the page, in their order, in an empty folder, on a network of its own where the kernel allows
that, with the program on the path, the Python that runs this as python3, and the Python client beside its own modules:
    ```yaml FILE, ```python FILE    is written to FILE
    ```sh                           is run, all of a page's by one shell, which stops at the first command that fails
    ```text after an sh block       is what that block prints; "..." stands for any words, alone on a line for any lines
"""
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

BLOCK = re.compile(r"^```(\w+)(?: +(\S+))?\n(.*?)^```$", re.MULTILINE | re.DOTALL)
MOST_SECONDS = 240


def expected_pattern(text):
    """A regular expression for the whole of what a block prints."""
    pieces = []
    for line in text.rstrip("\n").split("\n"):
        if line.strip() == "...":
            pieces.append(r"(?:.*\n)*?")
        else:
            pieces.append(".*?".join(re.escape(part) for part in line.rstrip().split("...")) + r" *\n")
    return re.compile("".join(pieces))


def steps(page):
    """Files to write, and commands with what they are expected to print (None: anything)."""
    found, last = [], None
    for kind, name, body in BLOCK.findall(page):
        if kind == "text":
            assert last is not None and last["expected"] is None, "a text block without commands before it"
            last["expected"] = body
        elif kind == "sh":
            last = {"commands": body, "expected": None}
            found.append(last)
        else:
            assert name, f"a block of {kind} without a file name"
            last = None
            found.append({"file": name, "body": body})
    return found


def script_of(todo):
    lines = ["set -eu", "trap 'kill $(jobs -p) 2>/dev/null || true' EXIT"]
    for i, step in enumerate(todo):
        if "commands" in step:
            lines += [f"exec >output.{i} 2>&1", step["commands"]]
    return "\n".join(lines)


def run_page(hilcam, source, page):
    todo = steps(page.read_text())
    assert any("commands" in step for step in todo), "the page has no commands"
    folder = pathlib.Path(tempfile.mkdtemp(prefix="tutorial_"))
    try:
        for step in todo:
            if "file" in step:
                (folder / step["file"]).write_text(step["body"])
        (folder / "page.sh").write_text(script_of(todo))
        own_network = subprocess.run(["unshare", "-rn", "true"], capture_output=True).returncode == 0
        shell = ["unshare", "-rn", "bash", "-c", "ip link set lo up && exec bash page.sh"] if own_network else ["bash", "page.sh"]
        # Debian's Python has numpy and PIL; another one may come before it on the path.
        (folder / ".bin").mkdir()
        (folder / ".bin/python3").symlink_to(sys.executable)
        path = f"{pathlib.Path(hilcam).parent}:{folder}/.bin:{os.environ['PATH']}"
        environment = {**os.environ, "PATH": path, "PYTHONDONTWRITEBYTECODE": "1",
                       "PYTHONPATH": str(source / "tools/client")}
        status = subprocess.run(shell, cwd=folder, env=environment, stdin=subprocess.DEVNULL, timeout=MOST_SECONDS).returncode
        return judge(folder, todo, status)
    finally:
        shutil.rmtree(folder)


def judge(folder, todo, status):
    """The number of blocks that did not print what the page says; tells of each."""
    wrong = 0
    for i, step in enumerate(todo):
        if "commands" not in step:
            continue
        output = folder / f"output.{i}"
        if not output.exists():
            print(f"--- not reached:\n{step['commands']}")
            wrong += 1
            continue
        printed = output.read_text(errors="replace")
        if step["expected"] is not None and not expected_pattern(step["expected"]).fullmatch(printed):
            print(f"--- of:\n{step['commands']}--- the page says:\n{step['expected']}--- printed was:\n{printed}")
            wrong += 1
        last = printed
    if status != 0:
        print(f"--- the commands ended with status {status}; the last that was printed:\n{last}")
        wrong += 1
    return wrong


if __name__ == "__main__":
    sys.exit(1 if run_page(sys.argv[1], pathlib.Path(sys.argv[2]), pathlib.Path(sys.argv[3])) else 0)
