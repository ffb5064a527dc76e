#!/usr/bin/python3
"""Writes the table of GenICam features into docs/genicam.md, from the description that a running camera serves:

    arv-tool-0.8 --address=127.0.0.1 genicam > camera.xml
    tools/make_feature_table.py camera.xml docs/genicam.md

Needs Python's standard library alone.
"""
import pathlib
import sys
import xml.etree.ElementTree as ET

BEGIN, END = "<!-- features -->\n", "\n<!-- end of features -->\n"
TYPES = {"Integer": "integer", "Float": "float", "Enumeration": "enumeration", "Boolean": "boolean", "Command": "command", "StringReg": "string"}
# Names that the Standard Features Naming Convention does not have.
LOCKS = {"TLParamsLocked": "; locked while streaming", "ExposureAutoReg": "; locked while ExposureAuto is on",
         "AcquisitionFrameRateFixed": "; locked unless AcquisitionFrameRateEnable",
         "SequencerIsNotConfigured": "; locked unless configuring",
         "SequencerConfigurationModeReg": "; locked while configuring",
         "SequencerModeReg": "; locked while SequencerMode"}
MOST_ENTRIES = 20  # longer lists are left to the manual
OWN_CATEGORIES = {"StatisticsControl", "FaultControl"}
OWN = {"ChunkPoseSequence", "ChunkPoseTime", "ChunkExposureMid", "ChunkTriggerSequence", "ChunkFaults",
       "AcquisitionResultingFrameRate", "ResultingFrameRate", "PtpTimeScale", "PtpCurrentUtcOffset", "PtpSteps"}


def plain(element):
    """Tags without their namespace."""
    for node in element.iter():
        node.tag = node.tag.split("}")[-1]
    return element


def access(feature, nodes):
    """read, write, or read, write; and when it cannot be written."""
    kind = feature.tag
    if kind == "Command":
        return "write"
    imposed = feature.findtext("ImposedAccessMode")
    register = nodes.get(feature.findtext("pValue", ""), feature)
    mode = imposed or register.findtext("AccessMode") or ("RO" if feature.find("Value") is not None else "RW")
    words = {"RO": "read", "WO": "write", "RW": "read, write"}[mode]
    lock = feature.findtext("pIsLocked")
    if lock is None or mode == "RO":
        return words
    return words + LOCKS.get(lock, f"; locked by {lock}")


def rows(text):
    """Lines of the tables, a category each."""
    root = plain(ET.fromstring(text))
    nodes = {node.get("Name"): node for node in root if node.get("Name")}
    lines = []
    for category in nodes["Root"].findall("pFeature"):
        lines += ["", f"**{category.text}**", "", "| feature | type | access | meaning |", "|---|---|---|---|"]
        for reference in nodes[category.text].findall("pFeature"):
            feature = nodes[reference.text]
            if feature.tag == "Category":
                continue
            own = category.text in OWN_CATEGORIES or reference.text in OWN
            meaning = feature.findtext("ToolTip", "")
            unit = feature.findtext("Unit")
            entries = [entry.get("Name") for entry in feature.findall("EnumEntry")]
            meaning += (f" [{unit}]" if unit else "") + (f": {', '.join(entries)}" if 0 < len(entries) <= MOST_ENTRIES and "PixelFormat" not in reference.text else "")
            lines.append(f"| `{reference.text}`{' *' if own else ''} | {TYPES[feature.tag]} | {access(feature, nodes)} | {meaning} |")
    return lines[1:]


def with_table(document, description):
    """The document with its tables made anew from a description."""
    before, _, rest = document.partition(BEGIN)
    _, found, after = rest.partition(END)
    if not found:
        raise ValueError("docs/genicam.md has no marks of the features")
    return before + BEGIN + "\n".join(rows(description)) + END + after


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    document = pathlib.Path(sys.argv[2])
    document.write_text(with_table(document.read_text(), pathlib.Path(sys.argv[1]).read_text()))


if __name__ == "__main__":
    main()
