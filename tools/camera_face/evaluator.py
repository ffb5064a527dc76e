"""Values of a description's nodes over a memory, and which registers they depend on (GenICam Standard 2.1.1, 2.8)."""
import math

from .description import REGISTERS, DescriptionError, number_of
from .formula import Formula, FormulaError
from .register_nodes import NoValue, RegisterNodes, words


class Evaluator(RegisterNodes):
    """memory: read(address, bytes) and write(address, data). Values are kept until a register below them changes."""

    def __init__(self, description, memory):
        self.description = description
        self.nodes = description.nodes
        self.memory = memory
        self.local = {}  # values of nodes without a register
        self.kept, self.used_by = {}, {}
        self.tracing, self.running = [], []
        self.chunks_open = False  # registers of chunks are then in the memory, each port at a place of its own

    # --- what depends on what

    def _note(self, key):
        if self.tracing:
            self.tracing[-1].add(key)

    def _kept(self, what, name, compute):
        """Returns compute()'s value, from before if no register below it has changed."""
        key = (what, name)
        if key not in self.kept:
            if key in self.running:
                raise DescriptionError(f"{self.description.path}: a loop of references: " +
                                       " -> ".join(n for _, n in self.running[self.running.index(key):] + [key]))
            if len(self.running) > 200:
                raise DescriptionError(f"{self.description.path}: {name}: references are more than 200 deep")
            self.running.append(key)
            self.tracing.append(set())
            try:
                value = compute()
            except (NoValue, FormulaError) as error:
                value = NoValue(str(error))
            finally:
                self.running.pop()
                uses = self.tracing.pop()
            self.kept[key] = (value, uses)
            for use in uses:
                for word in words(use):
                    self.used_by.setdefault(word, set()).add(key)
        value, uses = self.kept[key]
        if self.tracing:
            self.tracing[-1] |= uses
        if isinstance(value, NoValue):
            raise value
        return value

    def _changed(self, use):
        for word in words(use):
            for key in self.used_by.pop(word, ()):
                self.kept.pop(key, None)

    def write_memory(self, address, data):
        self.memory.write(address, data)
        self._changed((address, len(data), ""))

    def uses(self, *whats):
        """Returns what values depend on: (address, bytes, register node), or ("", 0, node without a register)."""
        self.tracing.append(set())
        try:
            for what, name in whats:
                try:
                    getattr(self, what)(name)
                except NoValue:
                    pass
        finally:
            found = self.tracing.pop()
        return found

    def node(self, name):
        if name not in self.nodes:
            raise NoValue(f"there is no node '{name}'")
        return self.nodes[name]

    # --- values

    def value(self, name):
        return self._kept("value", name, lambda: self._value(self.node(name)))

    def _value(self, node):
        if node.tag in REGISTERS:
            return self._register(node)
        if node.tag in ("SwissKnife", "IntSwissKnife"):
            return self._formula(node, "Formula", node.tag == "IntSwissKnife")
        if node.tag in ("Converter", "IntConverter"):
            return self._formula(node, "FormulaFrom", node.tag == "IntConverter",
                                 {"TO": self.value(node.text("pValue"))})
        if node.tag in ("Category", "Port", "Node"):
            raise NoValue(f"{node.name} is a {node.tag}")
        value = self._of_feature(node)
        if node.tag == "Boolean":
            return int(value == node.number("OnValue", 1))
        return int(value) if node.tag in ("Integer", "Enumeration") and not isinstance(value, str) else value

    def source(self, name):
        """Returns the node whose value a feature's is at present; None: the feature keeps it itself."""
        node = self.node(name)
        if node.text("pValue"):
            return node.text("pValue")
        if node.text("pIndex"):
            index = int(self.value(node.text("pIndex")))
            for child in node.children.get("pValueIndexed", ()):
                if number_of(child.get("Index", "0"), name) == index:
                    return child.text.strip()
            return node.text("pValueDefault")
        return None

    def _of_feature(self, node):
        source = self.source(node.name)
        if source is not None:
            return self.value(source)
        self._note(("", 0, node.name))
        if node.name in self.local:
            return self.local[node.name]
        if node.text("pIndex"):
            index = int(self.value(node.text("pIndex")))
            for child in node.children.get("ValueIndexed", ()):
                if number_of(child.get("Index", "0"), node.name) == index:
                    return number_of(child.text.strip(), node.name)
            return node.number("ValueDefault", 0)
        if node.tag == "String":
            return node.text("Value", "")
        text = node.text("Value")
        if text is None:
            raise NoValue(f"{node.name} has neither Value nor pValue")
        return {"true": 1, "false": 0}.get(text.lower()) if text.lower() in ("true", "false") else \
            number_of(text, f"{node.name}, Value")

    def _variable(self, element, whole, given):
        names = {child.get("Name"): (child.text or "").strip() for child in element.get("pVariable", ())}
        fixed = {child.get("Name"): number_of((child.text or "").strip(), "Constant")
                 for child in element.get("Constant", ())}
        expressions = {child.get("Name"): child.text or "0" for child in element.get("Expression", ())}

        def of(variable):
            if variable in given:
                return given[variable]
            if variable in fixed:
                return fixed[variable]
            if variable in expressions:
                return Formula(expressions[variable])(of, whole)
            if variable not in names:
                raise NoValue(f"a formula's variable '{variable}' is not declared")
            return self._part_of(names[variable], variable, whole)
        return of

    def _part_of(self, name, variable, whole):
        """A variable may be NAME.Min, NAME.Max, NAME.Inc, NAME.Value, NAME.Enum or NAME.Entry.X of its node."""
        parts = variable.split(".")
        if len(parts) > 1 and parts[1] in ("Min", "Max", "Inc"):
            value = {"Min": self.least, "Max": self.most, "Inc": self.step}[parts[1]](name)
        elif len(parts) > 2 and parts[1] in ("Entry", "Enum"):
            value = next((e.number("Value") for e in self.node(name).entries if e.name == parts[2]), None)
            if value is None:
                raise NoValue(f"'{name}' has no entry '{parts[2]}'")
        else:
            value = self.value(name)
        if isinstance(value, str):
            raise NoValue(f"'{name}' is a text")
        return int(value) if whole else value

    def _formula(self, node, tag, whole, given=None):
        text = node.text(tag)
        if text is None:
            raise NoValue(f"{node.name} has no {tag}")
        if not isinstance(node.formula, dict):
            node.formula = {}
        if tag not in node.formula:
            node.formula[tag] = Formula(text)
        value = node.formula[tag](self._variable(node.children, whole, given or {}), whole)
        if isinstance(value, float) and not math.isfinite(value):
            raise NoValue(f"{node.name}: {value}")
        return value

    def _inline(self, node, element):
        children = {}
        for child in element:
            children.setdefault(child.tag.rsplit("}", 1)[-1], []).append(child)
        return Formula(children["Formula"][0].text)(self._variable(children, True, {}), True)

    def set(self, name, value):
        """Writes a value through a node to its register."""
        node = self.node(name)
        if node.tag in REGISTERS:
            self._write_register(node, value)
        elif node.tag in ("Converter", "IntConverter"):
            raw = self._formula(node, "FormulaTo", node.tag == "IntConverter", {"FROM": value})
            self.set(node.text("pValue"), raw)
        elif node.tag in ("SwissKnife", "IntSwissKnife"):
            raise NoValue(f"{name} is computed")
        else:
            if node.tag == "Boolean":
                value = node.number("OnValue", 1) if value else node.number("OffValue", 0)
            source = self.source(name)
            if source is not None:
                self.set(source, value)
            else:
                self.local[name] = value
                self._changed(("", 0, name))

    # --- limits

    def _limit(self, name, tag):
        node = self.node(name)
        if node.text("p" + tag):
            return self.value(node.text("p" + tag))
        if node.text(tag) is not None:
            return node.number(tag)
        return None

    def least(self, name):
        return self._kept("least", name, lambda: self._bound(name, "Min", 0))

    def most(self, name):
        return self._kept("most", name, lambda: self._bound(name, "Max", 1))

    def _bound(self, name, tag, which):
        own = self._limit(name, tag)
        if own is not None:
            return own
        node = self.node(name)
        if node.tag in ("IntReg", "MaskedIntReg", "StructEntry"):
            low, high = self.bits(name)
            count = high - low + 1
            return (-(1 << count - 1), (1 << count - 1) - 1)[which] if self.signed(name) else (0, (1 << count) - 1)[which]
        if node.tag in ("Integer", "Float"):
            source = self.source(name)
            if source is not None:
                return self._bound(source, tag, which)
        if node.tag in ("Converter", "IntConverter"):
            source = node.text("pValue")
            if self._is_unlimited(source):
                return self._bound_of_formula(node, which)
            ends = []
            for end in (0, 1):
                raw = self._bound(node.text("pValue"), ("Min", "Max")[end], end)
                ends.append(self._formula(node, "FormulaFrom", node.tag == "IntConverter", {"TO": raw}))
            return (min, max)[which](ends)
        return (-math.inf, math.inf)[which]

    def _is_unlimited(self, name):
        """True where nothing but a register's size limits a value."""
        for _ in range(100):
            node = self.nodes.get(name)
            if node is None or any(node.text(tag) for tag in ("Min", "pMin", "Max", "pMax")):
                return False
            if node.tag in REGISTERS:
                return True
            name = node.text("pValue") if node.tag in ("Converter", "IntConverter") else self.source(name)
        return False

    def _bound_of_formula(self, node, which):
        """Where nothing but the register's size is a limit, a formula may have no value at its ends."""
        ends = []
        for end in (0, 1):
            try:
                raw = self._bound(node.text("pValue"), ("Min", "Max")[end], end)
                ends.append(self._formula(node, "FormulaFrom", node.tag == "IntConverter", {"TO": raw}))
            except (NoValue, FormulaError, OverflowError, ValueError):
                return (-math.inf, math.inf)[which]
        return (min, max)[which](ends)

    def step(self, name):
        def compute():
            own = self._limit(name, "Inc")
            source = self.source(name) if own is None and self.node(name).tag == "Integer" else None
            return own if own is not None else self.step(source) if source and self.node(source).tag == "Integer" else 1
        return self._kept("step", name, compute)

    # --- availability

    def _all(self, name, tag, otherwise):
        """The node's own reference of that kind, and those of the nodes that hold its value."""
        node = self.node(name)
        if node.text(tag) and bool(self.value(node.text(tag))) != otherwise:
            return not otherwise
        source = self.source(name) if node.tag in ("Integer", "Float", "Boolean", "Enumeration", "Command", "String") else \
            node.text("pValue") if node.tag in ("Converter", "IntConverter") else None
        return self._all(source, tag, otherwise) if source else otherwise

    def implemented(self, name):
        return self._kept("implemented", name, lambda: self._all(name, "pIsImplemented", True))

    def available(self, name):
        return self._kept("available", name, lambda: self.implemented(name) and self._all(name, "pIsAvailable", True))

    def locked(self, name):
        return self._kept("locked", name, lambda: self._all(name, "pIsLocked", False))

    def entry_available(self, entry):
        try:
            return all(bool(self.value(entry.text(tag))) for tag in ("pIsImplemented", "pIsAvailable") if entry.text(tag))
        except NoValue:
            return False

    def entry(self, name):
        """Returns the entry that an enumeration's value is, and whether it is there; None: none has that value."""
        value = self.value(name)
        for entry in self.node(name).entries:
            if entry.number("Value") == value:
                return entry.name, self.entry_available(entry)
        return None

    def terminal(self, name):
        """Returns the register node that a feature's value is in; None: it has none, or a formula of several."""
        for _ in range(100):
            node = self.node(name)
            if node.tag in REGISTERS:
                return name
            if node.tag in ("Converter", "IntConverter"):
                name = node.text("pValue")
            elif node.tag in ("SwissKnife", "IntSwissKnife"):
                return None
            else:
                name = self.source(name)
            if name is None:
                return None
        return None

    def access(self, name):
        node = self.node(name)
        own = node.text("ImposedAccessMode")
        if own:
            return own
        if node.tag in REGISTERS:
            return node.text("AccessMode", "RO")
        if node.tag in ("SwissKnife", "IntSwissKnife"):
            return "RO"
        source = node.text("pValue") or (self.source(name) if node.tag in ("Integer", "Float") else None)
        return self.access(source) if source else "RW"
