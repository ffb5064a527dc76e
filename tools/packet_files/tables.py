"""The byte tables of docs/protocol.md and docs/packets.md: each stands between two marks that name it."""
import re


def number(value):
    return f"{value:g}".replace("e+0", "e").replace("e+", "e") if isinstance(value, float) or abs(value) >= 1e6 else str(value)


def span(first, count, base):
    last = first + count - 1
    return base(first) if count == 1 else f"{base(first)}-{base(last)}"


def said(field):
    """Type, unit, bounds, values and meaning, in one cell."""
    raw, parts = field.raw, []
    if field.type == "reserved":
        return ""
    if field.type == "text":
        return raw["text"]
    count = len(raw.get("elements", "1"))
    parts.append((f"{count} " if count > 1 else "") + field.type + (f", {raw['unit']}" if "unit" in raw else ""))
    if "bits" in raw:
        parts.append("a mask: " + ", ".join(f"{bit} {name.replace('_', ' ')}" for name, bit in raw["bits"].items()))
    elif "values" in raw:
        parts.append(", ".join(f"{value} {name.replace('_', ' ')}" for name, value in raw["values"].items()))
    if "least" in raw or "most" in raw:
        parts.append(f"{number(raw['least'])} to {number(raw['most'])}")
    if "most_length" in raw:
        parts.append(f"length up to {number(raw['most_length'])}")
    if "norm_within" in raw:
        parts.append(f"unit quaternion (norm within {number(raw['norm_within'])} of 1)")
    if "text" in raw:
        parts.append(raw["text"])
    for other, value in raw.get("examined_if", {}).items():
        parts.append(f"not examined but for {other} {value}")
    return "; ".join(parts)


def rows(fields, base=str):
    lines = []
    for field in fields:
        label = field.label + (" " + ", ".join(field.raw["elements"]) if "elements" in field.raw else "")
        place = f"{base(field.at)}-" if field.type == "text" else span(field.at, field.bytes, base)
        lines.append(f"| {place} | {label} | {said(field)} |".replace("|  |", "| |"))
    return lines


HEAD = ["| bytes | field | unit, range |", "|---|---|---|"]
LENGTH = "| 4-5 | data length | u16; bytes after these six, minus 1 |"
VERSION = "| 6 | protocol version | u8; 1 |"
CRC = "| last 2 | CRC | as above |"


def command_header(description):
    functions = ", ".join(f"{command.number} {command.name}" for command in description.commands)
    return HEAD + [
        f"| 0-1 | packet identification | `0x{description.identification:04X}`: version 0, type 1 (telecommand), secondary header present, APID 0x100 |",
        "| 2-3 | sequence control | `0xC000` (unsegmented) + the low 14 bits of the sequence number |", LENGTH, VERSION,
        f"| 7 | function | u8; {functions} |", *rows(description.header), "| 14- | payload | by function, below; its length is fixed |",
        "| last 2 | CRC | CRC-16/CCITT-FALSE over all bytes before it (polynomial 0x1021, start 0xFFFF); `123456789` gives 0x29B1 |"]


def acknowledgement(answer):
    return HEAD + [
        f"| 0-1 | packet identification | `0x{0x0800 | answer.number:04X}`: version 0, type 0 (telemetry), secondary header present, APID 0x{answer.number:03X} |",
        "| 2-3 | sequence control | `0xC000` + a 14-bit count of acknowledgements |", LENGTH, VERSION, *rows(answer.fields), CRC]


def telemetry(answer):
    return HEAD + [f"| 0-5 | primary header | `0x{0x0800 | answer.number:04X}`, count, `0x{answer.bytes - 7:04X}` |", VERSION,
                   f"| 7 | kind | u8; {answer.kind} |", *rows(answer.fields), CRC]


def tables(description):
    """Lines of each table, by the name in its marks."""
    made = {"header": command_header(description)}
    made.update((command.name, HEAD + rows(command.fields)) for command in description.commands if command.fields)
    for answer in description.answers:
        made[answer.name] = acknowledgement(answer) if answer.kind is None else telemetry(answer)
        if answer.then:
            behind = answer.fields[-1].at  # the text before it is empty
            made[answer.then_name] = HEAD + rows(answer.then, lambda at: str(behind + at)) + [CRC]
    return made


def image_tables(description):
    """The table of image packets, as tables()."""
    image = description.image
    behind = image.fields[-1].at + image.fields[-1].bytes
    return {image.name: HEAD + [
        f"| 0-1 | packet identification | `0x0800` + APID (0x{image.number:03X}): telemetry with a secondary header |",
        "| 2-3 | sequence control | first `0x4000`, middle 0, last `0x8000`, only one `0xC000`; + 14-bit count |",
        LENGTH, *rows(image.fields), f"| {behind}- | data | a part of the strip's payload |",
        "| last 2 | CRC | with `crc: true`: over all bytes before it, as of [commands](protocol.md) |"]}


def with_tables(text, made, document="docs/protocol.md"):
    """The document with its tables made anew. made: as of tables(). Raises ValueError where marks and tables do not go together."""
    marked = re.findall(r"^<!-- packets: (\w+) -->$", text, re.M)
    if sorted(marked) != sorted(made):
        raise ValueError(f"{document} marks tables {sorted(marked)}; the description has {sorted(made)}")
    for name, lines in made.items():
        begin, end = f"<!-- packets: {name} -->\n", f"\n<!-- end of {name} -->\n"
        before, _, rest = text.partition(begin)
        _, found, after = rest.partition(end)
        if not found:
            raise ValueError(f"{document} has no '{end.strip()}' behind '{begin.strip()}'")
        text = before + begin + "\n".join(lines) + end + after
    return text
