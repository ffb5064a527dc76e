"""A client of hilcam's command protocol (docs/protocol.md): commands out, acknowledgements and telemetry in.

    from hilcam_client import Client, Pose, Settings
    with Client("127.0.0.1:5010") as client:
        client.send(Settings(exposure_s=0.002))
        client.send(Pose(position_m=(40, 27, 13), attitude_wxyz=(0.5, 0.5, -0.5, 0.5)))

Python 3.9 or later, its standard library alone, one file. Times are nanoseconds since 1970-01-01T00:00:00 TAI on
hilcam's simulated clock; a time of 0 means "on arrival". Attitudes turn body axes into world axes, scalar first; the
camera's body is +x right, +y down in the picture, +z along the boresight. Nothing is judged here: what is out of range is
sent as it is, and hilcam's answer says what is wrong. A client is for one thread.
"""
import binascii
import collections
import dataclasses
import math
import select
import socket
import struct
import time
from typing import ClassVar, Optional, Tuple, Union

HILCAM, CFS = "hilcam", "cfs"  # dialects
MOST_PACKET_BYTES = 256
MOST_REASON_BYTES = 96
ACCEPTED = 0
STATUS_NAMES = ("accepted", "bad length", "bad header", "unknown APID", "bad checksum", "unknown function", "bad argument",
                "unknown object", "time out of range", "busy", "not now", "time went back")
MODES = ("free_run", "triggered", "lockstep")

# Kinds of faults; `hilcam send fault list` says what each does and what its value means, in this order.
FAULTS = {
    "packet_drop": 1, "packet_duplicate": 2, "packet_reorder": 3, "packet_delay": 4, "packet_corrupt": 5,
    "packet_wrong_id": 6, "packet_truncate": 7, "leader_lost": 8, "trailer_lost": 9, "resend_refused": 10,
    "resend_delayed": 11, "resend_wrong_id": 12, "bandwidth_cap": 13, "frame_drop": 20, "frame_repeat": 21,
    "wrong_size_y": 22, "timestamp_step": 30, "timestamp_drift": 31, "timestamp_freeze": 32, "block_id_wrap": 33,
    "control_silence": 40, "control_slow": 41, "control_busy": 42, "control_denied": 43, "heartbeat_ignored": 44,
    "device_reset": 50, "link_down": 51, "ip_change": 52, "test_packet_limit": 53, "v4l2_stall": 60, "v4l2_restart": 61,
    "v4l2_format_flip": 62, "usb_detach": 70, "usb_short_transfer": 71, "usb_stall": 72, "usb_bad_crc": 73,
    "image_stuck": 80, "image_black": 81, "image_saturated": 82, "image_bit_flips": 83, "image_tear": 84}

# Bits of FrameReport.faults beside those of FAULTS: some motion was no number or out of its bounds, light between surfaces is
# not kept yet, simulated time stood, no poses came, a time tag went back.
IMPOSSIBLE_MOTION, NO_KEPT_LIGHT = 1 << 58, 1 << 59
TIME_STANDS, POSES_STALE, TAGS_WENT_BACK = 1 << 60, 1 << 61, 1 << 62

Vector = Tuple[float, float, float]


def crc16(data):
    """CRC-16/CCITT-FALSE: polynomial 0x1021, start 0xFFFF (CCSDS 132.0-B-3, 4.1.6.2). 0 over what ends in its own."""
    return binascii.crc_hqx(data, 0xFFFF)


# --- commands

@dataclasses.dataclass(frozen=True)
class Pose:
    FUNCTION: ClassVar[int] = 1
    object: int = 0  # 0: the camera; 1, 2, ...: the scenario's objects
    time_tai_ns: int = 0
    position_m: Vector = (0, 0, 0)
    velocity_m_s: Vector = (0, 0, 0)
    attitude_wxyz: Tuple[float, float, float, float] = (1, 0, 0, 0)
    rate_rad_s: Vector = (0, 0, 0)  # about the body's own axes

    def payload(self):
        return struct.pack(">HHq3d3d4d3d", self.object, 0, self.time_tai_ns, *self.position_m, *self.velocity_m_s,
                           *self.attitude_wxyz, *self.rate_rad_s)


