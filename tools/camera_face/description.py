"""A GenICam description (GenApi schemas 1.0 and 1.1): its nodes, as they stand in the file.

A file is text, a zip with one XML, or what `arv-tool genicam > file` leaves, with its first line before the XML.
"""
import io
import math
import pathlib
import re
import xml.etree.ElementTree as ElementTree
import zipfile
import zlib

MAX_BYTES = 32 << 20  # the largest public description has 1.3 MB
FEATURES = ("Integer", "Float", "Boolean", "Enumeration", "Command", "String")
REGISTERS = ("IntReg", "MaskedIntReg", "FloatReg", "StringReg", "Register", "StructEntry")
FORMULAS = ("SwissKnife", "IntSwissKnife", "Converter", "IntConverter")


class DescriptionError(Exception):
    """One line: what, where, found, accepted."""


class Node:
    def __init__(self, element, parent=None):
        self.tag = local(element.tag)
        self.name = element.get("Name")
        self.children = {}
        self.entries = []
        self.formula = None  # compiled once
        for child in element:
            tag = local(child.tag)
            if tag == "EnumEntry":
                self.entries.append(Node(child))
            elif tag != "StructEntry" and isinstance(child.tag, str):
                self.children.setdefault(tag, []).append(child)
        if parent is not None:
            for tag, children in parent.children.items():
                self.children.setdefault(tag, children)

    def texts(self, tag):
        return [(child.text or "").strip() for child in self.children.get(tag, ())]

    def text(self, tag, default=None):
        found = self.texts(tag)
        return found[0] if found else default

    def whole(self, tag, default=None):
        text = self.text(tag)
        return default if text is None else whole_of(text, f"{self.name}, {tag}")

    def number(self, tag, default=None):
        text = self.text(tag)
        return default if text is None else number_of(text, f"{self.name}, {tag}")


def local(tag):
    return tag.rsplit("}", 1)[-1] if isinstance(tag, str) else ""


def number_of(text, where):
    try:
        return int(text, 0)
    except ValueError:
        pass
    try:
        return int(text) if re.fullmatch(r"[+-]?\d+", text) else float(text)
    except ValueError:
        raise DescriptionError(f"{where}: found '{text[:40]}'; accepted: a number") from None


def whole_of(text, where):
    number = number_of(text, where)
    if not math.isfinite(number) or number != int(number):
        raise DescriptionError(f"{where}: found '{text[:40]}'; accepted: a whole number")
    return int(number)


def xml_bytes(path):
    """Returns the description's XML from its first '<' on, as hilcam serves it."""
    path = pathlib.Path(path)
    try:
        if path.stat().st_size > MAX_BYTES:
            raise DescriptionError(f"{path}: has {path.stat().st_size} bytes; accepted: at most {MAX_BYTES}")
        data = path.read_bytes()
    except OSError as error:
        raise DescriptionError(f"{path}: {error.strerror}") from None
    if data[:4] == b"PK\x03\x04":
        data = unzipped(data, path)
    begin = min((at for at in (data.find(b"<?xml"), data.find(b"<RegisterDescription")) if at >= 0), default=-1)
    if begin < 0:
        raise DescriptionError(f"{path}: has neither <?xml nor <RegisterDescription; accepted: a GenICam description")
    return data[begin:]


def unzipped(data, path):
    try:
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            first = archive.infolist()[0]
            if first.file_size > MAX_BYTES:
                raise DescriptionError(f"{path}: unzips to {first.file_size} bytes; accepted: at most {MAX_BYTES}")
            return archive.read(first)
    except (zipfile.BadZipFile, zlib.error, IndexError, RuntimeError, EOFError, NotImplementedError) as error:
        raise DescriptionError(f"{path}: is no zip that can be read: {error}") from None


class Description:
    def __init__(self, path):
        self.path = str(path)
        self.xml = xml_bytes(path)
        self.crc32 = zlib.crc32(self.xml)
        self.nodes = {}
        self.ports = {}  # name: None for the device's registers, else ("ChunkID" or "EventID", number)
        try:
            root = ElementTree.fromstring(self.xml.rstrip(b"\0 \r\n\t"))
        except ElementTree.ParseError as error:
            raise DescriptionError(f"{self.path}: is no XML that can be read: {error}") from None
        if local(root.tag) != "RegisterDescription":
            raise DescriptionError(f"{self.path}: begins with <{local(root.tag)}>; accepted: <RegisterDescription>")
        version = (root.get("SchemaMajorVersion"), root.get("SchemaMinorVersion"))
        if version not in (("1", "0"), ("1", "1")):
            raise DescriptionError(f"{self.path}: GenApi schema {version[0]}.{version[1]}; accepted: 1.0, 1.1")
        self.vendor, self.model = root.get("VendorName", ""), root.get("ModelName", "")
        self.tooltip = root.get("ToolTip", "")
        self._collect(root)
        if "Root" not in self.nodes:
            raise DescriptionError(f"{self.path}: has no category Root")

    def _collect(self, parent):
        for element in parent:
            tag = local(element.tag)
            if tag == "Group":
                self._collect(element)
            elif tag == "StructReg":
                struct = Node(element)
                for child in element:
                    if local(child.tag) == "StructEntry":
                        self._add(Node(child, struct))
            elif element.get("Name"):
                self._add(Node(element))

    def _add(self, node):
        self.nodes[node.name] = node
        for entry in node.entries:
            if entry.whole("Value") is None:
                raise DescriptionError(f"{node.name}: the entry {entry.name} has no Value")
        if node.tag == "Port":
            self.ports[node.name] = None
            for kind in ("ChunkID", "EventID"):
                if node.text(kind):
                    self.ports[node.name] = (kind, self._id(node, kind))
                elif node.text("p" + kind):
                    self.ports[node.name] = (kind, 0)

    @staticmethod
    def _id(node, kind):
        try:
            return int(node.text(kind), 16)
        except ValueError:
            raise DescriptionError(f"{node.name}, {kind}: found '{node.text(kind)[:40]}'; accepted: hexadecimal digits") from None

    def on_device(self, node):
        """True for a register of the device; false for one in a chunk, or in an event's data."""
        return self.ports.get(node.text("pPort"), None) is None

    def features(self):
        """Returns the names of what the category Root leads to, in the description's order."""
        found, seen, waiting = [], set(), ["Root"]
        while waiting:
            name = waiting.pop(0)
            node = self.nodes.get(name)
            if node is None or name in seen:
                continue
            seen.add(name)
            if node.tag == "Category":
                waiting[0:0] = node.texts("pFeature")
            else:
                found.append(name)
        return found
