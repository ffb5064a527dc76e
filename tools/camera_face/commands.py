"""The subcommands of hilcam-camera-face."""
import pathlib
import sys

from . import bootstrap, chunks, face_file
from .binding import Binder
from .description import Description, DescriptionError
from .evaluator import NoValue
from .filling import Filler
from .formula import FormulaError
from .registers import Memory, read_file
from .roles import BY_NAME, ROLES, Camera


def main(parser):
    commands = parser.add_subparsers(dest="command", required=True)
    record = commands.add_parser("record", help="reads a real camera's registers")
    record.add_argument("address", help="the camera's IPv4 address, or its name in Aravis")
    record.add_argument("-o", "--out", required=True, help="the registers file")
    bind = commands.add_parser("bind", help="makes the face table")
    bind.add_argument("xml", help="the description: text, zip, or what arv-tool genicam leaves")
    bind.add_argument("camera", help="camera file or scenario of hilcam")
    bind.add_argument("-o", "--out", required=True, help="the face table")
    bind.add_argument("--registers", help="what `record` wrote")
    bind.add_argument("--map", action="append", default=[], metavar="FEATURE=NODE[*FACTOR]",
                      help="a feature of hilcam in a node that its name does not tell; hilcam's number is FACTOR times the node's")
    bind.add_argument("--set", action="append", default=[], metavar="KEY=NUMBER", help="a key of the camera, such as width_px=640")
    bind.add_argument("--quiet", action="store_true", help="prints nothing but errors")
    options = parser.parse_args()
    try:
        return run_record(options) if options.command == "record" else run_bind(options)
    except (DescriptionError, OSError) as error:
        print(f"hilcam-camera-face: {error}", file=sys.stderr)
        return 2
    except (NoValue, FormulaError, RecursionError) as error:
        print(f"hilcam-camera-face: {getattr(options, 'xml', options.command)}: {error}", file=sys.stderr)
        return 2


def run_record(options):
    from .record import record
    registers, words, failed, xml = record(options.address, options.out)
    print(f"{options.out}: {words} words of {registers} registers; {len(failed)} words were refused")
    for word, why in list(failed.items())[:5]:
        print(f"  0x{4 * word:08x}: {why}")
    print(f"{xml}: the description")
    return 0


# --- bind

def run_bind(options):
    description = Description(options.xml)
    camera = Camera(camera_values(options.camera, options.set))
    content, report = bound(description, camera, options.registers, [mapping(text) for text in options.map])
    face_file.write(options.out, content)
    if not options.quiet:
        print(report)
    return 0


def bound(description, camera, registers_file=None, more=()):
    """Returns the face table of a description with a camera behind it, and what there is to say about it."""
    memory = Memory()
    identity = {"vendor": description.vendor.replace("_", " "), "model": description.model}
    recorded = read_file(registers_file, memory) if registers_file else set()
    for key, address in (("vendor", 0x48), ("model", 0x68), ("version", 0x88)):
        text = memory.read(address, 32).split(b"\0")[0].decode("ascii", "replace")
        if address >> 2 in recorded and text:
            identity[key] = text
    standard = bootstrap.put(memory, {0x48: identity["vendor"], 0x68: identity["model"], 0x88: identity.get("version", "1.0")})
    for _, node, _ in more:
        if node not in description.nodes:
            raise DescriptionError(f"--map: {description.path} has no node '{node}'")
    binder = Binder(description, camera, memory, more)
    binder.held |= standard
    binder.held |= {bit for word in recorded for bit in range(32 * word, 32 * word + 32)}
    binder.bind()
    filler = Filler(binder.ev, binder.held, binder.bound, binder.states, camera)
    features = description.features()
    wrong = filler.fill(features)
    layout = chunks.layout(binder)
    rows = [(address, data) for address, data in memory.runs({w for w in memory.written if w < 1 << 30})
            if any(data) and address >= 0]
    content = face_file.table(binder, identity, own(rows), layout)
    return content, summary(binder, filler, features, wrong, layout)


def own(rows):
    """Without the standard's registers, which hilcam has itself."""
    standard = set(bootstrap.NUMBERS) | {a + i for a, n in bootstrap.TEXTS.items() for i in range(0, n, 4)}
    found = []
    for address, data in rows:
        begin = 0
        for at in range(0, len(data) + 4, 4):
            if at >= len(data) or address + at in standard:
                if data[begin:at].strip(b"\0"):
                    found.append((address + begin, data[begin:at]))
                begin = at + 4
    return found


def summary(binder, filler, features, wrong, layout):
    readable = [name for name in features if filler._readable(name)]
    available = [name for name in readable if filler._is(lambda n=name: binder.ev.available(n))]
    acted_on = sorted({row["feature"] for row in binder.rows})
    lines = [f"{binder.description.vendor} {binder.description.model}: {len(features)} features, {len(available)} of "
             f"{len(readable)} readable ones are available",
             f"  hilcam acts on {len(acted_on)}: {', '.join(acted_on)}"]
    names = {role.feature: role.names for role in ROLES}
    # Aravis and others keep TLParamsLocked themselves.
    absent = [f for f in names if f not in acted_on and f != "TLParamsLocked" and any(name in binder.ev.nodes for name in names[f])]
    if absent:
        lines.append(f"  in the description, but in no register that moves them: {', '.join(absent)}")
    sensor = [binder.ev.value(n) if n in binder.ev.nodes else None for n in ("SensorWidth", "SensorHeight")]
    if None not in sensor and sensor != [binder.camera.width, binder.camera.height]:
        lines.append(f"  the description says that the sensor has {sensor[0]:.0f} x {sensor[1]:.0f} pixels, the camera file "
                     f"{binder.camera.width} x {binder.camera.height}")
    if layout:
        lines.append(f"  chunks: {', '.join(f['chunk'] for part in layout['parts'] for f in part['fields'])}")
    if wrong:
        lines.append(f"  read wrong: {', '.join(wrong)}")
    return "\n".join(lines)


def mapping(text):
    feature, equals, node = text.partition("=")
    node, star, factor = node.partition("*")
    known = sorted({role.feature for role in BY_NAME.values()})
    if not equals or not node or feature not in known:
        raise DescriptionError(f"--map: found '{text}'; accepted: FEATURE=NODE or FEATURE=NODE*FACTOR, with one of "
                               + ", ".join(known))
    try:
        return feature, node, float(factor) if star else 1.0
    except ValueError:
        raise DescriptionError(f"--map: found '{text}'; accepted: a number after *") from None


def camera_values(path, changes):
    try:
        import yaml
    except ImportError:
        sys.exit("hilcam-camera-face: PyYAML is missing; install python3-yaml")
    path = pathlib.Path(path)
    try:
        values = yaml.safe_load(path.read_text())
        if isinstance(values, dict) and "camera" in values:
            camera = values["camera"]
            values = yaml.safe_load((path.parent / camera).read_text()) if isinstance(camera, str) else camera
    except (OSError, UnicodeDecodeError, yaml.YAMLError) as error:
        raise DescriptionError(f"{path}: {' '.join(str(error).split())}") from None
    if not isinstance(values, dict) or "width_px" not in values or "height_px" not in values:
        raise DescriptionError(f"{path}: has no width_px and height_px; accepted: a camera file or a scenario of hilcam")
    for change in changes:
        key, equals, value = change.partition("=")
        if not equals:
            raise DescriptionError(f"--set: found '{change}'; accepted: KEY=VALUE")
        values[key.removeprefix("camera.")] = yaml.safe_load(value)
    return values