@dataclasses.dataclass(frozen=True)
class Settings:
    """What is None stays as it is."""
    FUNCTION: ClassVar[int] = 2
    exposure_s: Optional[float] = None
    gain_db: Optional[float] = None
    frame_rate_hz: Optional[float] = None

    def payload(self):
        values = (self.exposure_s, self.gain_db, self.frame_rate_hz)
        mask = sum(1 << bit for bit, value in enumerate(values) if value is not None)
        return struct.pack(">I3d", mask, *(0.0 if value is None else value for value in values))


@dataclasses.dataclass(frozen=True)
class Start:
    FUNCTION: ClassVar[int] = 3

    def payload(self):
        return b""


@dataclasses.dataclass(frozen=True)
class Stop:
    FUNCTION: ClassVar[int] = 4

    def payload(self):
        return b""


@dataclasses.dataclass(frozen=True)
class Ping:
    FUNCTION: ClassVar[int] = 5
    token: int = 0

    def payload(self):
        return struct.pack(">Q", self.token)


@dataclasses.dataclass(frozen=True)
class Joint:
    FUNCTION: ClassVar[int] = 6
    object: int = 1
    joint: int = 1
    time_tai_ns: int = 0
    angle_rad: float = 0.0
    rate_rad_s: float = 0.0

    def payload(self):
        return struct.pack(">HHqdd", self.object, self.joint, self.time_tai_ns, self.angle_rad, self.rate_rad_s)


@dataclasses.dataclass(frozen=True)
class Fault:
    """kind: a name or number of FAULTS; 0 ends all faults."""
    FUNCTION: ClassVar[int] = 7
    kind: Union[str, int] = 0
    rate: float = 1.0  # 0 to 1, the share that is struck; 0 ends this kind
    value: float = 0.0
    first_frame: int = 0  # 0: at once
    frames: int = 0  # 0: no end
    duration_s: float = 0.0  # 0: no end

    def payload(self):
        kind = FAULTS[self.kind] if isinstance(self.kind, str) else self.kind
        return struct.pack(">BxxxddQQd", kind, self.rate, self.value, self.first_frame, self.frames, self.duration_s)


@dataclasses.dataclass(frozen=True)
class Expose:
    FUNCTION: ClassVar[int] = 8
    frames: int = 0  # 0: as the settings have it
    time_tai_ns: int = 0  # triggered: of the trigger; lockstep: of the exposure's middle; 0: now, or next

    def payload(self):
        return struct.pack(">HHq", self.frames, 0, self.time_tai_ns)


@dataclasses.dataclass(frozen=True)
class Mode:
    FUNCTION: ClassVar[int] = 9
    triggered: bool = False
    burst_frames: int = 0  # 0: as it is

    def payload(self):
        return struct.pack(">BBH", self.triggered, 0, self.burst_frames)


@dataclasses.dataclass(frozen=True)
class Subscribe:
    FUNCTION: ClassVar[int] = 10
    frame_reports: bool = False
    housekeeping: bool = False

    def payload(self):
        return struct.pack(">Bxxx", self.frame_reports | self.housekeeping << 1)


@dataclasses.dataclass(frozen=True)
class Clock:
    """How simulated time goes on, and half of an exchange of clock readings (ClockFilter)."""
    ASK, SCALE, PAUSE, RESUME, STEP = range(5)
    FUNCTION: ClassVar[int] = 11
    action: int = ASK
    sender_ns: int = 0  # the sender's clock as this leaves; comes back
    scale: float = 1.0  # SCALE: simulated seconds in one of the machine's
    step_ns: int = 0  # STEP: so much simulated time, then it stands again

    def payload(self):
        return struct.pack(">Bxxxqdq", self.action, self.sender_ns, self.scale, self.step_ns)


@dataclasses.dataclass(frozen=True)
class Lamp:
    """level: 0 off, 1 as its data sheet says."""
    FUNCTION: ClassVar[int] = 12
    lamp: int = 1
    time_tai_ns: int = 0  # from when on; 0: on arrival
    level: float = 1.0

    def payload(self):
        return struct.pack(">Hxxqd", self.lamp, self.time_tai_ns, self.level)


