"""The face table that hilcam reads (docs/camera_face.md, "The table")."""
import json

from .binding import REFUSED
from .description import REGISTERS

VERSION = 1


def registers_of(evaluator):
    """Returns {address: (bytes, access)} of the device's registers; nodes that share one add up their access."""
    found = {}
    for name, node in evaluator.nodes.items():
        if node.tag not in REGISTERS or not evaluator.description.on_device(node):
            continue
        try:
            address, length = evaluator.address(name), evaluator.length(name)
        except REFUSED:
            continue
        before = found.get(address, (0, ""))
        access = node.text("AccessMode", "RO")
        found[address] = (max(before[0], length), "RO" if access == "RO" and before[1] in ("", "RO") else "RW")
    writable = {word for address, (length, access) in found.items() if access == "RW"
                for word in range(address >> 2, address + length + 3 >> 2)}
    for address, (length, access) in found.items():
        if access == "RO" and not writable.isdisjoint(range(address >> 2, address + length + 3 >> 2)):
            found[address] = (length, "RW")  # a part of it is another register
    return found


def self_clearing(binder):
    """Returns the registers of commands that hilcam does not act on: what is written there does not stay."""
    ev, found = binder.ev, []
    for name, node in ev.nodes.items():
        if node.tag != "Command":
            continue
        try:
            register = ev.terminal(name)
            if register is None or not binder.description.on_device(ev.nodes[register]):
                continue
            if ev.bits_in_memory(register) & binder.live:
                continue
            before = ev.raw(register)
            ev.set(name, binder._command_value(name))
            found.append({"at": binder.place(register), "command": ev.value(register)})
            ev.write_memory(ev.place(register), before)
        except REFUSED:
            continue
    return found


def table(binder, identity, memory, chunk_layout):
    description = binder.description
    registers = registers_of(binder.ev)
    for word in {row["at"]["address"] >> 2 for row in binder.rows}:
        registers.setdefault(4 * word, (4, "RW"))
    return {
        "hilcam_face": VERSION,
        "description": {"crc32": description.crc32, "bytes": len(description.xml), "vendor": description.vendor,
                        "model": description.model},
        "identity": identity,
        "camera": {"width_px": binder.camera.width, "height_px": binder.camera.height},
        "rows": binder.rows,
        "self_clearing": self_clearing(binder),
        "chunks": chunk_layout,
        "registers": [[address, length, access] for address, (length, access) in sorted(registers.items())],
        "memory": [[address, data.hex()] for address, data in memory],
    }


def write(path, content):
    """Writes the table with a row a line, addresses in hexadecimal."""
    def line(value):
        return json.dumps(value, ensure_ascii=True)
    with open(path, "w", encoding="ascii") as out:
        out.write("{\n")
        for number, (key, value) in enumerate(content.items()):
            end = ",\n" if number + 1 < len(content) else "\n"
            if isinstance(value, list) and value:
                out.write(f"{line(key)}: [\n" + ",\n".join(line(hexadecimal(row)) for row in value) + f"\n]{end}")
            else:
                out.write(f"{line(key)}: {line(hexadecimal(value))}{end}")
        out.write("}\n")


def hexadecimal(value, key=""):
    """Addresses and ids as texts of hexadecimal digits, which people compare with the description."""
    if isinstance(value, dict):
        return {k: hexadecimal(v, k) for k, v in value.items()}
    if isinstance(value, list):
        if value and isinstance(value[0], int) and len(value) > 1 and isinstance(value[-1], str) and key != "values":
            return [f"0x{value[0]:08x}", *value[1:]]
        return [hexadecimal(v) if not isinstance(v, list) or key not in ("points", "values") else v for v in value]
    if key in ("address", "crc32", "id", "image") and isinstance(value, int):
        return f"0x{value:08x}"
    return value
