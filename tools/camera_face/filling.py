"""Fills registers that nobody recorded, so that every feature that the description makes available reads as something.

A feature's demand (it is there; it is not locked; its value is within its limits, or one of its entries) depends on registers;
the values that are tried are few, and one is taken if the demand then holds and no earlier demand breaks.
"""
import contextlib
import itertools
import math
import re

from .evaluator import NoValue
from .formula import FormulaError
from .roles import entry_of

WRONG = (NoValue, FormulaError, OverflowError, ValueError, KeyError, TypeError)
NUMBERS = (1, 0, 2, 3, 4, 8, 16, 32, 100, 128, 255, 256, 1000, 1024, 4096, 65535, 65536, 1000000, 0x80000000, 0xFFFFFFFF)
LARGE = (1000, 65535, 255, 100, 1000000, 16, 4, 1, 2, 0)
FLOATS = (1.0, 0.0, 100.0, 1000.0, 0.01, 1e6, 25.0)
MOST_TRIES = 1500


class Filler:
    def __init__(self, evaluator, held, bound, states, camera):
        self.ev, self.held, self.bound, self.states, self.camera = evaluator, held, bound, states, camera
        self.demands = {}  # word: numbers of demands that depend on it
        self.checks, self.whats = [], []
        self.mending = False
        self.constants = self._constants()
        self.undo = []  # (address, bytes before), oldest first

    def fill(self, features):
        """Returns the features that read wrong in the end."""
        ours = [name for name in self.bound if name in features] + [name for name in self.bound if name not in features]
        for demand in (self._demand_there, self._demand_valid):
            for name in ours:
                self._tried(demand, name)
        if "PixelFormat" in self.bound:
            self._fill_formats()
        for name, selector, entry in self.states:
            try:
                with self._selected(selector, entry):
                    self._demand_usable(name, selector, entry)
            except WRONG:
                continue  # a computed selector has moved with other registers
        for name in features:
            if name not in self.bound and self._readable(name):
                self._tried(self._fill_other, name)
        return [name for name in features if self._readable(name) and not self._right(name)]

    @staticmethod
    def _tried(fill, name):
        """A feature with a register that cannot be is left as it is, and is named as one that reads wrong."""
        try:
            fill(name)
        except WRONG:
            pass

    # --- one feature

    def _readable(self, name):
        """False for commands, bytes, and what is in a chunk or an event."""
        node = self.ev.nodes[name]
        if node.tag in ("Command", "Register", "Category", "Port"):
            return False
        try:
            if self.ev.access(name) == "WO":
                return False
        except WRONG:
            return False
        for what in ("value", "least", "most"):
            try:
                getattr(self.ev, what)(name)
            except NoValue as error:
                if "in a chunk or an event" in str(error):
                    return False
            except WRONG:
                pass
        return True

    def _right(self, name):
        try:
            return not self.ev.available(name) or self.valid(name)
        except WRONG:
            return False

    def valid(self, name):
        node, value = self.ev.nodes[name], None
        value = self.ev.value(name)
        if node.tag == "Enumeration":
            entry = self.ev.entry(name)
            return entry is not None and entry[1]
        if node.tag == "Boolean":
            source = self.ev.source(name)
            return source is None or self.ev.value(source) in (node.number("OnValue", 1), node.number("OffValue", 0))
        if isinstance(value, str):
            return value.isprintable()
        least, most = self.ev.least(name), self.ev.most(name)
        if not math.isfinite(value) or not least <= value <= most:
            slack = 1e-6 * max(abs(value), 1)
            if not math.isfinite(value) or not least - slack <= value <= most + slack:
                return False
        if node.tag == "Integer" and self.ev.step(name) < 1:
            return False
        writable = self.ev.access(name) == "RW"
        return most > least or not writable or name in self.bound or self._fixed(name)

    def _fixed(self, name):
        """True where the description itself, or what is settled already, gives one value and no range."""
        return all(self.ev.bits_in_memory(register) <= self.held
                   for _, length, register in self.ev.uses(("least", name), ("most", name)) if length)

    def _demand_there(self, name):
        for what in ("implemented", "available"):
            self._demand(lambda w=what: getattr(self.ev, w)(name), ((what, name),), NUMBERS)
        self._demand(lambda: not self.ev.locked(name), (("locked", name),), (0, 1, 2, 255))

    def _demand_usable(self, name, selector, entry):
        """What hilcam acts on under each entry of a selector is there, with those of its entries that hilcam has."""
        if selector:
            self._demand_entry(selector, entry, selector, entry)
        for what in ("implemented", "available"):
            self._demand(self._under(selector, entry, lambda w=what: getattr(self.ev, w)(name)), ((what, name),), NUMBERS)
        self._demand(self._under(selector, entry, lambda: not self.ev.locked(name)), (("locked", name),), (0, 1, 2, 255))
        self._demand(self._under(selector, entry, lambda: self._right(name)), self._whats(name), LARGE)
        role = self.bound[name][0] if name in self.bound else None
        if role is None or self.ev.nodes[name].tag != "Enumeration" or name == "PixelFormat":
            return
        for one in self.ev.nodes[name].entries:
            if role.kind != "choice" or entry_of(role.feature, one.name, self.camera) is not None:
                self._demand_entry(name, one, selector, entry)

    def _demand_entry(self, name, one, selector, entry):
        whats = tuple(("value", one.text(tag)) for tag in ("pIsImplemented", "pIsAvailable") if one.text(tag))
        if whats:
            self._demand(self._under(selector, entry, lambda: self.ev.entry_available(one)), whats, NUMBERS)

    @contextlib.contextmanager
    def _selected(self, selector, entry):
        if selector is None:
            yield
            return
        before = self.ev.value(selector)
        try:
            if before != entry.number("Value"):
                self.ev.set(selector, entry.number("Value"))
            yield
        finally:
            if self.ev.value(selector) != before:
                self.ev.set(selector, before)

    def _under(self, selector, entry, check):
        def checked():
            with self._selected(selector, entry):
                return check()
        return checked

    def _demand_valid(self, name):
        if not self._right(name):
            self._steps(name)
        self._demand(lambda: self.valid(name), self._whats(name), LARGE)

    def _fill_other(self, name):
        """Makes a feature available and right; where that cannot be, unavailable, which is right as well."""
        mark = len(self.undo)
        for what in ("implemented", "available"):
            self._demand(lambda w=what: getattr(self.ev, w)(name), ((what, name),), NUMBERS)
        if not self._is(lambda: self.ev.available(name)):
            return
        if not self._right(name):
            self._steps(name)
        if self._right(name) or self._demand(lambda: self._right(name), self._whats(name), LARGE):
            self._keep(lambda: self._right(name), self._whats(name))
            return
        while len(self.undo) > mark:
            self.ev.write_memory(*self.undo.pop())
        if not self._right(name):
            self._demand(lambda: not self.ev.available(name), (("available", name),), NUMBERS)

    def _steps(self, name):
        """The parts of being valid, one after the other: each has few registers."""
        node = self.ev.nodes[name]
        if node.tag == "Enumeration":
            self._fill_entry(name)
            return
        if node.tag in ("Integer", "Float", "Converter", "IntConverter"):
            for what in ("least", "most", "value"):
                self._demand(lambda w=what: math.isfinite(getattr(self.ev, w)(name)) or w != "value", ((what, name),), NUMBERS)
            self._demand(lambda: self.ev.step(name) >= 1 or node.tag == "Float", (("step", name),), NUMBERS)
            if name not in self.bound:
                self._demand(lambda: self.ev.most(name) > self.ev.least(name) or self._fixed(name),
                             (("most", name), ("least", name)), LARGE)
        self._fill_value(name)

    def _fill_entry(self, name):
        """Chooses an entry that can be made available: the present one, else the first."""
        node = self.ev.nodes[name]
        entries = list(node.entries)
        terminal = self.ev.terminal(name)
        value = self.ev.value(name) if self._is(lambda: self.ev.value(name) is not None) else None
        entries.sort(key=lambda e: e.number("Value") != value)
        if terminal is None or self.ev.bits_in_memory(terminal) & self.held:
            entries = [e for e in entries if e.number("Value") == value]
        for entry in entries:
            if entry.number("Value") != value and not self._fill_one(name, terminal, entry):
                continue
            for tag in ("pIsImplemented", "pIsAvailable"):
                if entry.text(tag):
                    self._demand(lambda t=entry.text(tag): self.ev.value(t), (("value", entry.text(tag)),), NUMBERS)
            if self._right(name):
                return

    def _fill_one(self, name, terminal, entry):
        number = entry.number("Value")
        return self._try([(terminal, lambda: self.ev.set(name, number))], lambda: self.ev.value(name) == number,
                         (("value", name),), False)

    def _fill_value(self, name):
        """Writes a value that is within the limits, or the first entry that is available."""
        node = self.ev.nodes[name]
        try:
            if node.tag in ("Integer", "Float", "Converter", "IntConverter"):
                least, most = self.ev.least(name), self.ev.most(name)
                values = [v for v in (least, most, 0) if math.isfinite(v) and abs(v) < 2 ** 63]
            elif node.tag == "Boolean":
                values = [0, 1]
            else:
                values = ["hilcam"]
            terminal = self.ev.terminal(name)
            if terminal is None or self.ev.bits_in_memory(terminal) & self.held:
                return False
            return any(self._try([(terminal, lambda v=v: self.ev.set(name, v))], lambda: self._right(name),
                                 self._whats(name)) for v in values)
        except WRONG:
            return False

    def _fill_formats(self):
        """Entries of PixelFormat are there if hilcam has the format, as far as the description lets one choose."""
        for entry in sorted(self.ev.nodes["PixelFormat"].entries,
                            key=lambda e: entry_of("PixelFormat", e.name, self.camera) is None):
            wanted = entry_of("PixelFormat", entry.name, self.camera) is not None
            whats = tuple(("value", entry.text(tag)) for tag in ("pIsImplemented", "pIsAvailable") if entry.text(tag))
            if whats:
                self._demand(lambda e=entry, w=wanted: self.ev.entry_available(e) == w, whats, NUMBERS)

    def _whats(self, name):
        if self.ev.nodes[name].tag == "Enumeration":
            return (("available", name), ("value", name), ("entry", name))
        return (("available", name), ("value", name), ("least", name), ("most", name), ("step", name))

    # --- demands

    @staticmethod
    def _is(check):
        try:
            return bool(check())
        except WRONG:
            return False

    def _keep(self, check, whats):
        number = len(self.checks)
        self.checks.append(check)
        self.whats.append(whats)
        for address, length, _ in self.ev.uses(*whats):
            for word in range(address >> 2, address + length + 3 >> 2) if length else ():
                self.demands.setdefault(word, set()).add(number)
        return True

    def _demand(self, check, whats, numbers):
        if self._is(check):
            return self._keep(check, whats)
        if self._open(check, whats, numbers):
            return self._keep(check, whats)
        registers = self._free(whats)
        for register in registers:
            if any(self._try([(register, lambda r=register, v=value: self.ev.set(r, v))], check, whats)
                   for value in self._values(register, numbers)):
                return True
        if self._mended(registers, check, whats, numbers):
            return self._keep(check, whats)
        tries = 0
        for first, second in itertools.combinations(registers, 2):
            for a, b in itertools.product(self._values(first, numbers)[:8], self._values(second, numbers)[:8]):
                tries += 1
                if tries > MOST_TRIES:
                    return False
                if self._try([(first, lambda: self.ev.set(first, a)), (second, lambda: self.ev.set(second, b))], check, whats):
                    return True
        return False

    def _mended(self, registers, check, whats, numbers):
        """Tries numbers that break an earlier demand, and meets that one again by another register."""
        if self.mending:
            return False
        self.mending, kept = True, self.held
        try:
            for register in registers:
                words = self._words(register)
                for value in self._values(register, numbers)[:6]:
                    mark = len(self.undo)
                    before = (self.ev.address(register), self.ev.raw(register))
                    self.ev.set(register, value)
                    self.undo.append(before)
                    self.held = kept | self.ev.bits_in_memory(register)
                    broken = [n for n in self._depending(words) if not self._is(self.checks[n])]
                    if self._is(check) and len(broken) <= 3 and \
                            all(self._demand(self.checks[n], self.whats[n], LARGE) for n in broken) and self._is(check):
                        return True
                    self.held = kept
                    while len(self.undo) > mark:
                        self.ev.write_memory(*self.undo.pop())
        except WRONG:
            pass
        finally:
            self.mending, self.held = False, kept
        return False

    def _depending(self, words):
        return set().union(*(self.demands.get(word, set()) for word in words))

    def _open(self, check, whats, numbers):
        """A formula that fails shows its next register only when the one that it fails at has a number that it takes."""
        mark = len(self.undo)
        for _ in range(4):
            registers = self._free(whats)
            if not any(self._try([(r, lambda r=r, v=v: self.ev.set(r, v))], lambda: len(self._free(whats)) > len(registers),
                                 whats, False) for r in registers for v in self._values(r, numbers)):
                break
            if self._is(check):
                return True
        while len(self.undo) > mark and not self._is(check) and not self._free(whats):
            self.ev.write_memory(*self.undo.pop())
        return False

    def _free(self, whats):
        found = {}
        for address, length, name in sorted(self.ev.uses(*whats), key=str):
            if length and self.ev.nodes[name].tag not in ("StringReg", "Register"):
                bits = self.ev.bits(name) if self.ev.nodes[name].tag != "FloatReg" else ()
                if not self.ev.bits_in_memory(name) & self.held:
                    found.setdefault((address, bits), name)
        return list(found.values())

    def _words(self, register):
        address, length = self.ev.address(register), self.ev.length(register)
        return set(range(address >> 2, address + length + 3 >> 2))

    def _values(self, register, numbers):
        if self.ev.nodes[register].tag == "FloatReg":
            return list(FLOATS)
        low, high = self.ev.bits(register)
        mask = (1 << high - low + 1) - 1
        return [v for v in dict.fromkeys((*numbers, mask, *self.constants.get(register, ())[:24])) if v <= mask]

    def _constants(self):
        """Returns the whole numbers in the formulas that look at a register, by the register's name."""
        found = {}
        for node in self.ev.nodes.values():
            texts = " ".join(node.texts("Formula") + node.texts("FormulaFrom"))
            numbers = [int(t, 0) for t in re.findall(r"\b(?:0[xX][0-9a-fA-F]+|[1-9]\d*)\b", texts)] if texts else ()
            for child in node.children.get("pVariable", ()) if numbers else ():
                name = (child.text or "").strip()
                for _ in range(4):
                    known = found.setdefault(name, [])
                    known.extend(n for n in numbers if n not in known)
                    name = self.ev.nodes[name].text("pValue") if name in self.ev.nodes else None
                    if not name:
                        break
        return found

    def _try(self, writes, check, whats, keep=True):
        before, words = [], set()
        try:
            for register, write in writes:
                before.append((self.ev.address(register), self.ev.raw(register)))
                words |= self._words(register)
                write()
            if self._is(check) and all(self._is(self.checks[n]) for n in self._depending(words)):
                if keep:
                    self._keep(check, whats)
                self.undo += before
                return True
        except WRONG:
            pass
        for address, data in reversed(before):
            self.ev.write_memory(address, data)
        return False
