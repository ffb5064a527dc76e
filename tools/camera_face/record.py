"""Reads every register of a real camera into a registers file, with Aravis."""
import io
import pathlib
import re
import socket
import sys
import zipfile

from .binding import REFUSED
from .description import REGISTERS, Description, DescriptionError
from .evaluator import Evaluator
from .registers import Memory, write_file

MOST_STATES = 64
FIRST_URL, SECOND_URL, URL_BYTES = 0x200, 0x400, 512
MOST_DESCRIPTION_BYTES = 8 << 20


class DeviceMemory(Memory):
    """Reads from the camera, each register once; keeps what came. It writes nothing to the camera."""

    def __init__(self, device):
        super().__init__()
        self.device, self.failed = device, {}
        self.came = set()

    def read(self, address, count):
        begin, end = address & ~3, address + count + 3 & ~3
        for word in range(begin >> 2, end >> 2):
            if word not in self.came and word not in self.failed:
                self._fetch(word)
        return super().read(address, count)

    def _fetch(self, word):
        try:
            value = self.device.read_register(4 * word)
        except Exception as error:  # GLib.Error of PyGObject
            self.failed[word] = str(error).splitlines()[0]
            return
        super().write(4 * word, (value & 0xFFFFFFFF).to_bytes(4, "big"))
        self.came.add(word)


def open_device(address):
    try:
        import gi
        gi.require_version("Aravis", "0.8")
        from gi.repository import Aravis, Gio, GLib
    except (ImportError, ValueError):
        sys.exit("hilcam-camera-face: Aravis is missing; install gir1.2-aravis-0.8 and python3-gi, and use /usr/bin/python3")
    try:
        if re.fullmatch(r"\d+(\.\d+){3}", address):  # also where no broadcast reaches it
            near = Gio.InetAddress.new_from_string(own_address(address))
            return Aravis.GvDevice.new(near, Gio.InetAddress.new_from_string(address))
        return Aravis.Camera.new(address).get_device()
    except GLib.Error as error:
        raise DescriptionError(f"{address}: no camera: {error.message}") from None


def own_address(address):
    """Returns the address of this machine from which that one is reached."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        probe.connect((address, 3956))
        return probe.getsockname()[0]


def description_of(memory):
    """Returns the XML where the first URL of the bootstrap registers says it is (GigE Vision 2.0, 16.2). Aravis's own text of it
    has no certain end in Python."""
    for register in FIRST_URL, SECOND_URL:
        url = memory.read(register, URL_BYTES).split(b"\0")[0].decode("latin-1")
        place = re.fullmatch(r"(?i)local:(?:///)?([^;]*);(?:0x)?([0-9a-f]+);(?:0x)?([0-9a-f]+)(?:\?.*)?", url)
        if not place:
            continue
        at, size = int(place[2], 16), int(place[3], 16)
        if size > MOST_DESCRIPTION_BYTES:
            raise DescriptionError(f"{url}: {size} bytes; accepted: at most {MOST_DESCRIPTION_BYTES}")
        content = DeviceMemory(memory.device).read(at, size)
        if not content.startswith(b"PK"):
            return content.rstrip(b"\0")
        with zipfile.ZipFile(io.BytesIO(content)) as archive:
            return archive.read(archive.namelist()[0])
    raise DescriptionError("the camera names no description of its own; accepted: a URL that begins with 'Local:'")


def record(address, out):
    """Writes OUT.xml and OUT. Nothing in the camera changes: selectors are walked only where they are the client's own."""
    device = open_device(address)
    memory = DeviceMemory(device)
    xml_file = pathlib.Path(out).with_suffix(".xml")
    xml_file.write_bytes(description_of(memory))
    description = Description(xml_file)
    evaluator = Evaluator(description, memory)
    names = [name for name, node in description.nodes.items() if node.tag in REGISTERS and description.on_device(node)]
    for name in names:
        read_register(evaluator, name)
        for selector, values in own_selectors(evaluator, name):
            for value in values:
                evaluator.set(selector, value)
                read_register(evaluator, name)
            evaluator.local.pop(selector, None)
            evaluator._changed(("", 0, selector))
    rows = memory.runs(memory.came)
    write_file(out, rows, f"{description.vendor} {description.model}, {len(memory.came)} words")
    return len(names), len(memory.came), memory.failed, xml_file


def read_register(evaluator, name):
    try:
        if evaluator.node(name).text("AccessMode") != "WO":
            evaluator.memory.read(evaluator.address(name), evaluator.length(name))
    except REFUSED:
        pass


def own_selectors(evaluator, name):
    """Returns (selector, its values) for what moves a register's address and is no register itself."""
    node = evaluator.node(name)
    below = [("value", text) for text in node.texts("pAddress") + node.texts("pIndex")]
    for _, length, used in evaluator.uses(*below):
        if length or not used:
            continue
        selector = evaluator.nodes[used]
        entries = next((e.entries for e in evaluator.nodes.values() if e.entries and e.text("pValue") == used), selector.entries)
        if entries:
            yield used, [entry.number("Value") for entry in entries][:MOST_STATES]
        elif selector.number("Max") is not None and selector.number("Max") - selector.number("Min", 0) < MOST_STATES:
            yield used, range(selector.number("Min", 0), selector.number("Max") + 1)