def look_at(position_m, target_m, up=(0, 0, 1)):
    """attitude_wxyz of a camera at a place that looks at another, with `up` upwards in its picture: what a scenario's
    `attitude: look_at` does. Throws ValueError where the places coincide or `up` is along the line of sight."""
    def cross(a, b):
        return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])

    def unit(a):
        length = math.hypot(*a)
        if length == 0:
            raise ValueError(f"no such direction: from {position_m} to {target_m} with {up} upwards")
        return tuple(c / length for c in a)

    z = unit(tuple(t - p for t, p in zip(target_m, position_m)))
    x = unit(cross(z, up))
    y = cross(z, x)
    # Shepperd's method: the largest of the four comes from the diagonal of the matrix with columns x, y, z.
    squares = (x[0] + y[1] + z[2], x[0] - y[1] - z[2], y[1] - x[0] - z[2], z[2] - x[0] - y[1])
    largest = max(range(4), key=lambda i: squares[i])
    q = ((1 + squares[0], y[2] - z[1], z[0] - x[2], x[1] - y[0]), (y[2] - z[1], 1 + squares[1], x[1] + y[0], z[0] + x[2]),
         (z[0] - x[2], x[1] + y[0], 1 + squares[2], y[2] + z[1]), (x[1] - y[0], z[0] + x[2], y[2] + z[1], 1 + squares[3]))[largest]
    return unit(tuple(c if q[0] >= 0 else -c for c in q))


COMMANDS = (Pose, Settings, Start, Stop, Ping, Joint, Fault, Expose, Mode, Subscribe, Clock, Lamp)


def encode(command, sequence, camera=0, dialect=HILCAM):
    """One packet. camera: which one settings, modes, exposures and faults are for, from 1; 0: every one; not of cfs."""
    payload = command.payload()
    if dialect == CFS:
        head = struct.pack(">HHHBB", 0x1900, 0xC000 | sequence & 0x3FFF, 2 + len(payload) - 1, command.FUNCTION, 0)
        checksum = 0xFF
        for byte in head + payload:
            checksum ^= byte
        return head[:7] + bytes((checksum,)) + payload
    packet = struct.pack(">HHHBBHI", 0x1900, 0xC000 | sequence & 0x3FFF, 8 + len(payload) + 2 - 1, 1, command.FUNCTION,
                         camera, sequence) + payload
    return packet + struct.pack(">H", crc16(packet))


# --- answers. count: 14 bits, of each kind; a gap in telemetry's is telemetry that was dropped

@dataclasses.dataclass(frozen=True)
class ClockReading:
    """simulated = min(departure_tai + scale * (monotonic - departure_monotonic), stands_at_tai), from then on."""
    arrival_tai_ns: int  # when the command came
    arrival_monotonic_ns: int
    departure_monotonic_ns: int  # when the answer left
    scale: float  # while time runs
    stands_at_tai_ns: int  # where time stands or will; 2**63 - 1: nowhere
    departure_tai_ns: int = 0  # the acknowledgement's simulated_tai_ns

    def simulated_tai_ns(self, monotonic_ns):
        since_ns = monotonic_ns - self.departure_monotonic_ns
        return min(self.departure_tai_ns + (since_ns if self.scale == 1 else round(self.scale * since_ns)),
                   self.stands_at_tai_ns)


@dataclasses.dataclass(frozen=True)
class Acknowledgement:
    function: int
    status: int
    sequence: int  # of the command
    token: int  # of a Ping; of a Clock its sender_ns, unsigned; else 0
    simulated_tai_ns: int  # when the answer was made
    reason: str
    count: int
    clock: Optional[ClockReading] = None  # with an accepted Clock

    @property
    def accepted(self):
        return self.status == ACCEPTED

    def __str__(self):
        name = STATUS_NAMES[self.status] if self.status < len(STATUS_NAMES) else f"status {self.status}"
        # Who answers chooses the words: none of them is to command the terminal.
        words = "".join(c if c.isprintable() else " " for c in self.reason)
        return name + (f": {words}" if words else "")


