#!/usr/bin/python3
"""Makes what describes hilcam's packets to others from io/commands/packets.json and io/packets/image_packet.json:

    tools/make_packet_files.py            writes the tables of docs/protocol.md and docs/packets.md and the files of tools/ground_systems
    tools/make_packet_files.py --check    writes nothing; says which of them are not as they would be made, status 1

Needs Python's standard library alone.
"""
import argparse
import pathlib
import sys

from packet_files import cosmos, tables, xtce
from packet_files.description import SOURCE, Description


def made(description):
    """The text of each file, by its path in the repository."""
    document = pathlib.Path("docs/protocol.md")
    files = {document: tables.with_tables((SOURCE / document).read_text(), tables.tables(description))}
    images = pathlib.Path("docs/packets.md")
    files[images] = tables.with_tables((SOURCE / images).read_text(), tables.image_tables(description), str(images))
    files[pathlib.Path("tools/ground_systems/yamcs/hilcam.xml")] = xtce.document(description)
    targets = pathlib.Path("tools/ground_systems/openc3-cosmos-hilcam/targets/HILCAM/cmd_tlm")
    files[targets / "cmd.txt"] = cosmos.commands(description)
    files[targets / "tlm.txt"] = cosmos.telemetry(description)
    return files


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--check", action="store_true")
    check = parser.parse_args().check
    stale = 0
    for path, text in made(Description()).items():
        file = SOURCE / path
        if file.exists() and file.read_text() == text:
            continue
        stale += 1
        print(f"{path}: {'not as tools/make_packet_files.py makes it' if check else 'written'}")
        if not check:
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_text(text)
    sys.exit(1 if check and stale else 0)


main()
