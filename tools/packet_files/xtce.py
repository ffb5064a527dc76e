"""The packets as an XTCE 1.2 document (OMG formal/20-05-02, namespace of 2018-02-04), which Yamcs and others load.

Commands end where their CRC begins, which the ground system appends; their length fields count it.
"""
import struct
import xml.etree.ElementTree as ET

from packet_files.description import CRC_BYTES, PRIMARY_BYTES, VERSION

NAMESPACE = "http://www.omg.org/spec/XTCE/20180204"
REMARK = " Made by tools/make_packet_files.py from io/commands/packets.json and io/packets/image_packet.json. "
# Name and bits of the parts of a Space Packet's primary header (CCSDS 133.0-B-2, 4.1.3).
PRIMARY = (("version", 3), ("type", 1), ("secondary_header", 1), ("apid", 11), ("sequence_flags", 2), ("count", 14), ("length", 16))
MOST_REASON_BYTES = 96


class Types:
    """The types of one set, each made once. kind: Parameter or Argument."""

    def __init__(self, parent, kind):
        self.set, self.kind, self.made = ET.SubElement(parent, f"{kind}TypeSet"), kind, {}

    def unsigned(self, bits):
        return self._made(f"u{bits}", "Integer", bits, "unsigned", "", None, None)

    def of(self, field, owner, least=None, most=None):
        """The name of the type of a field's numbers."""
        unit = field.raw.get("unit", "")
        if field.values:
            return self._enumerated(f"{owner}_{field.name}_values", field)
        form, encoding = {"f": ("Float", "IEEE754_1985"), "i": ("Integer", "twosComplement"),
                          "u": ("Integer", "unsigned")}[field.type[0]]
        name = field.type + ("_" + unit.replace("/", "_per_").replace(" ", "_") if unit else "")
        if least is not None or most is not None:
            name = f"{owner}_{field.name}"
        return self._made(name, form, field.bits, encoding, unit, least, most)

    def text(self, name, length_reference):
        element = ET.SubElement(self.set, f"String{self.kind}Type", name=name)
        ET.SubElement(element, "UnitSet")
        size = ET.SubElement(ET.SubElement(element, "StringDataEncoding", encoding="UTF-8"), "Variable",
                             maxSizeInBits=str(8 * MOST_REASON_BYTES))
        dynamic = ET.SubElement(size, "DynamicValue")
        ET.SubElement(dynamic, "ParameterInstanceRef", parameterRef=length_reference, useCalibratedValue="false")
        ET.SubElement(dynamic, "LinearAdjustment", slope="8")
        return name

    def binary(self, name, length_reference, intercept_bits):
        """Bytes whose number of bits is 8 times a parameter, and so many more."""
        element = ET.SubElement(self.set, f"Binary{self.kind}Type", name=name)
        ET.SubElement(element, "UnitSet")
        size = ET.SubElement(ET.SubElement(element, "BinaryDataEncoding"), "SizeInBits")
        dynamic = ET.SubElement(size, "DynamicValue")
        ET.SubElement(dynamic, "ParameterInstanceRef", parameterRef=length_reference, useCalibratedValue="false")
        ET.SubElement(dynamic, "LinearAdjustment", slope="8", intercept=str(intercept_bits))
        return name

    def _begin(self, name, form, unit, **attributes):
        element = ET.SubElement(self.set, f"{form}{self.kind}Type", name=name, **attributes)
        units = ET.SubElement(element, "UnitSet")
        if unit:
            ET.SubElement(units, "Unit").text = unit
        return element

    def _made(self, name, form, bits, encoding, unit, least, most):
        if name in self.made:
            return name
        signed = {"signed": "true" if encoding == "twosComplement" else "false"} if form == "Integer" else {}
        element = self.made[name] = self._begin(name, form, unit, sizeInBits=str(bits), **signed)
        ET.SubElement(element, f"{form}DataEncoding", sizeInBits=str(bits), encoding=encoding)
        bounds = {"minInclusive": least, "maxInclusive": most}
        bounds = {key: repr(value) for key, value in bounds.items() if value is not None}
        if bounds and self.kind == "Argument":
            element = ET.SubElement(element, "ValidRangeSet")
        if bounds:
            ET.SubElement(element, "ValidRange", bounds)
        return name

    def _enumerated(self, name, field):
        if name not in self.made:
            element = self.made[name] = self._begin(name, "Enumerated", "")
            ET.SubElement(element, "IntegerDataEncoding", sizeInBits=str(field.bits), encoding="unsigned")
            values = ET.SubElement(element, "EnumerationList")
            for label, value in field.values.items():
                ET.SubElement(values, "Enumeration", value=str(value), label=label)
        return name


