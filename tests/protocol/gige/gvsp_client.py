"""GigE Vision streams from the client's side: packets into frames, with requests for what is missing.

Independent of the camera's code, as gvcp_client.py is. Frames are judged, not repaired: every packet that should not be
there is counted, and a frame says which packets it lacks.
"""
import collections
import dataclasses
import socket
import struct
import threading
import time

from gvcp_client import EXTENDED_IDS, PACKETRESEND, PORT, SCDA, SCP, SCPS, command_bytes, ip_number, resend_payload

LEADER, TRAILER, PAYLOAD, ALL_IN, MULTIPART_PAYLOAD = 1, 2, 3, 4, 7
IMAGE, MULTIPART, WITH_CHUNKS = 1, 0x0A, 0x4000
RESENT = 0x0100
HEADER_SHORT, HEADER_EXTENDED = 8, 20


@dataclasses.dataclass
class Packet:
    status: int
    flags: int
    block: int
    format: int
    id: int
    extended: bool
    payload: bytes

    @staticmethod
    def of(datagram):
        """None for what is no packet of a stream."""
        if len(datagram) < HEADER_SHORT:
            return None
        if datagram[4] & 0x80:
            if len(datagram) < HEADER_EXTENDED:
                return None
            status, flags, form, block, packet = struct.unpack(">HHIQI", datagram[:HEADER_EXTENDED])
            if block == 0:
                return None
            return Packet(status, flags, block, form >> 24 & 0x7F, packet, True, datagram[HEADER_EXTENDED:])
        status, block, form = struct.unpack(">HHI", datagram[:HEADER_SHORT])
        if block == 0:
            return None
        return Packet(status, 0, block, form >> 24, form & 0xFFFFFF, False, datagram[HEADER_SHORT:])


@dataclasses.dataclass
class Part:
    """Of a multipart leader."""
    type: int
    length: int
    pixel_format: int
    source: int
    purpose: int
    region: int
    width: int
    height: int
    offset_x: int
    offset_y: int
    data: bytes = b""


