"""The packets in the words of an OpenC3 COSMOS target: cmd.txt and tlm.txt.

Keywords: docs.openc3.com, "Command Configuration" and "Telemetry Configuration", 2026. `<%= target_name %>` is what the plug-in's user names
the target.
"""
from packet_files.description import CRC_BYTES, PRIMARY_BYTES

REMARK = "# Made by tools/make_packet_files.py from io/commands/packets.json and io/packets/image_packet.json.\n"
KINDS = {"u": "UINT", "i": "INT", "f": "FLOAT"}
UNITS = {"ns": "Nanoseconds", "s": "Seconds", "m": "Metres", "m/s": "Metres_per_second", "rad": "Radians",
         "rad/s": "Radians_per_second", "dB": "Decibels", "Hz": "Hertz", "bytes": "Bytes", "degrees Celsius": "Degrees_Celsius"}
ABBREVIATED = {"degrees Celsius": "degC"}


def quoted(text):
    return '"' + text.replace('"', "'") + '"'


def label(name):
    return name.upper().replace(" ", "_")


def modifiers(field):
    """Lines below a parameter or item: its states and its unit."""
    lines = [f"    STATE {label(name)} {value}" for name, value in field.values.items()]
    unit = field.raw.get("unit")
    if unit:
        lines.append(f"    UNITS {UNITS[unit]} {ABBREVIATED.get(unit, unit)}")
    return lines


def parameter(name, bits, kind, least, most, default, meaning, word="APPEND_PARAMETER"):
    return f"  {word} {name} {bits} {kind} {least} {most} {default} {quoted(meaning)}"


def constant(name, bits, value, meaning, word="APPEND_PARAMETER"):
    return parameter(name, bits, "UINT", value, value, value, meaning, word)


def command_parameters(field, number):
    """Lines of a command's field. number: of the reserved ones before it."""
    if field.type == "reserved":
        return [constant(f"RESERVED_{number}", 8 * field.bytes, 0, "Zeros")]
    lines = []
    for name, default, least, most in field.numbers():
        default = float(default) if field.type == "f64" else default
        lines.append(parameter(label(name), field.bits, KINDS[field.type[0]], "MIN" if least is None else least,
                               "MAX" if most is None else most, default, field.raw.get("text", field.label)))
        lines += modifiers(field)
    return lines


def commands(description):
    blocks = [REMARK]
    for command in description.commands:
        lines = [f"COMMAND <%= target_name %> {label(command.name)} BIG_ENDIAN {quoted(command.meaning)}",
                 constant("CCSDS_ID", 16, f"0x{description.identification:04X}", "Packet identification: telecommand, APID 0x100",
                          "APPEND_ID_PARAMETER"),
                 constant("CCSDS_SEQUENCE", 16, "0xC000", "Sequence control: unsegmented"),
                 constant("CCSDS_LENGTH", 16, description.command_bytes(command) - PRIMARY_BYTES - 1, "Bytes behind it, minus 1"),
                 constant("VERSION", 8, 1, "Protocol version"),
                 constant("FUNCTION", 8, command.number, "Function", "APPEND_ID_PARAMETER")]
        reserved = 0
        for field in (*description.header, *command.fields):
            reserved += field.type == "reserved"
            lines += command_parameters(field, reserved)
        lines.append(parameter("CRC", 8 * CRC_BYTES, "UINT", "MIN", "MAX", 0, "CRC-16/CCITT-FALSE, by the interface's CrcProtocol"))
        blocks.append("\n".join(lines) + "\n")
    return "\n".join(blocks)


def item(name, bits, kind, meaning):
    return f"  APPEND_ITEM {name} {bits} {kind} {quoted(meaning)}"


def identifying(name, bits, value, meaning):
    return f"  APPEND_ID_ITEM {name} {bits} UINT {value} {quoted(meaning)}"


def items(fields, known=None):
    """Lines of an answer's fields. known: the numbers by which the packet is told from others; a text is empty then."""
    lines, reserved = [], 0
    for field in fields:
        name, meaning = label(field.name), field.raw.get("text", field.label)
        if field.type == "reserved":
            reserved += 1
            lines.append(item(f"RESERVED_{reserved}", 8 * field.bytes, "UINT", "Zeros"))
        elif field.type == "text":
            if not known:
                lines += [item(name, 0, "STRING", meaning), f"    VARIABLE_BIT_SIZE {label(field.raw['length_in'])}"]
        elif known and field.name in known:
            lines.append(identifying(name, field.bits, known[field.name], meaning))
            lines += modifiers(field)
        else:
            lines += [item(name, field.bits, KINDS[field.type[0]], meaning), *modifiers(field)]
    return lines


def packet(answer, name, meaning, fields):
    lines = [f"TELEMETRY <%= target_name %> {label(name)} BIG_ENDIAN {quoted(meaning)}",
             identifying("CCSDS_ID", 16, f"0x{0x0800 | answer.number:04X}", f"Packet identification: telemetry, APID 0x{answer.number:03X}"),
             item("CCSDS_SEQUENCE", 16, "UINT", "Sequence control: 0xC000 + a 14-bit count"),
             item("CCSDS_LENGTH", 16, "UINT", "Bytes behind it, minus 1"), item("VERSION", 8, "UINT", "Protocol version")]
    if answer.kind is not None:
        lines.append(item("KIND", 8, "UINT", "Kind of telemetry"))
    return "\n".join([*lines, *fields, item("CRC", 8 * CRC_BYTES, "UINT", "CRC-16/CCITT-FALSE over all bytes before it")]) + "\n"


def image_packet(image):
    """A segment of a frame. Data of -16 bits reach to 16 bits before the packet's end."""
    crc_bits = 8 * CRC_BYTES
    return "\n".join([
        f"TELEMETRY <%= target_name %> {label(image.name)} BIG_ENDIAN {quoted(image.meaning)}",
        identifying("CCSDS_ID", 16, f"0x{0x0800 | image.number:04X}", f"Packet identification: telemetry, APID 0x{image.number:03X}"),
        item("CCSDS_SEQUENCE", 16, "UINT", "Sequence control: flags of the frame + a 14-bit count"),
        item("CCSDS_LENGTH", 16, "UINT", "Bytes behind it, minus 1"), *items(image.fields),
        item("DATA", -crc_bits, "BLOCK", "A part of the strip's payload"),
        f"  ITEM CRC {-crc_bits} {crc_bits} UINT {quoted('CRC-16/CCITT-FALSE over all bytes before it')}"]) + "\n"


def telemetry(description):
    blocks = [REMARK]
    for answer in description.answers:
        if answer.then:  # first, as it is told by more of its numbers
            blocks.append(packet(answer, answer.then_name, answer.then_meaning,
                                 [*items(answer.fields, answer.condition), *items(answer.then)]))
        blocks.append(packet(answer, answer.name, answer.meaning, items(answer.fields)))
    blocks.append(image_packet(description.image))
    return "\n".join(blocks)
