#!/usr/bin/python3
"""io/commands/packets.json beside the program's codec, the clients, and what is made of it.

    packets_test.py VECTORS_CPP
"""
import dataclasses
import json
import math
import re
import struct
import subprocess
import sys
import tempfile
import unittest

import client_test
import pose_stream
from client_test import APIDS, Values, bits
from packet_readers import Cosmos, Xtce

sys.path.insert(0, str(pose_stream.SOURCE / "tools"))
import hilcam_client as h  # noqa: E402
from packet_files.description import FORMATS, Description, read  # noqa: E402

GROUND = pose_stream.SOURCE / "tools/ground_systems"
COSMOS = GROUND / "openc3-cosmos-hilcam/targets/HILCAM"
ROUNDS = 100  # packets of a kind
ACCEPTED, BAD_ARGUMENT = 0, 6


def same(a, b):
    """Equal, or the same bits: NaN is itself, -0.0 is not 0.0."""
    return struct.pack(">d", a) == struct.pack(">d", b) if isinstance(a, float) else a == b


def encoded(description, command, **numbers):
    """A command's bytes by the description alone; what is not named has its default."""
    body = bytes((1, command.number))
    for field in (*description.header, *command.fields):
        if field.type == "reserved":
            body += bytes(field.bytes)
            continue
        default = field.raw.get("default", 0)
        values = numbers.get(field.name, default)
        values = values if isinstance(values, (list, tuple)) else [values]
        body += struct.pack(">" + FORMATS[field.type] * len(values), *values)
    packet = struct.pack(">HHH", description.identification, 0xC000 | numbers.get("sequence", 0) & 0x3FFF, len(body) + 2 - 1) + body
    return packet + h.crc16(packet).to_bytes(2, "big")


def judged(packets):
    """(status, what the program understood as bytes) of each."""
    lines = [line.split() for line in client_test.ask(client_test.CPP, [f"judge {packet.hex()}" for packet in packets])]
    return [(int(line[0]), bytes.fromhex(line[1]) if len(line) > 1 else b"") for line in lines]


def flat(value):
    return list(value) if isinstance(value, (list, tuple)) else [value]