@dataclasses.dataclass
class Frame:
    block: int
    extended: bool
    complete: bool
    missing: list  # packet ids; empty and not complete: the number of packets is unknown
    unavailable: bool  # the camera said that a packet is gone
    payload_type: int = 0
    timestamp: int = 0
    pixel_format: int = 0
    width: int = 0
    height: int = 0
    offset_x: int = 0
    offset_y: int = 0
    size_y: int = 0  # of the trailer
    packets: int = 0  # payload packets
    resent: int = 0  # packets that carry the resend status or flag
    data: bytes = b""
    chunk_bytes: int = 0  # as the trailer has it
    chunks: dict = dataclasses.field(default_factory=dict)
    parts: list = dataclasses.field(default_factory=list)
    first_ns: int = 0  # CLOCK_MONOTONIC: first packet read
    last_ns: int = 0  # last packet read

    @property
    def bits_per_pixel(self):
        return self.pixel_format >> 16 & 0xFF

    @property
    def image(self):
        return self.data[:(self.width * self.height * self.bits_per_pixel + 7) // 8]

    def chunk(self, chunk_id, form):
        return struct.unpack(form, self.chunks[chunk_id])[0]


def chunks_of(data):
    """Walks from the end: [data][id][length] ...; the lengths must meet the beginning exactly."""
    chunks, end = {}, len(data)
    while end > 0:
        if end < 8:
            raise ValueError(f"{end} bytes before the first chunk")
        chunk, length = struct.unpack(">II", data[end - 8:end])
        if length > end - 8:
            raise ValueError(f"chunk 0x{chunk:08X} of {length} bytes begins before its block")
        if chunk in chunks:
            raise ValueError(f"chunk 0x{chunk:08X} twice")
        chunks[chunk] = data[end - 8 - length:end - 8]
        end -= 8 + length
    return chunks


class _Block:
    def __init__(self, block, now_ns):
        self.block, self.packets, self.extended = block, {}, False
        self.first_ns = self.last_ns = self.asked_ns = now_ns
        self.last_id, self.asked, self.unavailable, self.resent = None, 0, False, 0

    def missing(self):
        last = self.last_id if self.last_id is not None else max(self.packets, default=0)
        return [i for i in range(last + 1) if i not in self.packets]


class StreamReceiver:
    """Receives a stream on a thread of its own, from open() to close(); next_frame() gives the frames in their order."""

    WAIT_NS = 3_000_000  # before a gap is asked for
    AGAIN_NS = 20_000_000  # before it is asked for again
    MOST_ASKED = 20
    RETAIN_NS = 1_000_000_000  # before an incomplete frame is given up

    def __init__(self, client, bind, resend=True, extended=False, group=None, port=0, buffer_bytes=8 << 20):
        self.client, self.camera, self.bind, self.resend = client, client.camera, bind, resend
        self.extended, self.group = extended, group
        self.statistics = collections.Counter()
        self.test_packets = []  # sizes
        self.statuses = collections.Counter()
        self.frames, self.blocks, self.ready = collections.deque(), {}, threading.Condition()
        self.done_blocks = collections.deque(maxlen=64)
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.socket.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, buffer_bytes)
        if port:
            self.socket.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        self.socket.bind((group or bind, port))
        if group:
            self.socket.setsockopt(socket.IPPROTO_IP, socket.IP_ADD_MEMBERSHIP,
                                   socket.inet_aton(group) + socket.inet_aton(bind))
        self.port = self.socket.getsockname()[1]
        self.stopping = False
        self.thread = threading.Thread(target=self._run, daemon=True)
        self.thread.start()

    def open(self, packet_bytes=None):
        """Tells the camera where the stream goes."""
        if packet_bytes is not None:
            self.client.write_register(SCPS, packet_bytes)
        self.client.write_registers((SCDA, ip_number(self.group or self.bind)), (SCP, self.port))
        return self

    def close(self):
        self.stopping = True
        self.thread.join()
        self.socket.close()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def next_frame(self, timeout_s=5.0):
        until = time.monotonic() + timeout_s
        while (left := until - time.monotonic()) > 0:
            self.client.keep_control()
            with self.ready:
                if self.ready.wait_for(lambda: self.frames, min(left, 0.5)):
                    return self.frames.popleft()
        return None

    def take(self, count, timeout_s=5.0):
        frames = []
        while len(frames) < count:
            frame = self.next_frame(timeout_s)
            if frame is None:
                raise TimeoutError(f"{len(frames)} of {count} frames came; {dict(self.statistics)}, "
                                   f"statuses {dict(self.statuses)}")
            frames.append(frame)
        return frames

    def forget(self):
        """Drops what has come so far."""
        with self.ready:
            self.frames.clear()

    # --- receiving thread

    def _run(self):
        while not self.stopping:
            self.socket.settimeout(0.002 if self.blocks else 0.05)
            try:
                datagram = self.socket.recv(65535)
            except TimeoutError:
                datagram = None
            now_ns = time.monotonic_ns()
            if datagram is not None:
                self._take(datagram, now_ns)
            self._look_after(now_ns)
        for block in list(self.blocks.values()):
            self._finish(block)

    def _take(self, datagram, now_ns):
        packet = Packet.of(datagram)
        if packet is None:
            self.test_packets.append(len(datagram))
            return
        self.statistics["packets"] += 1
        self.statuses[packet.status] += 1
        if packet.block in self.done_blocks:
            self.statistics["late_packets"] += 1
            return
        block = self.blocks.get(packet.block)
        if packet.status & 0x8000:
            self.statistics["error_packets"] += 1
            if block is not None:
                block.unavailable = True
            return
        if block is None:
            block = self.blocks[packet.block] = _Block(packet.block, now_ns)
        block.last_ns, block.extended = now_ns, packet.extended
        if packet.status == RESENT or packet.flags & 1:
            block.resent += 1
        if packet.id in block.packets:
            self.statistics["duplicate_packets"] += 1
            return
        if packet.id < max(block.packets, default=0) and packet.status != RESENT and not packet.flags & 1:
            self.statistics["out_of_order_packets"] += 1
        block.packets[packet.id] = packet
        if packet.format == TRAILER:
            block.last_id = packet.id

    def _look_after(self, now_ns):
        newest = max((b.first_ns for b in self.blocks.values()), default=0)  # ids wrap
        for block in sorted(self.blocks.values(), key=lambda b: b.first_ns):
            if block.last_id is not None and len(block.packets) >= block.last_id + 1 and not block.missing():
                self._finish(block)
                continue
            old = block.first_ns != newest
            if not self.resend:
                if old or now_ns - block.last_ns > 200_000_000:
                    self._finish(block)
                continue
            if now_ns - block.last_ns > self.RETAIN_NS or block.unavailable or block.asked >= self.MOST_ASKED:
                self._finish(block)
                continue
            # After the trailer or a pause, what is not there is missing.
            pause = now_ns - max(block.last_ns, block.asked_ns if block.asked else 0)
            if pause > (self.AGAIN_NS if block.asked else self.WAIT_NS):
                self._ask(block, now_ns)

    def _ask(self, block, now_ns):
        block.asked, block.asked_ns = block.asked + 1, now_ns
        missing = block.missing()
        if block.last_id is None:  # the end is unknown: one more than what is there
            missing.append(max(block.packets, default=-1) + 1)
        ranges = []
        for packet in missing:
            if ranges and ranges[-1][1] == packet - 1:
                ranges[-1][1] = packet
            else:
                ranges.append([packet, packet])
        for first, last in ranges:
            self.statistics["resend_requests"] += 1
            self.statistics["resend_packets"] += last - first + 1
            extended = block.extended or self.extended
            self.socket.sendto(command_bytes(PACKETRESEND, resend_payload(block.block, first, last, extended=extended),
                                             EXTENDED_IDS if extended else 0, self.client.new_id()),
                               (self.camera, PORT))

    def _finish(self, block):
        del self.blocks[block.block]
        self.done_blocks.append(block.block)
        missing = block.missing()
        frame = Frame(block.block, block.extended, block.last_id is not None and not missing, missing, block.unavailable,
                      first_ns=block.first_ns, last_ns=block.last_ns, resent=block.resent)
        try:
            self._read(frame, block)
        except (ValueError, struct.error) as error:
            frame.complete = False
            self.statistics["malformed_frames"] += 1
            self.statistics["malformed: " + str(error)] += 1
        self.statistics["complete_frames" if frame.complete else "incomplete_frames"] += 1
        with self.ready:
            self.frames.append(frame)
            self.ready.notify_all()

    @staticmethod
    def _read(frame, block):
        leader, trailer = block.packets.get(0), block.packets.get(block.last_id)
        if leader:
            if leader.format != LEADER:
                raise ValueError(f"packet 0 has format {leader.format}")
            frame.payload_type, high, low = struct.unpack(">2xHII", leader.payload[:12])
            frame.timestamp = high << 32 | low
            if frame.payload_type & ~WITH_CHUNKS == MULTIPART:
                frame.parts = [_part(leader.payload[at:at + 48]) for at in range(12, len(leader.payload), 48)]
            else:
                if len(leader.payload) != 36:
                    raise ValueError(f"a leader of {len(leader.payload)} bytes")
                frame.pixel_format, frame.width, frame.height, frame.offset_x, frame.offset_y = struct.unpack(
                    ">5I", leader.payload[12:32])
        if trailer and trailer is not leader:
            _, kind, frame.size_y = struct.unpack(">HHI", trailer.payload[:8])
            if leader and kind != frame.payload_type:
                raise ValueError(f"leader has type 0x{frame.payload_type:X}, trailer 0x{kind:X}")
            if kind & WITH_CHUNKS:
                if len(trailer.payload) != 16:
                    raise ValueError(f"a trailer with chunks of {len(trailer.payload)} bytes")
                frame.chunk_bytes = struct.unpack(">I", trailer.payload[8:12])[0]
            elif len(trailer.payload) != 8:
                raise ValueError(f"a trailer of {len(trailer.payload)} bytes")
        middle = [block.packets[i] for i in sorted(block.packets) if i != 0 and i != block.last_id]
        frame.packets = len(middle)
        if frame.parts:
            _fill_parts(frame, middle)
            return
        for packet in middle:
            if packet.format != PAYLOAD:
                raise ValueError(f"packet {packet.id} has format {packet.format}")
        sizes = {len(packet.payload) for packet in middle[:-1]}
        if frame.complete and len(sizes) > 1:
            raise ValueError(f"payload packets of {sorted(sizes)} bytes")
        frame.data = b"".join(packet.payload for packet in middle)
        if frame.complete and frame.payload_type & WITH_CHUNKS:
            frame.chunks = chunks_of(frame.data[len(frame.data) - frame.chunk_bytes:])
        elif frame.complete and len(frame.data) != len(frame.image):
            raise ValueError(f"an image of {len(frame.data)} bytes, not {len(frame.image)}")