class Telemetry:
    def __init__(self, parent):
        data = ET.SubElement(parent, "TelemetryMetaData")
        self.types = Types(data, "Parameter")
        self.parameters, self.containers = ET.SubElement(data, "ParameterSet"), ET.SubElement(data, "ContainerSet")
        self.known = set()

    def container(self, name, meaning, base=None, abstract=False):
        """(the container's entries, what its restriction goes into)."""
        abstractness = {"abstract": "true"} if abstract else {}
        element = ET.SubElement(self.containers, "SequenceContainer", name=name, shortDescription=meaning, **abstractness)
        entries = ET.SubElement(element, "EntryList")
        if base is None:
            return entries, None
        return entries, ET.SubElement(ET.SubElement(element, "BaseContainer", containerRef=base), "RestrictionCriteria")

    def entry(self, entries, name, type_name, meaning=""):
        if name not in self.known:
            self.known.add(name)
            said = {"shortDescription": meaning} if meaning else {}
            ET.SubElement(self.parameters, "Parameter", name=name, parameterTypeRef=type_name, **said)
        ET.SubElement(entries, "ParameterRefEntry", parameterRef=name)

    def fields(self, entries, owner, fields):
        for field in fields:
            name, meaning = f"{owner}_{field.name}", field.raw.get("text", "")
            if field.type == "reserved":
                for _ in range(field.bytes):
                    self.entry(entries, "reserved", self.types.unsigned(8))
            elif field.type == "text":
                self.entry(entries, name, self.types.text(name + "_text", f"{owner}_{field.raw['length_in']}"), meaning)
            else:
                self.entry(entries, name, self.types.of(field, owner, field.raw.get("least"), field.raw.get("most")), meaning)

    def crc(self, entries):
        self.entry(entries, "crc", self.types.unsigned(16), "CRC-16/CCITT-FALSE over all bytes before it")

    def packets(self, description):
        entries, _ = self.container("ccsds_packet", "The primary header (CCSDS 133.0-B-2).", abstract=True)
        for name, bits in PRIMARY:
            self.entry(entries, name, self.types.unsigned(bits))
        entries, criteria = self.container("space_packet", "Hilcam's protocol version.", "ccsds_packet", abstract=True)
        compared(criteria, {"apid": description.image.number}, "!=")
        self.entry(entries, "protocol_version", self.types.unsigned(8))
        for answer in description.answers:
            branches = bool(answer.then)
            entries, criteria = self.container(answer.name + ("_head" if branches else ""), answer.meaning, "space_packet", branches)
            compared(criteria, {"apid": answer.number, "type": 0})
            if answer.kind is not None:
                self.entry(entries, "telemetry_kind", self.types.unsigned(8))
            self.fields(entries, answer.name, answer.fields)
            if not branches:
                self.crc(entries)
                continue
            condition = {f"{answer.name}_{name}": value for name, value in answer.condition.items()}
            entries, criteria = self.container(answer.name, answer.meaning, answer.name + "_head")
            any_differs(criteria, condition)
            self.crc(entries)
            entries, criteria = self.container(answer.then_name, answer.then_meaning, answer.name + "_head")
            compared(criteria, condition)
            self.fields(entries, answer.then_name, answer.then)
            self.crc(entries)
        self.image(description.image)


    def image(self, image):
        """A segment of a frame: its data end where its CRC begins."""
        entries, criteria = self.container(image.name, image.meaning, "ccsds_packet")
        compared(criteria, {"apid": image.number, "type": 0})
        self.fields(entries, image.name, image.fields)
        after_header = image.fields[-1].at + image.fields[-1].bytes - PRIMARY_BYTES
        self.entry(entries, f"{image.name}_data",
                   self.types.binary(f"{image.name}_data_bytes", "length", 8 * (1 - after_header - CRC_BYTES)),
                   "A part of the strip's payload")
        self.crc(entries)


def compared(criteria, values, operator="=="):
    """All of them compare so."""
    parent = ET.SubElement(criteria, "ComparisonList")
    said = {} if operator == "==" else {"comparisonOperator": operator}
    for name, value in values.items():
        ET.SubElement(parent, "Comparison", parameterRef=name, value=str(value), useCalibratedValue="false", **said)


def any_differs(criteria, values):
    """At least one of them differs."""
    parent = ET.SubElement(ET.SubElement(criteria, "BooleanExpression"), "ORedConditions")
    for name, value in values.items():
        condition = ET.SubElement(parent, "Condition")
        ET.SubElement(condition, "ParameterInstanceRef", parameterRef=name, useCalibratedValue="false")
        ET.SubElement(condition, "ComparisonOperator").text = "!="
        ET.SubElement(condition, "Value").text = str(value)


def initial(field, value):
    """A default as XTCE has it: the label of an enumeration's."""
    labels = {number: label for label, number in field.values.items()}
    return labels.get(value, repr(float(value)) if field.type == "f64" else str(value))


def commands(parent, description):
    data = ET.SubElement(parent, "CommandMetaData")
    types = Types(data, "Argument")
    commands_set = ET.SubElement(data, "MetaCommandSet")
    for command in description.commands:
        element = ET.SubElement(commands_set, "MetaCommand", name=command.name, shortDescription=command.meaning)
        arguments = ET.SubElement(element, "ArgumentList")
        entries = ET.SubElement(ET.SubElement(element, "CommandContainer", name=f"{command.name}_packet"), "EntryList")

        def fixed(name, value):
            ET.SubElement(entries, "FixedValueEntry", name=name, binaryValue=value.hex().upper(), sizeInBits=str(8 * len(value)))

        total = description.command_bytes(command)
        fixed("primary_header", struct.pack(">HHH", description.identification, 0xC000, total - PRIMARY_BYTES - 1))
        fixed("protocol_version", bytes((VERSION,)))
        fixed("function", bytes((command.number,)))
        for field in (*description.header, *command.fields):
            if field.type == "reserved":
                fixed("reserved", bytes(field.bytes))
                continue
            for name, default, least, most in field.numbers():
                ET.SubElement(arguments, "Argument", name=name, argumentTypeRef=types.of(field, command.name, least, most),
                              initialValue=initial(field, default), shortDescription=field.raw.get("text", field.label))
                ET.SubElement(entries, "ArgumentRefEntry", argumentRef=name)


def document(description):
    root = ET.Element("SpaceSystem", name="hilcam", xmlns=NAMESPACE,
                      shortDescription="Commands and telemetry of a spacecraft's camera, emulated (docs/protocol.md).")
    root.append(ET.Comment(REMARK))
    Telemetry(root).packets(description)
    commands(root, description)
    ET.indent(root)
    return '<?xml version="1.0" encoding="UTF-8"?>\n' + ET.tostring(root, encoding="unicode") + "\n"