@dataclasses.dataclass(frozen=True)
class FrameReport:
    camera: int
    frame: int
    exposure_mid_tai_ns: int
    exposure_mid_monotonic_ns: int  # the same instant on the machine's CLOCK_MONOTONIC
    exposure_s: float
    gain_db: float
    pose_sequence: int  # of the newest command that the frame shows
    trigger_sequence: int  # of the Expose that asked for it; 0: none
    pose_time_tai_ns: int
    latency_ns: int  # from that command's arrival to the frame's hand-over; -1: no new command
    faults: int  # bit n: the n-th of FAULTS
    quality_level: int
    count: int


@dataclasses.dataclass(frozen=True)
class Housekeeping:
    mode: int  # of MODES
    running: int
    simulated_tai_ns: int
    monotonic_ns: int
    uptime_s: float
    frames: int
    frame_rate_hz: float
    deadline_misses: int
    commands_received: int
    commands_refused: int
    commands_lost: int
    latency_p50_s: float
    latency_p99_s: float
    temperature_c: float
    faults: int  # how many kinds are in force
    clients: int
    count: int


def _telemetry(kind, number, form, body, count):
    if body[1] != number or len(body) != 2 + struct.calcsize(form):
        return None
    return kind(*struct.unpack(form, body[2:]), count)


def decode(packet, dialect=HILCAM):
    """An Acknowledgement, FrameReport or Housekeeping; None: it is no answer of hilcam's, or a damaged one."""
    header, check = (16, 0) if dialect == CFS else (6, 2)
    if len(packet) < header + 2 + check:
        return None
    identification, count, length = struct.unpack(">HHH", packet[:6])
    if length + 7 != len(packet) or (check and crc16(packet) != 0):
        return None
    count &= 0x3FFF
    body = bytes(packet[header:len(packet) - check])
    if body[0] != 1:
        return None
    if identification == 0x0901 and len(body) >= 26:
        function, status, sequence, token, at_ns, reason_bytes = struct.unpack(">BBxIQqH", body[1:26])
        function, clock = function & 0x7F, None
        if reason_bytes > MOST_REASON_BYTES:
            return None
        if function == Clock.FUNCTION and len(body) == 26 + reason_bytes + 40:
            clock = ClockReading(*struct.unpack(">qqqdq", body[-40:]), at_ns)
        elif len(body) != 26 + reason_bytes:
            return None
        reason = body[26:26 + reason_bytes].decode(errors="replace")
        return Acknowledgement(function, status, sequence, token, at_ns, reason, count, clock)
    if identification == 0x0902:
        return _telemetry(FrameReport, 1, ">BxQqqddIIqqQI", body, count)
    if identification == 0x0903:
        return _telemetry(Housekeeping, 2, ">BBqqdQdQQQQdddII", body, count)
    return None


class Cutter:
    """Cuts a stream of bytes into answers; steps over sync markers and damage."""

    def __init__(self, dialect=HILCAM):
        self.dialect, self.bytes = dialect, b""

    def take(self, data):
        """All whole answers that these bytes complete."""
        self.bytes += data
        at, answers = 0, []
        while (at := self.bytes.find(b"\x09", at)) >= 0 and at + 6 <= len(self.bytes):
            length = int.from_bytes(self.bytes[at + 4:at + 6], "big") + 7
            if not 1 <= self.bytes[at + 1] <= 3 or length > MOST_PACKET_BYTES:
                at += 1
                continue
            if at + length > len(self.bytes):
                break
            answer = decode(self.bytes[at:at + length], self.dialect)
            at += 1 if answer is None else length
            if answer is not None:
                answers.append(answer)
        self.bytes = self.bytes[at:] if at >= 0 else b""
        return answers


# --- time

