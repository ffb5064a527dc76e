"""Features by name: a small reader of GenICam descriptions (schema 1.1) over gvcp_client.

It knows the node kinds that cameras use: features with a value or a pValue, registers with addresses that may depend on
a selector (pAddress, pIndex), masked registers, formulas. It does not enforce locks or limits: what the camera refuses
shall be seen.
"""
import re
import struct
import xml.etree.ElementTree as ElementTree


def _number(text):
    text = text.strip()
    return int(text, 16) if text.lower().startswith("0x") else float(text) if re.search(r"[.eE]", text) else int(text)


def evaluate(formula, variables):
    """GenICam formulas: C's operators, with = for equality and <> for inequality, ** for powers."""
    tokens = re.findall(r"0[xX][0-9A-Fa-f]+|\d+\.?\d*(?:[eE][-+]?\d+)?|[A-Za-z_][\w.]*"
                        r"|\*\*|<<|>>|<>|<=|>=|&&|\|\||[-+*/%&|^~<>=?:()]", formula)
    levels = [["||"], ["&&"], ["|"], ["^"], ["&"], ["=", "<>"], ["<", ">", "<=", ">="], ["<<", ">>"], ["+", "-"],
              ["*", "/", "%"]]
    apply = {"||": lambda a, b: int(bool(a or b)), "&&": lambda a, b: int(bool(a and b)), "|": lambda a, b: int(a) | int(b),
             "^": lambda a, b: int(a) ^ int(b), "&": lambda a, b: int(a) & int(b), "=": lambda a, b: int(a == b),
             "<>": lambda a, b: int(a != b), "<": lambda a, b: int(a < b), ">": lambda a, b: int(a > b),
             "<=": lambda a, b: int(a <= b), ">=": lambda a, b: int(a >= b), "<<": lambda a, b: int(a) << int(b),
             ">>": lambda a, b: int(a) >> int(b), "+": lambda a, b: a + b, "-": lambda a, b: a - b,
             "*": lambda a, b: a * b, "%": lambda a, b: a % b,
             "/": lambda a, b: a // b if isinstance(a, int) and isinstance(b, int) else a / b}

    def ternary():
        condition = binary(0)
        if tokens and tokens[0] == "?":
            tokens.pop(0)
            yes = ternary()
            if tokens.pop(0) != ":":
                raise ValueError("a ? without its :")
            no = ternary()
            return yes if condition else no
        return condition

    def binary(level):
        if level == len(levels):
            return unary()
        value = binary(level + 1)
        while tokens and tokens[0] in levels[level]:
            operator = tokens.pop(0)
            value = apply[operator](value, binary(level + 1))
        return value

    def unary():
        token = tokens.pop(0)
        if token == "-":
            return -unary()
        if token == "+":
            return unary()
        if token == "~":
            return ~int(unary())
        if token == "(":
            value = ternary()
            if tokens.pop(0) != ")":
                raise ValueError("a ( without its )")
        elif token[0].isdigit():
            value = _number(token)
        else:
            value = variables[token]
        if tokens and tokens[0] == "**":
            tokens.pop(0)
            value = value ** unary()
        return value

    value = ternary()
    if tokens:
        raise ValueError(f"'{formula}': '{tokens[0]}' is left over")
    return value


class Features:
    def __init__(self, client, xml=None):
        self.client = client
        self.xml = client.description()[0] if xml is None else xml
        self.nodes, self.kinds = {}, {}
        root = ElementTree.fromstring(self.xml)
        self._collect(root)
        self.model = root.get("ModelName")

    def _collect(self, parent):
        for element in parent:
            kind = element.tag.split("}")[-1]
            if kind == "Group":
                self._collect(element)
            elif element.get("Name"):
                if element.get("Name") in self.nodes:
                    raise ValueError(f"two nodes named {element.get('Name')}")
                self.nodes[element.get("Name")], self.kinds[element.get("Name")] = element, kind

    def __contains__(self, name):
        return name in self.nodes

    # --- a node's properties

    def texts(self, name, tag):
        return [child.text for child in self.nodes[name] if child.tag.split("}")[-1] == tag]

    def text(self, name, tag, default=None):
        found = self.texts(name, tag)
        return found[0] if found else default

    def entries(self, name):
        return {entry.get("Name"): int(self._in(entry, "Value"), 0) for entry in self.nodes[name]
                if entry.tag.split("}")[-1] == "EnumEntry"}

    @staticmethod
    def _in(element, tag):
        return next(child.text for child in element if child.tag.split("}")[-1] == tag)

    def limit(self, name, which):
        """'Min', 'Max' or 'Inc' of a feature, or None."""
        if (text := self.text(name, which)) is not None:
            return _number(text)
        if (node := self.text(name, "p" + which)) is not None:
            return self.get(node)
        return None

    def address(self, name):
        total = sum(_number(text) for text in self.texts(name, "Address"))
        total += sum(int(self.get(node)) for node in self.texts(name, "pAddress"))
        for child in self.nodes[name]:
            if child.tag.split("}")[-1] == "pIndex":
                step = child.get("Offset") or str(self.get(child.get("pOffset")))
                total += int(self.get(child.text)) * int(_number(step))
        return total

    def length(self, name):
        if (text := self.text(name, "Length")) is not None:
            return int(_number(text))
        return int(self.get(self.text(name, "pLength")))

    def register_of(self, name):
        """Where a feature lives: (address, bytes), following pValue."""
        while self.kinds[name] not in ("IntReg", "MaskedIntReg", "FloatReg", "StringReg", "Register", "StructReg"):
            name = self.text(name, "pValue")
        return self.address(name), self.length(name)

    # --- values

    def get(self, name):
        kind = self.kinds[name]
        if kind in ("Integer", "Float", "Boolean", "Enumeration", "Command", "String"):
            if (node := self.text(name, "pValue")) is None:
                value = self.text(name, "Value")
                value = value if kind == "String" else _number(value)
            else:
                value = self.get(node)
            if kind == "Boolean":
                return value == _number(self.text(name, "OnValue", "1"))
            if kind == "Enumeration":
                return next((entry for entry, number in self.entries(name).items() if number == value), value)
            return value
        if kind in ("IntSwissKnife", "SwissKnife"):
            return evaluate(self.text(name, "Formula"), self._variables(name))
        if kind in ("Converter", "IntConverter"):
            variables = self._variables(name)
            variables["TO"] = self.get(self.text(name, "pValue"))
            return evaluate(self.text(name, "FormulaFrom"), variables)
        return self._read_register(name, kind)

    def _variables(self, name):
        variables = {}
        for child in self.nodes[name]:
            tag = child.tag.split("}")[-1]
            if tag == "pVariable":
                variables[child.get("Name")] = self.get(child.text)
            elif tag == "Constant":
                variables[child.get("Name")] = _number(child.text)
        return variables

    def _read_register(self, name, kind):
        address, length = self.address(name), self.length(name)
        data = self.client.read_memory(address, length)
        return self.decode(name, kind, data)

    def decode(self, name, kind, data):
        if kind == "StringReg":
            return data.split(b"\0")[0].decode()
        if kind == "Register":
            return data
        little = self.text(name, "Endianess", "LittleEndian") == "LittleEndian"
        if kind == "FloatReg":
            return struct.unpack(("<" if little else ">") + ("f" if len(data) == 4 else "d"), data)[0]
        signed = self.text(name, "Sign", "Unsigned") == "Signed"
        value = int.from_bytes(data, "little" if little else "big", signed=signed and kind == "IntReg")
        if kind == "MaskedIntReg":
            low, width = self._mask(name, len(data) * 8)
            value = value >> low & (1 << width) - 1
            if signed and value >> width - 1:
                value -= 1 << width
        return value

    def _mask(self, name, bits):
        """Lowest bit (0: least significant) and width. Big-endian registers number bits from the most significant."""
        if (bit := self.text(name, "Bit")) is not None:
            lsb = msb = int(bit)
        else:
            lsb, msb = int(self.text(name, "LSB")), int(self.text(name, "MSB"))
        if self.text(name, "Endianess", "LittleEndian") == "BigEndian":
            lsb, msb = bits - 1 - lsb, bits - 1 - msb
        low, high = min(lsb, msb), max(lsb, msb)
        return low, high - low + 1

    def set(self, name, value):
        kind = self.kinds[name]
        if kind in ("Integer", "Float", "Boolean", "Enumeration", "Command", "String"):
            if kind == "Boolean":
                value = _number(self.text(name, "OnValue" if value else "OffValue", "1" if value else "0"))
            elif kind == "Enumeration" and isinstance(value, str):
                value = self.entries(name)[value]
            return self.set(self.text(name, "pValue"), value)
        if kind in ("Converter", "IntConverter"):
            variables = self._variables(name)
            variables["FROM"] = value
            return self.set(self.text(name, "pValue"), evaluate(self.text(name, "FormulaTo"), variables))
        address, length = self.address(name), self.length(name)
        self.client.write_memory(address, self._encode(name, kind, value, address, length))

    def _encode(self, name, kind, value, address, length):
        if kind == "StringReg":
            return value.encode()[:length].ljust(length, b"\0")
        little = self.text(name, "Endianess", "LittleEndian") == "LittleEndian"
        if kind == "FloatReg":
            return struct.pack(("<" if little else ">") + ("f" if length == 4 else "d"), value)
        if kind == "MaskedIntReg":
            low, width = self._mask(name, length * 8)
            mask = (1 << width) - 1 << low
            # Neighbours keep their values, where they can be read.
            before = 0
            if self.text(name, "AccessMode", "RW") != "WO":
                before = int.from_bytes(self.client.read_memory(address, length), "little" if little else "big")
            value = before & ~mask | int(value) << low & mask
        return int(value).to_bytes(length, "little" if little else "big", signed=int(value) < 0)

    def execute(self, name):
        self.set(self.text(name, "pValue"), _number(self.text(name, "CommandValue", "1")))

    def select(self, selector, entry, name):
        """The value of a feature under a selector's entry."""
        self.set(selector, entry)
        return self.get(name)

    def chunk_ids(self):
        """Chunk feature's name -> (chunk id, register node that decodes it)."""
        ports = {name: int(self.text(name, "ChunkID"), 16) for name in self.nodes
                 if self.kinds[name] == "Port" and self.text(name, "ChunkID")}
        found = {}
        for name in self.nodes:
            if not name.startswith("Chunk") or self.kinds[name] in ("Category", "Port"):
                continue
            node = name
            while self.text(node, "pValue"):
                node = self.text(node, "pValue")
            if (port := self.text(node, "pPort")) in ports:
                found[name] = (ports[port], node)
        return found

    def chunk_values(self, frame):
        """Of a frame of gvsp_client: feature's name -> value, decoded as the description says."""
        values = {}
        for name, (chunk, node) in self.chunk_ids().items():
            if chunk in frame.chunks:
                begin = sum(int(_number(text)) for text in self.texts(node, "Address"))
                data = frame.chunks[chunk][begin:begin + self.length(node)]
                values[name] = self.decode(node, self.kinds[node], data)
        return values