def _part(b):
    kind, high, low, pixels, _, source, _zones, _, purpose, region, w, h, x, y = struct.unpack(">HHIIHBBIHHIIII", b[:40])
    return Part(kind, high << 32 | low, pixels, source, purpose, region, w, h, x, y)


def _fill_parts(frame, packets):
    """Each payload packet says which part it is of, and where in the block (as Aravis reads it) its bytes belong."""
    parts = [bytearray(part.length) for part in frame.parts]
    begins = [sum(part.length for part in frame.parts[:i]) for i in range(len(parts))]
    filled = [0] * len(parts)
    for packet in packets:
        if packet.format != MULTIPART_PAYLOAD:
            raise ValueError(f"packet {packet.id} of a multipart block has format {packet.format}")
        number, _, high, low = struct.unpack(">BBHI", packet.payload[:8])
        at, data = (high << 32 | low) - begins[number], packet.payload[8:]
        if at < 0 or at + len(data) > len(parts[number]):
            raise ValueError(f"part {number} of {len(parts[number])} bytes, packet {packet.id} is of {at} to {at + len(data)}")
        parts[number][at:at + len(data)] = data
        filled[number] += len(data)
    for part, data, count in zip(frame.parts, parts, filled):
        if frame.complete and count != part.length:
            raise ValueError(f"a part of {part.length} bytes, {count} came")
        part.data = bytes(data)
    image = frame.parts[0]
    frame.pixel_format, frame.width, frame.height = image.pixel_format, image.width, image.height
    frame.data = b"".join(part.data for part in frame.parts)
    if frame.complete and frame.payload_type & WITH_CHUNKS:
        frame.chunks = chunks_of(frame.data)
