#!/usr/bin/python3
"""Files of the kinds that people bring, each with the right value of somebody else's: what hilcam makes of them.

    cases_test.py HILCAM SOURCE_DIR [PATTERN] [--table FILE.md]

Needs shared/cases beside the source folder, or where HILCAM_SHARED_CASES says; skipped without.
"""
import argparse
import fnmatch
import os
import pathlib
import sys
import tempfile

import measures

SKIPPED = 77


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("hilcam")
    parser.add_argument("source", type=pathlib.Path)
    parser.add_argument("pattern", nargs="?", default="*")
    parser.add_argument("--table", type=pathlib.Path)
    arguments = parser.parse_args()
    cases = pathlib.Path(os.environ.get("HILCAM_SHARED_CASES", arguments.source.parent / "shared/cases"))
    if not cases.is_dir():
        print(f"skipped: {cases} is not there")
        return SKIPPED
    import expected
    rows = [row for row in expected.ROWS if fnmatch.fnmatch(row.file, arguments.pattern)]
    lines, wrong = ["| file | right | source | now | |", "|---|---|---|---|---|"], 0
    with tempfile.TemporaryDirectory() as folder:
        program = measures.Program(arguments.hilcam, folder)
        for row in rows:
            right, found = row.measure(program, cases / row.file)
            wrong += not right
            lines.append(f"| {row.file} | {row.right} | {row.source} | {found} | {'right' if right else 'WRONG'} |")
            print(lines[-1], flush=True)
    if arguments.table:
        arguments.table.write_text("\n".join(lines) + "\n")
    print(f"{len(rows) - wrong} of {len(rows)} right")
    return 1 if wrong or not rows else 0


sys.exit(main())
