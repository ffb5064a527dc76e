"""The register nodes of a description over a memory: where they are, and their numbers (GenICam Standard 2.1.1, 2.8.8 to 2.8.11)."""
import math
import struct

from .description import whole_of


class NoValue(Exception):
    """A node that has no value at present: it is in a chunk, has no register, or its formula fails."""


class RegisterNodes:
    """The part of Evaluator that knows bytes."""

    def address(self, name):
        node, total = self.node(name), 0
        for text in node.texts("Address"):
            total += whole_of(text, f"{name}, Address")
        for text in node.texts("pAddress"):
            total += int(self.value(text))
        for child in node.children.get("IntSwissKnife", ()):
            total += int(self._inline(node, child))
        for child in node.children.get("pIndex", ()):
            step = child.get("Offset")
            offset = whole_of(step, name) if step else \
                int(self.value(child.get("pOffset"))) if child.get("pOffset") else self.length(name)
            total += int(self.value(child.text.strip())) * offset
        return total & 0xFFFFFFFF

    def length(self, name):
        node = self.node(name)
        length = node.whole("Length")
        if length is None:
            length = int(self.value(node.text("pLength"))) if node.text("pLength") else 0
        if not 0 < length <= 1 << 20:
            raise NoValue(f"{name}: a register of {length} bytes")
        return length

    def endian(self, name):
        return "little" if self.node(name).text("Endianess", "LittleEndian").startswith("Little") else "big"

    def bits(self, name):
        """Returns the lowest and the highest bit of a register's number, counted from the least significant."""
        node, count = self.node(name), 8 * self.length(name)
        if node.tag not in ("MaskedIntReg", "StructEntry"):
            return 0, count - 1
        low, high = node.whole("LSB"), node.whole("MSB")
        if node.text("Bit") is not None:
            low = high = node.whole("Bit")
        if low is None or high is None:
            low, high = 0, count - 1
        elif self.endian(name) == "big":  # there bit 0 is the most significant
            low, high = count - 1 - low, count - 1 - high
        if not (0 <= min(low, high) and max(low, high) < count):
            raise NoValue(f"{name}: bits {low} to {high} of {count}")
        return min(low, high), max(low, high)

    def bits_in_memory(self, name):
        """Returns the bits of memory that a register node covers, as numbers that are equal for the same bit."""
        address, length = self.address(name), self.length(name)
        if self.node(name).tag in ("StringReg", "Register"):
            return frozenset(range(8 * address, 8 * (address + length)))
        low, high = self.bits(name)
        little = self.endian(name) == "little"
        return frozenset(8 * (address + (bit // 8 if little else length - 1 - bit // 8)) + bit % 8
                         for bit in range(low, high + 1))

    def signed(self, name):
        return self.node(name).text("Sign", "Unsigned") == "Signed"

    def open_chunks(self, are_open):
        self.chunks_open = are_open
        self.kept.clear()
        self.used_by.clear()

    def place(self, name):
        """Returns a register's address in the memory; of one in a chunk, beyond the 32 bits of the device."""
        node = self.node(name)
        if self.description.on_device(node):
            return self.address(name)
        if not self.chunks_open:
            raise NoValue(f"{name} is in a chunk or an event")
        return (1 + list(self.description.ports).index(node.text("pPort")) << 40) + self.address(name)

    def raw(self, name):
        address, length = self.place(name), self.length(name)
        self._note((address, length, name))
        return self.memory.read(address, length)

    def _register(self, node):
        data, name = self.raw(node.name), node.name
        if node.tag == "StringReg":
            return data.split(b"\0")[0].decode("utf-8", "replace")
        if node.tag == "Register":
            return data.hex()
        if node.tag == "FloatReg":
            kind = {4: "f", 8: "d"}.get(len(data))
            if not kind:
                raise NoValue(f"{name}: a float of {len(data)} bytes")
            return struct.unpack((">" if self.endian(name) == "big" else "<") + kind, data)[0]
        low, high = self.bits(name)
        value = int.from_bytes(data, self.endian(name)) >> low & (1 << high - low + 1) - 1
        if self.signed(name) and value >> high - low:
            value -= 1 << high - low + 1
        return value

    def _write_register(self, node, value):
        name, address, length = node.name, self.place(node.name), self.length(node.name)
        if node.tag != "StringReg" and not (isinstance(value, (int, float)) and math.isfinite(value)):
            raise NoValue(f"{name}: {value} is no number")
        if node.tag == "StringReg":
            data = str(value).encode()[:length - 1].ljust(length, b"\0")
        elif node.tag == "FloatReg":
            data = struct.pack((">" if self.endian(name) == "big" else "<") + {4: "f", 8: "d"}[length], value)
        elif node.tag == "Register":
            raise NoValue(f"{name}: bytes")
        else:
            low, high = self.bits(name)
            mask = (1 << high - low + 1) - 1
            whole = int.from_bytes(self.memory.read(address, length), self.endian(name))
            whole = whole & ~(mask << low) | (int(round(value)) & mask) << low
            data = whole.to_bytes(length, self.endian(name))
        self.write_memory(address, data)


def words(use):
    address, length, name = use
    if not length:
        return (name,)
    return range(address >> 2, (address + length + 3 >> 2))