class Commands(unittest.TestCase):
    def setUp(self):
        self.description = Description()

    def encoded_by_hilcam(self):
        """(description of the command, its numbers by their fields' names, its bytes as the program writes them)."""
        values, asked, lines = Values(11), [], []
        for kind, command in zip(h.COMMANDS, self.description.commands, strict=True):
            for _ in range(ROUNDS):
                made, numbers = values.command(kind)
                header = {"camera": values.unsigned(16), "sequence": values.unsigned(32)}
                asked.append((command, {**header, **self.named(made, numbers)}))
                lines.append(" ".join(["encode", "0", *map(bits, header.values()), f"{kind.FUNCTION:x}", *map(bits, numbers)]))
        packets = [bytes.fromhex(line) for line in client_test.ask(client_test.CPP, lines)]
        return [(*a, packet) for a, packet in zip(asked, packets, strict=True)]

    @staticmethod
    def named(made, numbers):
        if isinstance(made, h.Subscribe):
            return {"telemetry": numbers[0]}
        mine = vars(made)
        if isinstance(made, h.Settings):  # what is not set is written as 0
            return {"mask": numbers[0], **{name: 0.0 if value is None else value for name, value in mine.items()}}
        return dict(mine)

    def check(self, command, found, expected):
        self.assertEqual(set(found), set(expected), command.name)
        for name, value in expected.items():
            self.assertTrue(all(map(same, flat(found[name]), flat(value))), f"{command.name}.{name}: {found[name]}, {value}")

    def test_each_field_is_where_the_program_writes_it(self):
        for command, expected, packet in self.encoded_by_hilcam():
            self.assertEqual(len(packet), self.description.command_bytes(command), command.name)
            self.assertEqual(packet[7], command.number)
            found = {}
            for field in (*self.description.header, *command.fields):
                if field.type == "reserved":
                    self.assertEqual(packet[field.at:field.at + field.bytes], bytes(field.bytes))
                else:
                    found[field.name] = read(field, packet)
            self.check(command, found, expected)

    def test_a_description_with_two_fields_changed_about_is_found_out(self):
        raw = json.loads((pose_stream.SOURCE / "io/commands/packets.json").read_text())
        fields = next(c for c in raw["commands"] if c["name"] == "joint")["fields"]
        fields[3], fields[4] = fields[4], fields[3]
        with tempfile.NamedTemporaryFile("w", suffix=".json") as file:
            json.dump(raw, file)
            file.flush()
            self.description = Description(file.name)
        with self.assertRaises(AssertionError):
            self.test_each_field_is_where_the_program_writes_it()

    def test_defaults_are_accepted_and_understood_as_they_were_meant(self):
        packets = [encoded(self.description, command) for command in self.description.commands]
        for command, packet, (status, understood) in zip(self.description.commands, packets, judged(packets), strict=True):
            self.assertEqual(status, ACCEPTED, command.name)
            # What an action of the clock or a mask does not name is not examined and comes back as it stands without.
            if command.name not in ("settings", "clock"):
                self.assertEqual(understood.hex(), packet.hex(), command.name)

    def test_the_program_takes_what_is_inside_the_bounds_and_nothing_beyond(self):
        cases = []
        for command in self.description.commands:
            for field in command.fields:
                cases += [(command, field, *case) for case in self.cases_of(command, field)]
        self.assertGreater(len(cases), 60)
        packets = [encoded(self.description, command, **{**numbers, field.name: value}) for command, field, numbers, value, _ in cases]
        for (command, field, _, value, expected), (status, _) in zip(cases, judged(packets), strict=True):
            self.assertEqual(status, expected, f"{command.name}, {field.name} = {value}")

    @staticmethod
    def cases_of(command, field):
        """(other fields' numbers, the field's, status): at its bounds and just beyond."""
        raw = field.raw
        others = {name: next(f for f in command.fields if f.name == name).values[value]
                  for name, value in raw.get("examined_if", {}).items()}
        if command.name == "fault" and field.name != "kind":
            others["kind"] = 1
        if command.name == "fault":  # at a rate of 0 a kind's value is not examined
            others["rate"] = 0.0
        if field.values:
            known = set(field.values.values())
            return [(others, value, ACCEPTED if value in known else BAD_ARGUMENT) for value in range(max(known) + 2)]
        cases = []
        beyond = (lambda v, to: math.nextafter(v, to)) if field.type == "f64" else (lambda v, to: v + (1 if to > v else -1))
        for key, to in (("least", -math.inf), ("most", math.inf)):
            if key in raw:
                cases.append((others, raw[key], ACCEPTED))
                if field.type[0] != "u" or beyond(raw[key], to) >= 0:
                    cases.append((others, beyond(raw[key], to), BAD_ARGUMENT))
        if "most_length" in raw:
            most = float(raw["most_length"])
            for i in range(3):
                for value, status in ((most, ACCEPTED), (-most, ACCEPTED), (math.nextafter(most, math.inf), BAD_ARGUMENT),
                                      (math.nan, BAD_ARGUMENT)):
                    cases.append((others, [value if j == i else 0.0 for j in range(3)], status))
        if "norm_within" in raw:
            off = raw["norm_within"]
            for norm, status in ((1 + 0.999 * off, ACCEPTED), (1 - 0.999 * off, ACCEPTED), (1 + 1.001 * off, BAD_ARGUMENT),
                                 (1 - 1.001 * off, BAD_ARGUMENT)):
                cases.append((others, [0.5 * norm] * 4, status))
        return cases

    def test_the_ground_systems_files_read_them(self):
        xtce, cosmos = Xtce(GROUND / "yamcs/hilcam.xml"), Cosmos(COSMOS / "cmd_tlm/cmd.txt")
        for command, expected, packet in self.encoded_by_hilcam():
            elements = {name: value for field in (*self.description.header, *command.fields) if field.name
                        for (name, *_), value in zip(field.numbers(), flat(expected[field.name]), strict=True)}
            self.check(command, xtce.command(command.name, packet), elements)
            name, items = cosmos.identify(packet)
            self.assertEqual(name, command.name.upper())
            self.assertEqual(items.pop("CRC"), int.from_bytes(packet[-2:], "big"))
            found = {name.lower(): value for name, value in items.items() if not re.match("CCSDS_|VERSION|FUNCTION|RESERVED_", name)}
            self.check(command, found, elements)

    def test_cosmos_sends_what_is_accepted(self):
        """Its defaults, with the CRC that its interface adds."""
        cosmos, packets = Cosmos(COSMOS / "cmd_tlm/cmd.txt"), []
        for items in cosmos.packets.values():
            value, size = 0, 0
            for item in items[:-1]:
                number = struct.unpack(">Q", struct.pack(">d", float(item["default"])))[0] if item["kind"] == "FLOAT" else int(item["default"], 0)
                value, size = value << item["bits"] | number & (1 << item["bits"]) - 1, size + item["bits"]
            packet = value.to_bytes(size // 8, "big")
            packets.append(packet + h.crc16(packet).to_bytes(2, "big"))
        self.assertEqual([status for status, _ in judged(packets)], [ACCEPTED] * len(self.description.commands))


class Answers(unittest.TestCase):
    def setUp(self):
        self.description, self.values = Description(), Values(12)

    def encoded_by_hilcam(self):
        kinds = {0x101: h.Acknowledgement, 0x102: h.FrameReport, 0x103: h.Housekeeping}
        for answer in self.description.answers:
            made = [self.values.answer(kinds[answer.number]) for _ in range(ROUNDS)]
            # The clock's readings come with an accepted clock command alone, and without a reason.
            made = [dataclasses.replace(a, status=0, reason="") if isinstance(a, h.Acknowledgement) and a.clock else a for a in made]
            made = [dataclasses.replace(a, function=5) if isinstance(a, h.Acknowledgement) and not a.clock and a.function == 11 and
                    a.status == 0 else a for a in made]
            for a, packet in zip(made, client_test.encoded_by_hilcam(made, h.HILCAM), strict=True):
                yield answer, a, packet

    @staticmethod
    def expected(made):
        """The numbers that follow the header, by the client's names."""
        numbers = {f.name: getattr(made, f.name) for f in dataclasses.fields(made) if f.name != "count"}
        if isinstance(made, h.Acknowledgement):
            clock = numbers.pop("clock")
            numbers["function"] |= 0x80
            if clock:
                del numbers["reason"]
                numbers.update({name: value for name, value in vars(clock).items() if name != "departure_tai_ns"})
        return numbers

    def test_each_field_is_where_the_program_writes_it(self):
        for answer, made, packet in self.encoded_by_hilcam():
            expected, has_clock = self.expected(made), "arrival_tai_ns" in self.expected(made)
            found, behind = {}, 0
            for field in (*answer.fields, *(answer.then if has_clock else ())):
                if field.type == "text":
                    behind = field.at + found[field.raw["length_in"]]
                    found[field.name] = packet[field.at:behind].decode()
                elif field.name:
                    found[field.name], = read(field, packet, behind + field.at if behind else None)
            length = found.pop("reason_length", 0)
            self.assertEqual(len(packet), answer.bytes + length + (sum(f.bytes for f in answer.then) if has_clock else 0))
            if has_clock:
                self.assertEqual(found.pop("reason"), "")
            self.assertEqual(list(found), list(expected))
            for name, value in expected.items():
                self.assertTrue(same(found[name], value), f"{answer.name}.{name}: {found[name]}, {value}")

    def test_the_ground_systems_files_read_them(self):
        xtce, cosmos = Xtce(GROUND / "yamcs/hilcam.xml"), Cosmos(COSMOS / "cmd_tlm/tlm.txt")
        for answer, made, packet in self.encoded_by_hilcam():
            expected = self.expected(made)
            whole = answer.then_name if "arrival_tai_ns" in expected else answer.name
            container, parameters = xtce.answer(packet)
            name, items = cosmos.identify(packet)
            self.assertEqual((container, name), (whole, whole.upper()))
            self.assertEqual((parameters["apid"], parameters["count"]), (APIDS[type(made)], made.count))
            for field, value in expected.items():
                owner = whole if f"{whole}_{field}" in parameters else answer.name
                self.assertTrue(same(parameters[f"{owner}_{field}"], value), field)
                self.assertTrue(same(items[field.upper()], value), field)


class Clients(unittest.TestCase):
    def setUp(self):
        self.description = Description()

    def named(self, fields):
        """As a client names them: a mask by its bits where nothing else of the packet does."""
        names = [f.name for f in fields if f.type != "reserved"]
        if names == ["telemetry"]:
            return ["frame_reports", "housekeeping"]
        return [name for name in names if name not in ("mask", "reason_length")]

    def test_python_has_the_fields_in_their_order_with_these_defaults(self):
        for kind, command in zip(h.COMMANDS, self.description.commands, strict=True):
            self.assertEqual((kind.__name__.lower(), kind.FUNCTION), (command.name, command.number))
            self.assertEqual([f.name for f in dataclasses.fields(kind)], self.named(command.fields))
            for field in command.fields:
                mine = next((f.default for f in dataclasses.fields(kind) if f.name == field.name), None)
                if field.raw.get("default") is not None and mine is not None and "examined_if" not in field.raw:
                    self.assertEqual(flat(mine), flat(field.raw["default"]), f"{command.name}.{field.name}")
        kinds = (h.Acknowledgement, h.FrameReport, h.Housekeeping)
        for kind, answer in zip(kinds, self.description.answers, strict=True):
            names = [f.name for f in dataclasses.fields(kind) if f.name not in ("count", "clock")]
            self.assertEqual(names, self.named(answer.fields))
        readings = [f.name for f in dataclasses.fields(h.ClockReading) if f.name != "departure_tai_ns"]
        self.assertEqual(readings, self.named(self.description.answers[0].then))

    def test_c_has_the_fields_in_their_order_with_these_types(self):
        header = (pose_stream.SOURCE / "tools/client/hilcam_client.h").read_text()
        types = {"uint8_t": "u8", "uint16_t": "u16", "uint32_t": "u32", "uint64_t": "u64", "int64_t": "i64", "double": "f64",
                 "hilcam_fault_kind": "u8", "char": "text"}
        packets = [(c.name, c.fields) for c in self.description.commands if c.fields and c.name not in ("ping", "subscribe")]
        packets += [(a.name, a.fields) for a in self.description.answers]
        for name, fields in packets:
            body = re.search(r"typedef struct \{([^}]*)\} hilcam_" + name + ";", header)[1]
            body = re.sub(r"//.*", "", body)
            found = []
            for kind, declared in re.findall(r"(\w+)\s+([^;]+);", body):
                found += [(re.sub(r"\[.*", "", n.strip()), types.get(kind)) for n in declared.split(",")]
            found = [f for f in found if f[0] not in ("has_clock", "clock")]
            expected = [(f.name, f.type) for f in fields if f.type != "reserved" and f.name != "reason_length"]
            self.assertEqual(found, expected, name)

    def test_names_of_statuses_and_faults(self):
        self.assertEqual(dict(zip(h.STATUS_NAMES, range(99))), self.description.statuses)
        self.assertEqual({"none": 0, **h.FAULTS}, self.description.faults)


class Made(unittest.TestCase):
    def test_what_is_made_of_it_is_up_to_date(self):
        result = subprocess.run([sys.executable, str(pose_stream.SOURCE / "tools/make_packet_files.py"), "--check"],
                                capture_output=True, text=True)
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)

    def test_headings_of_the_document_say_how_long_payloads_are(self):
        text = (pose_stream.SOURCE / "docs/protocol.md").read_text()
        for command in Description().commands:
            size = sum(field.bytes for field in command.fields)
            if size:
                self.assertIn(f"\n### {command.number} {command.name} ({size} bytes)\n", text)
        for answer in Description().answers[1:]:
            self.assertRegex(text, rf"\(APID 0x{answer.number:03X}, {answer.bytes} bytes\)")


if __name__ == "__main__":
    client_test.CPP = sys.argv[1]
    unittest.main(argv=[sys.argv[0], *sys.argv[2:]], verbosity=2)