class ClockFilter:
    """How far hilcam's machine clock (CLOCK_MONOTONIC) is ahead of the sender's, from four instants of each exchange: t1 sent
    and t4 received by the sender's, t2 arrived and t3 departed by the machine's. RFC 5905, section 8:
    offset ((t2 - t1) + (t3 - t4)) / 2, delay (t4 - t1) - (t3 - t2), which errs by no more than half the delay. Of the last
    eight the one with the least error counts (section 10), which grows by 15 ppm of its age. No scale and no pause of
    simulated time touches the offset; how simulated time goes on from there is in the newest answer."""
    SAMPLES, DRIFT = 8, 15e-6

    def __init__(self):
        self._samples = collections.deque(maxlen=self.SAMPLES)  # (offset, delay, t4) [ns]
        self.reading = None  # the newest

    def take(self, sent_ns, received_ns, reading):
        """False for an exchange that cannot be: an answer before its question."""
        there, back = reading.arrival_monotonic_ns - sent_ns, reading.departure_monotonic_ns - received_ns
        if received_ns < sent_ns or reading.departure_monotonic_ns < reading.arrival_monotonic_ns or there < back:
            return False
        self._samples.append(((there + back) // 2, there - back, received_ns))
        self.reading = reading
        return True

    def estimate(self, sender_ns):
        """(offset_ns, delay_ns, error_ns) at an instant of the sender's clock. Throws NoAnswer before the first exchange."""
        if not self._samples:
            raise NoAnswer("no exchange of clock readings yet")
        return min(((offset, delay, delay / 2 + self.DRIFT * abs(sender_ns - at)) for offset, delay, at in self._samples),
                   key=lambda sample: sample[2])

    def simulated_tai_ns(self, sender_ns):
        """The simulated time then, while nobody changes how it goes; errs by the error times the scale."""
        offset_ns = self.estimate(sender_ns)[0]
        return self.reading.simulated_tai_ns(sender_ns + offset_ns)


# --- the client

class NoAnswer(Exception):
    """Nobody acknowledged in time, or the connection is gone."""


class Refused(Exception):
    def __init__(self, command, answer):
        super().__init__(f"{command}: {answer}")
        self.answer = answer


def _connect(to):
    """(socket, whether it is a stream) of "ADDRESS:PORT" (UDP), "tcp:ADDRESS:PORT" or "unix:PATH"."""
    kind, _, rest = to.partition(":")
    if kind == "unix":
        for form in (socket.SOCK_STREAM, socket.SOCK_SEQPACKET):
            link = socket.socket(socket.AF_UNIX, form)
            try:
                link.connect(rest)
                return link, True
            except OSError as error:
                link.close()
                if form == socket.SOCK_SEQPACKET:
                    raise NoAnswer(f"{to}: {error}") from error
    address, _, port = (rest if kind in ("tcp", "udp") else to).rpartition(":")
    if not (address and port.isdecimal() and 0 < int(port) < 65536):
        raise ValueError(f"found '{to}'; accepted: ADDRESS:PORT, tcp:ADDRESS:PORT, unix:PATH")
    link = socket.socket(socket.AF_INET, socket.SOCK_STREAM if kind == "tcp" else socket.SOCK_DGRAM)
    try:
        link.connect((address, int(port)))
        if kind == "tcp":
            link.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
    except OSError as error:
        link.close()
        raise NoAnswer(f"{to}: {error}; is 'hilcam run' up and listening there?") from error
    return link, kind == "tcp"


class Client:
    """Sends and waits (send), or sends and lets the caller collect answers (post, receive)."""

    def __init__(self, to="127.0.0.1:5010", dialect=HILCAM, camera=0, timeout_s=1.0):
        self.to, self.dialect, self.camera, self.timeout_s = to, dialect, camera, timeout_s
        self.sequence = 0  # of the next command
        self._socket, self._is_stream = _connect(to)
        self._socket.setblocking(False)
        self._cutter = Cutter(dialect)
        self._read = collections.deque()  # answers off the wire
        self._kept = collections.deque(maxlen=100_000)  # came while another one was waited for

    def close(self):
        self._socket.close()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def post(self, command, camera=None):
        """Sends; gives the sequence number that the acknowledgement will have."""
        sequence = self.sequence & (0x3FFF if self.dialect == CFS else 0xFFFFFFFF)
        self.sequence = sequence + 1
        self._put(encode(command, sequence, self.camera if camera is None else camera, self.dialect))
        return sequence

    def send(self, command, camera=None, timeout_s=None, tries=1, check=True):
        """Sends and waits for the Acknowledgement. A further try repeats the same bytes; an Expose, a Fault or a
        Clock's step that hilcam has done is not done again. Throws NoAnswer, and Refused unless `check` is False."""
        sequence = self.sequence & (0x3FFF if self.dialect == CFS else 0xFFFFFFFF)
        self.sequence = sequence + 1
        packet = encode(command, sequence, self.camera if camera is None else camera, self.dialect)
        timeout_s = self.timeout_s if timeout_s is None else timeout_s
        for _ in range(tries):
            self._put(packet)
            until = time.monotonic() + timeout_s
            while (answer := self._next(until)) is not None:
                if not isinstance(answer, Acknowledgement) or answer.sequence != sequence:
                    self._kept.append(answer)
                    continue
                if check and not answer.accepted:
                    raise Refused(command, answer)
                return answer
        raise NoAnswer(f"no acknowledgement from {self.to} within {timeout_s} s; is 'hilcam run' up and listening there?")

    def receive(self, timeout_s=0.0):
        """The next answer of any kind; None: there is none in time."""
        return self._kept.popleft() if self._kept else self._next(time.monotonic() + timeout_s)

    def clock(self, exchanges=8, filter=None):
        """A ClockFilter by time.monotonic_ns(), after some exchanges: its simulated_tai_ns(time.monotonic_ns()) makes time
        tags. To be asked again now and then, with the filter that was given, and after each change of how time goes."""
        filter = filter or ClockFilter()
        for _ in range(exchanges):
            sent_ns = time.monotonic_ns()
            answer = self.send(Clock(sender_ns=sent_ns))
            filter.take(sent_ns, time.monotonic_ns(), answer.clock)
        return filter

    def scale_time(self, scale):
        """So many simulated seconds in one of the machine's. This and the next ones give the ClockReading after the change."""
        return self._order_time(Clock(Clock.SCALE, scale=scale))

    def pause_time(self):
        return self._order_time(Clock(Clock.PAUSE))

    def resume_time(self):
        return self._order_time(Clock(Clock.RESUME))

    def step_time(self, step_ns):
        """Simulated time runs for so long and stands again; it must stand, or be on such a step, to which this one is added."""
        return self._order_time(Clock(Clock.STEP, step_ns=step_ns))

    def _order_time(self, command):
        return self.send(dataclasses.replace(command, sender_ns=time.monotonic_ns())).clock

    def _put(self, packet):
        until = time.monotonic() + self.timeout_s
        try:
            while packet:
                try:
                    sent = self._socket.send(packet)
                    packet = packet[sent:] if self._is_stream else b""
                except BlockingIOError:
                    left_s = until - time.monotonic()
                    if left_s <= 0:
                        raise NoAnswer(f"{self.to}: took no more commands for {self.timeout_s} s") from None
                    select.select([], [self._socket], [], left_s)
        except ConnectionRefusedError:
            pass  # UDP's note that nobody heard the datagram before: silence will tell
        except OSError as error:
            raise NoAnswer(f"{self.to}: {error}") from error

    def _next(self, until):
        # What is there is taken before the clock is looked at.
        while not self._read and self._fill():
            pass
        while not self._read:
            left_s = until - time.monotonic()
            if left_s <= 0:
                return None
            select.select([self._socket], [], [], left_s)
            self._fill()
        return self._read.popleft()

    def _fill(self):
        """Reads once; False when there was nothing."""
        try:
            data = self._socket.recv(65536)
        except (BlockingIOError, ConnectionRefusedError):
            return False
        except OSError as error:
            raise NoAnswer(f"{self.to}: {error}") from error
        if self._is_stream and not data:
            raise NoAnswer(f"{self.to}: hung up")
        if not self._is_stream:
            self._cutter.bytes = b""  # a datagram is whole
        self._read.extend(self._cutter.take(data))
        return True
