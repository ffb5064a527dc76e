"""io/commands/packets.json and io/packets/image_packet.json, with the place of each field's bytes."""
import dataclasses
import json
import pathlib
import struct
from typing import Optional

SOURCE = pathlib.Path(__file__).resolve().parents[2]
FORMATS = {"u8": "B", "u16": "H", "u32": "I", "u64": "Q", "i64": "q", "f64": "d"}
PRIMARY_BYTES, CRC_BYTES = 6, 2
VERSION = 1  # byte 6


@dataclasses.dataclass(frozen=True)
class Field:
    """A field of the description. at: its first byte in the packet, or behind a text in what follows it."""
    name: str  # empty: reserved bytes
    type: str
    at: int
    bytes: int  # of all its elements; 0: a text
    raw: dict
    values: dict  # names and numbers that it can have; empty: any

    @property
    def label(self):
        return self.raw.get("label", self.name.replace("_", " ")) if self.name else "reserved"

    @property
    def bits(self):
        """Of one element."""
        return 8 * struct.calcsize(FORMATS[self.type])

    def numbers(self):
        """(name, default, least, most) of each element; least and most are None where there is no bound."""
        elements, default = self.raw.get("elements"), self.raw.get("default", 0)
        if elements is None:
            return [(self.name, default, self.raw.get("least"), self.raw.get("most"))]
        most = self.raw["most_length"] if "most_length" in self.raw else 1 + self.raw["norm_within"]
        # position_m: position_x_m; attitude_wxyz: attitude_w
        unit = self.name.removeprefix(self.label).replace("_" + "".join(elements), "")
        return [(f"{self.label}_{element}{unit}", default[i], -most, most) for i, element in enumerate(elements)]


@dataclasses.dataclass(frozen=True)
class Packet:
    name: str
    meaning: str
    number: int  # a command's function; an answer's APID
    kind: Optional[int]  # byte 7 of telemetry
    fields: tuple
    condition: dict  # fields' numbers with which `then` follows
    then_name: str
    then_meaning: str
    then: tuple

    @property
    def bytes(self):
        """Of the whole packet; of one with a text, without it and without what follows it."""
        last = self.fields[-1]
        return last.at + last.bytes + CRC_BYTES


class Description:
    def __init__(self, path=SOURCE / "io/commands/packets.json"):
        self.raw = json.loads(pathlib.Path(path).read_text())
        self.statuses, self.faults = self.raw["statuses"], self.raw["faults"]
        self.identification = self.raw["command"]["identification"]
        self.header = self._fields(self.raw["command"]["header"], PRIMARY_BYTES + 2)
        payload_at = self.header[-1].at + self.header[-1].bytes
        self.commands = [self._packet(raw, raw["function"], payload_at) for raw in self.raw["commands"]]
        self.answers = [self._packet(raw, raw["apid"], PRIMARY_BYTES + (1 if raw.get("kind") is None else 2))
                        for raw in self.raw["answers"]]

        image = json.loads((SOURCE / "io/packets/image_packet.json").read_text())
        self.image = self._packet(image, image["apid"], PRIMARY_BYTES)

    def command_bytes(self, command):
        payload = sum(field.bytes for field in command.fields)
        return self.header[-1].at + self.header[-1].bytes + payload + CRC_BYTES

    def _packet(self, raw, number, at):
        return Packet(raw["name"], raw["meaning"], number, raw.get("kind"), self._fields(raw["fields"], at), raw.get("if", {}),
                      raw.get("then_name", ""), raw.get("then_meaning", ""), self._fields(raw.get("then", []), 0))

    def _fields(self, raws, at):
        fields = []
        for raw in raws:
            kind = raw["type"]
            if kind == "reserved":
                size = raw["bytes"]
            elif kind == "text":
                size = 0
            else:
                size = struct.calcsize(FORMATS[kind]) * len(raw.get("elements", "1"))
            values = self.raw[raw["values_of"]] if "values_of" in raw else raw.get("values", {})
            fields.append(Field(raw.get("name", ""), kind, at, size, raw, values))
            at += size
        return tuple(fields)


def read(field, packet, at=None):
    """The numbers of a field, as a packet has them."""
    form = ">" + FORMATS[field.type] * (8 * field.bytes // field.bits)
    return struct.unpack_from(form, packet, field.at if at is None else at)
