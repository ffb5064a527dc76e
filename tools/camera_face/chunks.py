"""The layout of a vendor's chunks: which value of hilcam goes where in the chunk of which id."""
from . import fit as fits
from .binding import REFUSED
from .roles import CHUNKS, Role, entry_of, to_hilcam

IMAGE_ID = 0x48430000  # hilcam's own, where the description names none


def layout(binder):
    """Returns {"image": id, "parts": [{"id", "bytes", "fields": [...]}]}; None: the description has no chunks."""
    ev, description = binder.ev, binder.description
    ports = {name: port[1] for name, port in description.ports.items() if port and port[0] == "ChunkID" and port[1]}
    if not ports:
        return None
    ev.open_chunks(True)
    try:
        parts = {}
        for chunk, unit, names in CHUNKS:
            for name in names:
                if name in ev.nodes:
                    for port, field in fields(binder, chunk, unit, name, ports):
                        parts.setdefault(port, []).append(field)
                    break
        sizes = {port: size_of(ev, port) for port in parts}
    finally:
        ev.open_chunks(False)
    return {"image": image_id(description, ports),
            "parts": [{"id": ports[port], "bytes": sizes[port], "fields": found} for port, found in parts.items()]}


def image_id(description, ports):
    node = description.nodes.get("ChunkImage")
    if node is not None and node.text("pPort") in ports:
        return ports[node.text("pPort")]
    return next((ports[name] for name in ("ImagePort", "ChunkImagePort") if name in ports), IMAGE_ID)


def size_of(ev, port):
    end = 4
    for name, node in ev.nodes.items():
        if node.text("pPort") == port:
            try:
                end = max(end, ev.address(name) + ev.length(name))
            except REFUSED:
                pass
    return min(end + 3 & ~3, 1024)


def fields(binder, chunk, unit, name, ports):
    """Returns (port, field) for each register that the value is made of: one, or the halves of a long number."""
    ev, node = binder.ev, binder.ev.nodes[name]
    try:
        registers = {register for _, length, register in ev.uses(("value", name))
                     if length and ev.nodes[register].text("pPort") in ports}
    except REFUSED:
        return []
    role = Role(chunk, (), unit=unit)
    forward, _ = to_hilcam(role, name, node.text("Unit", ""), None, None, binder.camera)
    if chunk == "Gain" and "Gain" in binder.bound:
        forward, _ = binder._conversion(binder.bound["Gain"][0], "Gain")
    found = []
    for register in sorted(registers):
        before = ev.raw(register)
        put = lambda raw: ev.set(register, raw)  # noqa: E731
        get = lambda: forward(ev.value(name))  # noqa: E731
        field = {"chunk": chunk, "at": binder.place(register)}
        if node.tag == "Enumeration":
            field["values"] = []
            for entry in node.entries:
                target = entry_of("PixelFormat", entry.name, binder.camera)
                try:
                    ev.set(name, entry.number("Value"))
                    if target and ev.value(name) == entry.number("Value"):
                        field["values"].append([ev.value(register), target])
                except REFUSED:
                    continue
            usable = bool(field["values"])
        else:
            formula = fits.fit(fits.curve(put, get, binder._samples(register)), put, get)
            usable = formula is not None
            if usable:
                field["formula"] = formula
        ev.write_memory(ev.place(register), before)
        if usable:
            found.append((ev.nodes[register].text("pPort"), field))
    return found
