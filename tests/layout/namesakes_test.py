#!/usr/bin/python3
"""Sources of a library that a unity build may compile as one give no two things in unnamed namespaces one name, however the build cuts
the list of sources: constants, types and functions of equal parameters. Nor has a function a constant of its own that is named as another source's, as the compiler would warn that it
shadows that.

Prints each name with the sources that have it. The compiler says the same, but only for the sources that it meets together.
"""
import collections
import pathlib
import re
import sys

TOP = pathlib.Path(__file__).resolve().parents[2]
LAYERS = ("emulator", "io", "sensor", "render")
CONSTANT = re.compile(r"^(?:static |inline )?(?:constexpr|const)\b[^(={;]*?\b(k[A-Z]\w*)\s*(?:[={\[]|;)")
FURTHER_CONSTANT = re.compile(r",\s*(k[A-Z]\w*)\s*=[^=]")
TYPE = re.compile(r"^(?:struct|class|enum class|enum|union)\s+(\w+)\s*(?:[{:]|final)")
ALIAS = re.compile(r"^using\s+(\w+)\s*=\s*([^;]+);")
FUNCTION = re.compile(r"^(?:\[\[\w+\]\]\s*)?(?!template|return|using|namespace|typedef|static_assert|HILCAM_CHECK)[\w:<>,&*\s]+?[\s&*](\w+)\(")
LOCAL_CONSTANT = re.compile(r"^\s+(?:static )?(?:constexpr|const)\b[^(={;]*?\b(k[A-Z]\w*)\s*[={\[]", re.MULTILINE)
LOCAL_CONSTANTS = re.compile(r"^\s+(?:static )?constexpr\b[^;]*;", re.MULTILINE)


def libraries():
    """The sources of each library that a unity build joins."""
    for layer in LAYERS:
        text = (TOP / layer / "CMakeLists.txt").read_text()
        apart = set()
        for files, properties in re.findall(r"set_source_files_properties\(([^)]*?) PROPERTIES([^)]*)\)", text):
            if re.search(r"SKIP_UNITY|COMPILE_OPTIONS|COMPILE_DEFINITIONS|INCLUDE_DIRECTORIES", properties):
                apart |= set(files.split())
        for name, sources in re.findall(r"add_library\((\w+) (?:STATIC|OBJECT)\s+((?:[^()]|\([^()]*\))*)\)", text):
            if not re.search(rf"set_target_properties\({name} PROPERTIES UNITY_BUILD OFF\)", text):
                yield name, [f"{layer}/{s}" for s in re.sub(r"#.*", "", sources).split() if s.endswith(".cpp") and "$" not in s and s not in apart]


def parameters(text):
    """The types of a list of parameters that begins here, as text."""
    depth, end = 1, 0
    while depth and end < len(text):
        depth += (text[end] == "(") - (text[end] == ")")
        end += 1
    types = []
    for one in re.split(r",(?![^<]*>)", re.sub(r"\s+", " ", text[:end - 1])):
        one = one.split("=")[0].strip()
        types.append(re.sub(r"(?<=[\s&*])\w+$", "", one).replace(" ", "") if re.search(r"[\s&*]", one) else one)
    return ",".join(types)


def unnamed(text):
    """What a source's unnamed namespaces declare at their top: kind, name, and a function's parameters or an alias' meaning."""
    for body in re.findall(r"^namespace \{\n(.*?)^\}  // namespace$", text, re.MULTILINE | re.DOTALL):
        body = re.sub(r"//[^\n]*", "", body)
        at = 0
        for line in body.split("\n"):
            if line and not line[0].isspace():
                if match := CONSTANT.match(line):
                    for name in [match[1], *FURTHER_CONSTANT.findall(line)]:
                        yield "constant", name, ""
                elif match := TYPE.match(line):
                    yield "type", match[1], ""
                elif match := ALIAS.match(line):
                    yield "type", match[1], match[2]
                elif match := FUNCTION.match(line):
                    yield "function", match[1], parameters(body[at + match.end():])
            at += len(line) + 1


def namesakes(sources):
    """Lines that say which names meet in a list of sources."""
    declared, constants, local = collections.defaultdict(dict), set(), collections.defaultdict(set)
    for source in sources:
        text = (TOP / source).read_text()
        for kind, name, mark in unnamed(text):
            is_function = kind == "function"
            declared[f"{name}({mark})" if is_function else name].setdefault(source, "" if is_function else mark)
            constants |= {name} if kind == "constant" else set()
        for name in LOCAL_CONSTANT.findall(text) + sum(map(FURTHER_CONSTANT.findall, LOCAL_CONSTANTS.findall(text)), []):
            local[name].add(source)
    for name, places in sorted(declared.items()):
        shadowing = local[name] - set(places) if name in constants else set()
        # Aliases of one type are no two things.
        if len(places) > 1 and (len(set(places.values())) > 1 or "" in places.values()) or shadowing:
            yield f"{name}: {', '.join(sorted(set(places) | shadowing))}"


def main():
    faults, count = [], 0
    for library, sources in libraries():
        count += len(sources)
        faults += [f"{library}: {line}" for line in namesakes(sources)]
    print(f"{count} sources, {len(faults)} names that meet")
    print("\n".join(faults))
    sys.exit(1 if faults or count < 500 else 0)


main()
