"""Formulas of SwissKnives and Converters (GenICam Standard 2.1.1, 2.8.13), as Python functions.

Operators in rising order: ?: || && | ^ & (= <>) (< > <= >=) (<< >>) (+ -) (* / %) ** and the signs. Formulas of whole
numbers divide as C does, towards zero; all numbers of the others are floats.
"""
import math
import re

TOKEN = re.compile(r"\s*(0[xX][0-9a-fA-F]+|(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?|[A-Za-z_][\w.]*|"
                   r"\*\*|<<|>>|<>|<=|>=|&&|\|\||[-+*/%&|^~<>=?:(),])")
BINARY = [{"||": "_or"}, {"&&": "_and"}, {"|": "_bits_or"}, {"^": "_bits_xor"}, {"&": "_bits_and"},
          {"=": "_equal", "<>": "_other"}, {"<": "_less", ">": "_more", "<=": "_at_most", ">=": "_at_least"},
          {"<<": "_left", ">>": "_right"}, {"+": "_add", "-": "_subtract"}, {"*": "_times", "/": "_divide", "%": "_rest"}]


class FormulaError(Exception):
    pass


def _divide(a, b):
    if isinstance(a, int) and isinstance(b, int):
        if b == 0:
            raise FormulaError("a division by zero")
        return abs(a) // abs(b) * (1 if (a < 0) == (b < 0) else -1)
    if b == 0:
        raise FormulaError("a division by zero")
    return a / b


def _rest(a, b):
    if b == 0:
        raise FormulaError("a division by zero")
    return a - b * _divide(a, b) if isinstance(a, int) and isinstance(b, int) else math.fmod(a, b)


def _power(a, b):
    if abs(b) > 4096:
        raise FormulaError("a power that is too high")
    value = a ** b
    if isinstance(value, complex):
        raise FormulaError("a root of a negative number")
    return value


def _shift(a, b, way):
    if not 0 <= int(b) <= 64:
        raise FormulaError("a shift by more than 64 bits")
    return int(a) << int(b) if way > 0 else int(a) >> int(b)


OPERATIONS = {
    "_or": lambda a, b: int(bool(a) or bool(b)), "_and": lambda a, b: int(bool(a) and bool(b)),
    "_bits_or": lambda a, b: int(a) | int(b), "_bits_xor": lambda a, b: int(a) ^ int(b),
    "_bits_and": lambda a, b: int(a) & int(b),
    "_equal": lambda a, b: int(a == b), "_other": lambda a, b: int(a != b),
    "_less": lambda a, b: int(a < b), "_more": lambda a, b: int(a > b),
    "_at_most": lambda a, b: int(a <= b), "_at_least": lambda a, b: int(a >= b),
    "_left": lambda a, b: _shift(a, b, 1), "_right": lambda a, b: _shift(a, b, -1),
    "_add": lambda a, b: a + b, "_subtract": lambda a, b: a - b, "_times": lambda a, b: a * b,
    "_divide": _divide, "_rest": _rest, "_power": _power,
}
FUNCTIONS = {
    "SIN": math.sin, "COS": math.cos, "TAN": math.tan, "ASIN": math.asin, "ACOS": math.acos, "ATAN": math.atan,
    "SINH": math.sinh, "COSH": math.cosh, "TANH": math.tanh, "ABS": abs, "EXP": math.exp, "LN": math.log,
    "LG": math.log10, "SQRT": math.sqrt, "TRUNC": math.trunc, "FLOOR": math.floor, "CEIL": math.ceil,
    "ROUND": lambda x, digits=0: math.floor(x * 10 ** digits + 0.5) / 10 ** digits, "NEG": lambda x: -x,
    "SGN": lambda x: (x > 0) - (x < 0), "E": lambda: math.e, "PI": lambda: math.pi,
}


class Formula:
    """A compiled formula. Calling it with a function from a variable's name to its value gives the result."""

    def __init__(self, text):
        self.text = text
        self.tokens = self._tokens(text)
        self.at = 0
        self.run = self._choice()
        if self.at != len(self.tokens):
            raise FormulaError(f"formula '{text}': '{self.tokens[self.at]}' is not expected")

    def __call__(self, variable, whole=False):
        known = variable if whole else lambda name: float(variable(name))
        try:
            value = self.run(known, whole)
        except (OverflowError, ValueError, ZeroDivisionError, TypeError) as error:
            raise FormulaError(f"formula '{self.text}': {error}") from error
        return int(value) if whole else value

    @staticmethod
    def _tokens(text):
        found, at = [], 0
        text = text.strip()
        while at < len(text):
            match = TOKEN.match(text, at)
            if not match:
                raise FormulaError(f"formula '{text}': '{text[at]}' is no part of a formula")
            found.append(match.group(1))
            at = match.end()
        return found

    def _next(self):
        return self.tokens[self.at] if self.at < len(self.tokens) else ""

    def _take(self, wanted):
        if self._next() != wanted:
            raise FormulaError(f"formula '{self.text}': '{wanted}' is missing")
        self.at += 1

    def _choice(self):
        condition = self._binary(0)
        if self._next() != "?":
            return condition
        self.at += 1
        yes = self._choice()
        self._take(":")
        no = self._choice()
        return lambda v, w: yes(v, w) if condition(v, w) else no(v, w)

    def _binary(self, level):
        if level == len(BINARY):
            return self._power()
        left = self._binary(level + 1)
        while self._next() in BINARY[level]:
            operation = OPERATIONS[BINARY[level][self._next()]]
            self.at += 1
            right = self._binary(level + 1)
            left = (lambda a, b, op: lambda v, w: op(a(v, w), b(v, w)))(left, right, operation)
        return left

    def _power(self):
        base = self._sign()
        if self._next() != "**":
            return base
        self.at += 1
        exponent = self._power()
        return lambda v, w: OPERATIONS["_power"](base(v, w), exponent(v, w))

    def _sign(self):
        token = self._next()
        if token in ("-", "+", "~"):
            self.at += 1
            value = self._power()
            if token == "-":
                return lambda v, w: -value(v, w)
            return value if token == "+" else lambda v, w: ~int(value(v, w))
        return self._primary()

    def _primary(self):
        token = self._next()
        self.at += 1
        if token == "(":
            value = self._choice()
            self._take(")")
            return value
        if re.match(r"0[xX]|\d+$", token):
            number = int(token, 0) if token[:2] in ("0x", "0X") else int(token)
            return lambda v, w: number if w else float(number)
        if token[:1].isdigit() or token[:1] == ".":
            return (lambda number: lambda v, w: number)(float(token))
        if not token or not (token[0].isalpha() or token[0] == "_"):
            raise FormulaError(f"formula '{self.text}': a value is missing")
        if self._next() == "(" and token.upper() in FUNCTIONS:
            return self._call(FUNCTIONS[token.upper()])
        return lambda v, w: v(token)

    def _call(self, function):
        self._take("(")
        arguments = []
        while self._next() != ")":
            arguments.append(self._choice())
            if self._next() == ",":
                self.at += 1
            elif self._next() != ")":
                raise FormulaError(f"formula '{self.text}': ')' is missing")
        self._take(")")
        return lambda v, w: function(*(argument(v, w) for argument in arguments))
