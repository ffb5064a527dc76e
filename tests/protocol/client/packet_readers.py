"""Packets read as others read them: by the XTCE file, and by the words of the COSMOS target.

Written from what XTCE 1.2 and COSMOS say, not from what made the files; they know as much of both as the files use, and fail on the rest.
"""
import re
import struct
import xml.etree.ElementTree as ET

NAMESPACE = "{http://www.omg.org/spec/XTCE/20180204}"


def bits_of(packet, at, count):
    return int.from_bytes(packet, "big") >> (8 * len(packet) - at - count) & ((1 << count) - 1)


def number(kind, raw, count):
    """kind: unsigned, signed or float."""
    if kind == "float":
        return struct.unpack(">d", raw.to_bytes(8, "big"))[0]
    return raw - (1 << count) if kind == "signed" and raw >> (count - 1) else raw


class Xtce:
    ENCODINGS = {"unsigned": "unsigned", "twosComplement": "signed", "IEEE754_1985": "float"}

    def __init__(self, path):
        root = ET.parse(path).getroot()
        every = {kind: {e.get("name"): e for e in root.iter(NAMESPACE + kind)} for kind in ("SequenceContainer", "MetaCommand")}
        self.containers, self.commands = every["SequenceContainer"], every["MetaCommand"]
        self.types = {kind: {e.get("name"): e for e in root.find(f".//{NAMESPACE}{kind}TypeSet")} for kind in ("Parameter", "Argument")}
        self.parameters = {e.get("name"): e.get("parameterTypeRef") for e in root.iter(NAMESPACE + "Parameter")}

    def _encoding(self, element):
        """(kind, bits) of a type; a text's and binary bits are the parameter that counts bytes, and bits more."""
        for form in ("Integer", "Float"):
            encoding = element.find(f"{NAMESPACE}{form}DataEncoding")
            if encoding is not None:
                return self.ENCODINGS[encoding.get("encoding")], int(encoding.get("sizeInBits"))
        dynamic = element.find(f".//{NAMESPACE}DynamicValue")
        adjustment = dynamic.find(NAMESPACE + "LinearAdjustment").attrib
        assert adjustment["slope"] == "8", adjustment
        kind = "text" if element.find(NAMESPACE + "StringDataEncoding") is not None else "binary"
        return kind, (dynamic.find(NAMESPACE + "ParameterInstanceRef").get("parameterRef"), int(adjustment.get("intercept", "0")))

    def answer(self, packet):
        """(name of the container, numbers by their parameters' names) of telemetry."""
        values, name, at = {}, "ccsds_packet", 0
        while name is not None:
            for entry in self.containers[name].find(NAMESPACE + "EntryList"):
                parameter = entry.get("parameterRef")
                kind, size = self._encoding(self.types["Parameter"][self.parameters[parameter]])
                count = 8 * values[size[0]] + size[1] if kind in ("text", "binary") else size
                raw = bits_of(packet, at, count)
                if kind in ("text", "binary"):
                    values[parameter] = raw.to_bytes(count // 8, "big")
                    if kind == "text":
                        values[parameter] = values[parameter].decode(errors="replace")
                else:
                    values[parameter] = number(kind, raw, count)
                at += count
            heirs = [heir for heir, element in self.containers.items() if self._follows(element, name, values)]
            assert len(heirs) <= 1, heirs
            found, name = name, heirs[0] if heirs else None
        assert at == 8 * len(packet), f"{found} describes {at} bits of {8 * len(packet)}"
        return found, values

    def _follows(self, element, name, values):
        base = element.find(NAMESPACE + "BaseContainer")
        if base is None or base.get("containerRef") != name:
            return False
        compared = base.findall(f"{NAMESPACE}RestrictionCriteria/{NAMESPACE}ComparisonList/{NAMESPACE}Comparison")
        if compared:
            return all((values[c.get("parameterRef")] == int(c.get("value"))) == (c.get("comparisonOperator", "==") == "==")
                       for c in compared)
        conditions = base.findall(f".//{NAMESPACE}ORedConditions/{NAMESPACE}Condition")
        assert conditions and all(c.find(NAMESPACE + "ComparisonOperator").text == "!=" for c in conditions)
        return any(values[c.find(NAMESPACE + "ParameterInstanceRef").get("parameterRef")] != int(c.find(NAMESPACE + "Value").text)
                   for c in conditions)

    def command(self, name, packet):
        """Arguments by their names; the fixed entries must be what the packet has, but for the sequence's count."""
        command, values, at = self.commands[name], {}, 0
        types = {a.get("name"): self.types["Argument"][a.get("argumentTypeRef")] for a in command.iter(NAMESPACE + "Argument")}
        for entry in command.find(f"{NAMESPACE}CommandContainer/{NAMESPACE}EntryList"):
            if entry.tag == NAMESPACE + "FixedValueEntry":
                count, fixed = int(entry.get("sizeInBits")), int(entry.get("binaryValue"), 16)
                raw = bits_of(packet, at, count)
                if entry.get("name") == "primary_header":
                    raw &= ~(0x3FFF << 16)
                assert raw == fixed, f"{name}: {entry.get('name')} is {raw:x}, described as {fixed:x}"
            else:
                kind, count = self._encoding(types[entry.get("argumentRef")])
                values[entry.get("argumentRef")] = number(kind, bits_of(packet, at, count), count)
            at += count
        assert at == 8 * (len(packet) - 2), f"{name}: {at} bits described"  # the CRC is the ground system's
        return values


class Cosmos:
    """cmd.txt or tlm.txt."""

    KINDS = {"UINT": "unsigned", "INT": "signed", "FLOAT": "float"}

    def __init__(self, path):
        self.packets, lines = {}, path.read_text().splitlines()
        for line in lines:
            words = re.findall(r'"[^"]*"|\S+', line)
            if not words or line.startswith("#"):
                continue
            if words[0] in ("COMMAND", "TELEMETRY"):
                assert line.split(">", 1)[0].endswith("target_name %") and words[-2] == "BIG_ENDIAN", line
                items = self.packets[words[-3]] = []
            elif words[0] in ("APPEND_PARAMETER", "APPEND_ID_PARAMETER"):
                items.append({"name": words[1], "bits": int(words[2]), "kind": words[3], "default": words[6], "id": words[0] == "APPEND_ID_PARAMETER"})
            elif words[0] in ("APPEND_ITEM", "APPEND_ID_ITEM"):
                items.append({"name": words[1], "bits": int(words[2]), "kind": words[3], "id": words[0] == "APPEND_ID_ITEM"})
                items[-1]["default"] = words[4] if items[-1]["id"] else None
            elif words[0] == "ITEM":  # from the packet's end
                assert int(words[2]) == -int(words[3]), line
                items.append({"name": words[1], "bits": int(words[3]), "kind": words[4], "id": False, "default": None})
            elif words[0] == "VARIABLE_BIT_SIZE":
                items[-1]["length_in"] = words[1]
            else:
                assert words[0] in ("STATE", "UNITS"), line

    def read(self, name, packet):
        """Values by their items' names, or None: what tells packets apart tells another one."""
        values, at = {}, 0
        for item in self.packets[name]:
            count = 8 * values[item["length_in"]] if "length_in" in item else item["bits"]
            if count < 0:  # up to so many bits before the end
                count = 8 * len(packet) + count - at
            raw = bits_of(packet, at, count)
            if item["kind"] == "BLOCK":
                values[item["name"]] = raw.to_bytes(count // 8, "big")
            elif item["kind"] == "STRING":
                values[item["name"]] = raw.to_bytes(count // 8, "big").decode(errors="replace")
            else:
                values[item["name"]] = number(self.KINDS[item["kind"]], raw, count)
            if item["id"] and values[item["name"]] != int(item["default"], 0):
                return None
            at += count
        assert at == 8 * len(packet), f"{name}: {at} bits described of {8 * len(packet)}"
        return values

    def identify(self, packet):
        """(name, values) of the first that it is."""
        return next((name, values) for name in self.packets if (values := self.read(name, packet)) is not None)
