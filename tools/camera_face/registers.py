"""A camera's registers: a sparse memory of 32 bits, and the file that `record` writes.

The file is text: a line `# hilcam registers 1`, then `ADDRESS BYTES` in hexadecimal, as `0x0000a104 00000280`; what
follows a # is a remark.
"""
import re

from .description import DescriptionError

FIRST_LINE = "# hilcam registers 1"
PAGE = 4096


class Memory:
    def __init__(self):
        self.pages = {}
        self.written = set()  # words that somebody has written

    def read(self, address, count):
        page, offset = divmod(address, PAGE)
        if offset + count <= PAGE:
            data = self.pages.get(page)
            return bytes(data[offset:offset + count]) if data else bytes(count)
        first = PAGE - offset
        return self.read(address, first) + self.read(address + first, count - first)

    def write(self, address, data):
        for at, byte in enumerate(data):
            page, offset = divmod(address + at, PAGE)
            if page not in self.pages:
                self.pages[page] = bytearray(PAGE)
            self.pages[page][offset] = byte
        self.written.update(range(address >> 2, address + len(data) + 3 >> 2))

    def runs(self, wanted=None):
        """Returns (address, bytes) of what was written, joined where it is without a gap."""
        found = []
        for word in sorted(self.written if wanted is None else wanted):
            if found and found[-1][0] + len(found[-1][1]) == 4 * word and len(found[-1][1]) < 1024:
                found[-1][1].extend(self.read(4 * word, 4))
            else:
                found.append((4 * word, bytearray(self.read(4 * word, 4))))
        return [(address, bytes(data)) for address, data in found]


def write_file(path, rows, remark=""):
    with open(path, "w", encoding="ascii", errors="replace") as out:
        out.write(FIRST_LINE + "\n")
        if remark:
            out.write(f"# {remark}\n")
        for address, data in rows:
            out.write(f"0x{address:08x} {data.hex()}\n")


def read_file(path, memory):
    """Puts a file's bytes into a memory, and returns the words that it has."""
    try:
        with open(path, encoding="ascii") as file:
            lines = file.read(64 << 20).splitlines()
    except (OSError, UnicodeDecodeError) as error:
        raise DescriptionError(f"{path}: {error}") from None
    if not lines or lines[0].strip() != FIRST_LINE:
        raise DescriptionError(f"{path}:1: found '{lines[0][:40] if lines else ''}'; accepted: {FIRST_LINE}")
    own = set()
    for number, line in enumerate(lines[1:], 2):
        line = line.split("#")[0].strip()
        if not line:
            continue
        match = re.fullmatch(r"0[xX]([0-9a-fA-F]{1,8})\s+((?:[0-9a-fA-F]{2})+)", line)
        if not match:
            raise DescriptionError(f"{path}:{number}: found '{line[:40]}'; accepted: an address and bytes, as 0x0000a104 00000280")
        address, data = int(match.group(1), 16), bytes.fromhex(match.group(2))
        words = set(range(address >> 2, address + len(data) + 3 >> 2))
        if words & own and memory.read(address, len(data)) != data:
            raise DescriptionError(f"{path}:{number}: 0x{address:08x} is there twice, with other bytes")
        own |= words
        memory.write(address, data)
    return own
