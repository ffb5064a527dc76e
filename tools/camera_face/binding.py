"""Where the features that hilcam acts on are in a real camera's registers, and what their numbers mean.

Each row of the result is one feature of hilcam in one field of a register (docs/camera_face.md, "The table"). Formulas are
resolved to constants: the vendor's own chain of nodes is evaluated for samples of the register's number, once for each entry
of the selectors above it.
"""
from . import fit as fits
from .evaluator import Evaluator, NoValue
from .formula import FormulaError
from .roles import BY_NAME, COMPUTED, COUNTED, KNIVES, PREFERRED, ROLES, SELECTED, entry_of, \
    number_of_entry, to_hilcam

REFUSED = (NoValue, FormulaError, OverflowError, KeyError, ValueError)


class Binder:
    def __init__(self, description, camera, memory, more=()):
        """more: (hilcam's feature, vendor's node, factor) that the names do not tell."""
        self.description, self.camera, self.memory = description, camera, memory
        self.ev = Evaluator(description, memory)
        self.more = more
        self.rows, self.notes = [], []
        self.held = set()  # bits of memory whose contents are settled
        self.live = set()  # those that hilcam serves itself
        self.bound = {}  # vendor's feature: (role, its value at the start)
        self.initial = []  # (selector, entry's value) that the registers begin with
        self.states = []  # (vendor's feature, selector, its entry; None, None without a selector) that rows were made for
        self.taken, self.fields = {}, []

    def bind(self):
        for role in ROLES:
            names = list(role.names) + [node for feature, node, _ in self.more if feature == role.feature]
            for name in names:
                if name in self.ev.nodes:
                    self._bind_name(role, name)
            if role.kind != "command" and not any(name in self.bound for name in names):
                self.notes.append(f"{role.feature}: the description has none in a register")
        for name, selector, entry in self.states:
            if name in self.bound and self.bound[name][0].limits:
                try:
                    if selector and self.ev.value(selector) != entry.number("Value"):
                        self.ev.set(selector, entry.number("Value"))
                except REFUSED:
                    continue  # a computed selector has moved with other registers
                self._bind_limits(self.bound[name][0], name)
        for selector, value in self.initial:
            self.ev.set(selector, value)
        return self.rows

    # --- one feature under its selector

    def _bind_name(self, role, name):
        selector = role.selector if role.selector in self.ev.nodes and \
            name in self.ev.node(role.selector).texts("pSelected") else ""
        try:
            if not selector:
                if self._bind_state(role, name, None, {}):
                    self.states.append((name, None, None))
                return
            entries = self._entries_to_bind(selector)
            places = self._places(selector, name)
        except REFUSED as error:
            self.notes.append(f"{name}: {error}")
            return
        first = None
        for entry, target in entries:
            try:
                self._select(selector, entry)
            except REFUSED:
                if self.ev.value(selector) != entry.number("Value"):
                    continue  # computed, and not this one
            shared = sum(place == places.get(entry.name) for place in places.values()) > 1
            try:
                when = self._when(selector) if shared else []
                done = self._bind_state(role, name, when, {selector: target} if target else {})
            except REFUSED as error:
                self.notes.append(f"{name}[{entry.name}]: {error}")
                continue
            if done:
                self.states.append((name, selector, entry))
            first = first or (done and entry)
        if first and self.ev.terminal(selector):
            self._select(selector, first)
            if all(known != selector for known, _ in self.initial):
                self.initial.append((selector, first.number("Value")))

    def _select(self, selector, entry):
        self.ev.set(selector, entry.number("Value"))
        terminal = self.ev.terminal(selector)
        if terminal:
            self._hold(terminal)

    def _entries_to_bind(self, selector):
        """Returns (entry, hilcam's entry of the same selector; empty: hilcam has one feature for all)."""
        entries = self.ev.node(selector).entries
        if not entries:
            raise NoValue(f"{selector} is no list of entries")
        if selector in SELECTED:
            found = [(entry, SELECTED[selector][entry.name]) for entry in entries if entry.name in SELECTED[selector]]
            return found or ([(entries[0], "FrameStart")] if selector == "TriggerSelector" else [])
        names = [entry.name for entry in entries]
        best = next((entries[names.index(name)] for name in PREFERRED.get(selector, ()) if name in names), entries[0])
        found = [(best, "")]
        if self.ev.terminal(selector) is None:  # clients begin with the description's own
            found += [(entry, "") for entry in entries
                      if entry is not best and entry.number("Value") == self.ev.value(selector)]
        return found

    def _places(self, selector, name):
        found = {}
        for entry in self.ev.node(selector).entries:
            try:
                self.ev.set(selector, entry.number("Value"))
                terminal = self.ev.terminal(name)
                found[entry.name] = terminal and (self.ev.address(terminal), self.ev.bits(terminal))
            except REFUSED:
                found[entry.name] = None
        return found

    def _when(self, selector):
        terminal = self.ev.terminal(selector)
        if not terminal:
            return []  # the selector is the client's: the register is the same for all entries
        return [{"at": self.place(terminal), "is": self.ev.value(terminal)}]

    def _bind_state(self, role, name, when, select):
        place_node = self._register_of(role, name)
        if place_node is None:
            return False
        row = {"feature": role.feature, "at": self.place(place_node)}
        if select:
            row["select"] = select
        if when:
            row["when"] = when
        key = (row["at"]["address"], row["at"]["low"], row["at"]["high"], str(when),
               row.get("command") if role.kind != "command" else self._command_value(name))
        if key in self.taken:
            if self.taken[key] == role.feature:
                self.bound.setdefault(name, (role, self.camera.values.get(role.feature)))
            return self.taken[key] == role.feature
        bits = self._bits(place_node)
        if role.kind != "command" and any(bits & other and (when or []) == guards for other, guards in self.fields):
            self.notes.append(f"{name}: its bits are another feature's")
            return False
        made = {"command": self._command, "choice": self._choice, "switch": self._switch}.get(role.kind, self._number)(
            role, name, place_node, row)
        if not made:
            return False
        self.taken[key] = role.feature
        self.rows.append(row)
        if role.kind != "command":
            self.fields.append((bits, when or []))
        self._hold(place_node)
        self.live |= self._bits(place_node)
        if role.kind != "command":
            self.bound.setdefault(name, (role, self.camera.values.get(role.feature)))
        return True

    def _register_of(self, role, name):
        """Returns the register node that holds a feature; of a formula, the one that moves it."""
        terminal = self.ev.terminal(name)
        if terminal:
            return terminal if self.description.on_device(self.ev.node(terminal)) else None
        if role.feature not in COMPUTED or (self.ev.source(name) is None and self.ev.node(name).tag not in KNIVES):
            return None
        return self._mover(("value", name))

    def _mover(self, what):
        """Returns the register not yet bound by which a computed value can be moved, best of all by a formula."""
        kind, name = what
        choice = None
        for _, length, register in sorted(self.ev.uses(what), key=str):
            if not register or not length or self._bits(register) & (self.live | self.held):
                continue
            rows = self._curve(register, lambda: getattr(self.ev, kind)(name), self._samples(register))
            formula = fits.fit(rows, None, None, False)
            if formula is not None and formula["kind"] != "points":
                return register
            if len({value for _, value in rows}) > 1:
                choice = choice or register
        return choice

    # --- kinds of rows

    def _command_value(self, name):
        node = self.ev.node(name)
        value = node.number("CommandValue")
        return value if value is not None else self.ev.value(node.text("pCommandValue")) if node.text("pCommandValue") else 1

    def _command(self, role, name, register, row):
        before = self.ev.raw(register)
        self.ev.set(self.ev.source(name), self._command_value(name))
        row["command"] = self.ev.value(register)
        self.ev.write_memory(self.ev.place(register), before)
        return True

    def _choice(self, role, name, register, row):
        node, before = self.ev.node(name), self.ev.raw(register)
        entries = node.entries
        pairs = [(entry.name, entry.number("Value")) for entry in entries]
        if node.tag == "Boolean":
            pairs = [("On", 1), ("Off", 0)]
        values, seen = [], set()
        for entry, number in pairs:
            target = entry_of(role.feature, entry, self.camera)
            if target is None:
                continue
            try:
                self.ev.set(name, number)
                raw = self.ev.value(register)
                if self.ev.value(name) != number or raw in seen:
                    continue
            except REFUSED:
                continue
            seen.add(raw)
            values.append([raw, target])
        self.ev.write_memory(self.ev.place(register), before)
        if not values:
            self.notes.append(f"{name}: none of its entries is one of hilcam's")
            return False
        row["values"] = values
        wanted = self.camera.values.get(role.feature)
        first = next((raw for raw, target in values if target == wanted), values[0][0])
        self.ev.set(register, first)
        return True

    def _switch(self, role, name, register, row):
        node, before = self.ev.node(name), self.ev.raw(register)
        states = {1: 1, 0: 0}
        if node.tag == "Enumeration":
            states = {}
            for entry in node.entries:
                if entry.name in ("On", "True", "Enabled", "Off", "False", "Disabled"):
                    states[int(entry.name in ("On", "True", "Enabled"))] = entry.number("Value")
        row["values"] = []
        for state, number in states.items():
            self.ev.set(name, number)
            row["values"].append([self.ev.value(register), state])
        self.ev.write_memory(self.ev.place(register), before)
        off = next((raw for raw, state in row["values"] if state == 0), None)
        if len(row["values"]) < 2 or row["values"][0][0] == row["values"][1][0]:
            return False
        self.ev.set(register, off)
        return True

    def _number(self, role, name, register, row):
        if self.ev.node(name).tag == "Enumeration":
            return self._numbered_choice(role, name, register, row)
        forward, back = self._conversion(role, name)
        raws = self._samples(register)
        before = self.ev.raw(register)
        get = lambda: forward(self.ev.value(name))  # noqa: E731
        put = lambda raw: self.ev.set(register, raw)  # noqa: E731
        formula = fits.fit(fits.curve(put, get, raws), put, get)
        if formula is None or not self._is_fine(register, name, formula):
            formula = self._with_parameters(register, name, put, get) or formula
        self.ev.write_memory(self.ev.place(register), before)
        if formula is None:
            self.notes.append(f"{name}: its register does not move it")
            self._settle(name, register, forward, back, self.camera.values[role.feature])
            return False
        if formula["kind"] == "points" and self.ev.terminal(name) is None:
            self._put_nearest(register, name, forward)  # it says which of a few sensors this is
            return False
        row["formula"] = formula
        self._put_value(register, formula, self.camera.values[role.feature])
        return True

    def _with_parameters(self, register, name, put, get):
        """Gives another register of the formula, such as a time base, a number with which the formula works."""
        put(1)
        for _, length, other in sorted(self.ev.uses(("value", name)), key=str):
            if not length or other == register or self._bits(other) & (self.held | self._bits(register)):
                continue
            before = self.ev.raw(other)
            found = []
            for number in (1000000, 100000, 10000, 1000, 100, 16, 10, 8, 1):
                try:
                    self.ev.set(other, number)
                except REFUSED:
                    break
                formula = fits.fit(fits.curve(put, get, self._samples(register)), put, get, False)
                if formula is not None:
                    found.append((self._is_fine(register, name, formula), -len(found), number, formula))
            if found:
                _, _, number, formula = max(found, key=lambda f: f[:2])
                self.ev.set(other, number)
                self._hold(other)
                return formula
            self.ev.write_memory(self.ev.place(other), before)
        return None

    def _is_fine(self, register, name, formula):
        """True where the register has steps of at most a hundredth for the value at the start, and room for the limits."""
        feature = BY_NAME[name].feature if name in BY_NAME else None
        if self.ev.node(register).tag == "FloatReg" or formula["kind"] == "points":
            return True
        values = [self.camera.values.get(feature) or 0, *self.camera.limits.get(feature, ())]
        raws = [fits.inverse(formula, value) for value in values]
        low, high = self.ev.bits(register)
        if feature in COUNTED:
            return None not in raws
        return None not in raws and (abs(raws[0]) >= 100 or values[0] == 0) and max(map(abs, raws)) < 1 << high - low + 1

    def _numbered_choice(self, role, name, register, row):
        """Binning or shutter times as a list of entries, by the numbers in their names."""
        values = []
        for entry in self.ev.node(name).entries:
            number = number_of_entry(role, entry.name, self.camera)
            if number is not None:
                self.ev.set(name, entry.number("Value"))
                values.append([self.ev.value(register), number])
        if not values:
            self.notes.append(f"{name}: none of its entries is within hilcam's limits")
            return False
        row["values"] = values
        wanted = self.camera.values[role.feature]
        self.ev.set(register, min(values, key=lambda pair: abs(pair[1] - wanted))[0])
        return True

    def _put_value(self, register, formula, value):
        raw = fits.inverse(formula, value)
        if raw is None:
            return
        if self.ev.node(register).tag != "FloatReg":
            low, high = self.ev.bits(register)
            raw = min(max(int(round(raw)), 0 if not self.ev.signed(register) else -(1 << high - low)), (1 << high - low + 1) - 1)
        self.ev.set(register, raw)

    def _put_nearest(self, register, name, forward):
        rows = self._curve(register, lambda: forward(self.ev.value(name)), range(64))
        wanted = self.camera.values[BY_NAME[name].feature]
        self.ev.set(register, min(rows, key=lambda row: abs(row[1] - wanted))[0])
        self._hold(register)

    def _settle(self, name, register, forward, back, value):
        """Keeps a feature on which hilcam can't act, such as binning within other bits, at hilcam's own value."""
        if self._bits(register) & (self.live | self.held):
            return
        before = self.ev.raw(register)
        try:
            self.ev.set(name, back(value))
            if forward(self.ev.value(name)) == value:
                self._hold(register)
                return
        except REFUSED:
            pass
        self.ev.write_memory(self.ev.place(register), before)

    def _conversion(self, role, name):
        node = self.ev.node(name)
        unit = node.text("Unit", "")
        constant = {}
        for tag, which in (("Min", "least"), ("Max", "most")):
            constant[tag] = None
            if node.text(tag) is not None or node.text("p" + tag):
                whats = (which, name)
                if not any(length for _, length, _ in self.ev.uses(whats)):
                    try:
                        constant[tag] = getattr(self.ev, which)(name)
                    except REFUSED:
                        pass
        for feature, vendors, factor in self.more:
            if vendors == name and feature == role.feature:
                return (lambda v: v * factor, lambda v: v / factor)
        return to_hilcam(role, name, unit, constant["Min"], constant["Max"], self.camera)

    # --- limits

    def _bind_limits(self, role, name):
        forward, _ = self._conversion(role, name)
        node = self.ev.node(name)
        for tag, which, number in (("Min", "least", 0), ("Max", "most", 1)):
            source = node.text("p" + tag)
            if not source or source not in self.ev.nodes:
                continue
            try:
                terminal = self.ev.terminal(source)
                computed = terminal is None
                static = False
                if computed:
                    terminal = self._mover((which, name))
                    static = len({use for use in self.ev.uses((which, name)) if use[1]}) > 1
                if terminal is None or self._bits(terminal) & self.live or terminal in self.bound:
                    continue
                get = lambda: forward(getattr(self.ev, which)(name))  # noqa: E731
                put = lambda raw: self.ev.set(terminal, raw)  # noqa: E731
                before = self.ev.raw(terminal)
                formula = fits.fit(fits.curve(put, get, self._samples(terminal)), put, get)
                self.ev.write_memory(self.ev.place(terminal), before)
                if formula is None or (computed and formula["kind"] == "points"):
                    continue  # a register that says which of a few cameras this is, or the binning
                self._put_value(terminal, formula, self.camera.limits[role.feature][number])
            except REFUSED as error:
                self.notes.append(f"{name}, p{tag}: {error}")
                continue
            self._hold(terminal)
            if not static and self.ev.length(terminal) <= 8:
                self.live |= self._bits(terminal)
                self.fields.append((self._bits(terminal), []))
                self.rows.append({"feature": role.feature, "of": tag.lower(), "at": self.place(terminal), "formula": formula})

    # --- registers

    def place(self, register):
        low, high = self.ev.bits(register)
        kind = "float" if self.ev.node(register).tag == "FloatReg" else "signed" if self.ev.signed(register) else "unsigned"
        return {"address": self.ev.address(register), "bytes": self.ev.length(register), "endian": self.ev.endian(register),
                "low": low, "high": high, "kind": kind}

    def _bits(self, register):
        return self.ev.bits_in_memory(register)

    def _hold(self, register):
        self.held |= self._bits(register)

    def _samples(self, register):
        if self.ev.node(register).tag in ("StringReg", "Register"):
            return []
        low, high = self.ev.bits(register)
        if self.ev.signed(register):
            return fits.samples_of(-(1 << high - low), (1 << high - low) - 1, False)
        return fits.samples_of(0, (1 << min(high - low + 1, 62)) - 1, self.ev.node(register).tag == "FloatReg")

    def _curve(self, register, get, raws):
        before = self.ev.raw(register)
        rows = fits.curve(lambda raw: self.ev.set(register, raw), get, raws)
        self.ev.write_memory(self.ev.place(register), before)
        return rows
