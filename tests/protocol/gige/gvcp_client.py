"""GigE Vision control from the client's side: an independent client on plain sockets.

Written from the protocol's description (commands, status codes, registers), not from the camera's code, so that an
error in one is not repeated in the other. It covers what Aravis does not send: FORCEIP, ACTION, EVENT with its
acknowledgement, PENDING_ACK, the switch-over of control, concatenated register access. All numbers are big-endian.
"""
import dataclasses
import random
import socket
import struct
import time

PORT = 3956
KEY = 0x42
ACKNOWLEDGE, EXTENDED_IDS, BROADCAST_ANSWER, SCHEDULED = 0x01, 0x10, 0x10, 0x80

DISCOVERY, FORCEIP, PACKETRESEND = 0x0002, 0x0004, 0x0040
READREG, WRITEREG, READMEM, WRITEMEM = 0x0080, 0x0082, 0x0084, 0x0086
PENDING_ACK, EVENT, EVENTDATA, ACTION = 0x0089, 0x00C0, 0x00C2, 0x0100

SUCCESS = 0x0000
NOT_IMPLEMENTED, INVALID_PARAMETER, INVALID_ADDRESS, WRITE_PROTECT = 0x8001, 0x8002, 0x8003, 0x8004
BAD_ALIGNMENT, ACCESS_DENIED, BUSY = 0x8005, 0x8006, 0x8007
PACKET_UNAVAILABLE, INVALID_HEADER = 0x800C, 0x800E

# Registers of the bootstrap block.
VERSION, DEVICE_MODE, MAC_HIGH, MAC_LOW, IP_CONFIG, IP, MASK, GATEWAY = 0, 4, 8, 0xC, 0x14, 0x24, 0x34, 0x44
VENDOR, MODEL, SERIAL, USER_NAME, URL_0, URL_1 = 0x48, 0x68, 0xD8, 0xE8, 0x200, 0x400
MESSAGE_CHANNELS, STREAM_CHANNELS, ACTION_SIGNALS, ACTION_DEVICE_KEY = 0x900, 0x904, 0x908, 0x90C
CAPABILITY, HEARTBEAT, TICKS_HIGH, TICKS_LOW = 0x934, 0x938, 0x93C, 0x940
TIMESTAMP_CONTROL, TIMESTAMP_HIGH, TIMESTAMP_LOW = 0x944, 0x948, 0x94C
GVCP_CONFIG, PENDING_TIMEOUT, SWITCHOVER_KEY, GVSP_CONFIG = 0x954, 0x958, 0x95C, 0x960
CCP, PRIMARY_PORT, PRIMARY_IP = 0xA00, 0xA04, 0xA14
MCP, MCDA, MCTT, MCRC, MCSP = 0xB00, 0xB10, 0xB14, 0xB18, 0xB1C
SCP, SCPS, SCPD, SCDA, SCSP, SCC, SCCFG = 0xD00, 0xD04, 0xD08, 0xD18, 0xD1C, 0xD20, 0xD24
ACTION_GROUP_KEY, ACTION_GROUP_MASK = 0x9800, 0x9804

CCP_EXCLUSIVE, CCP_CONTROL, CCP_SWITCHOVER = 1, 2, 4


def ip_number(text):
    return struct.unpack(">I", socket.inet_aton(text))[0]


def ip_text(number):
    return socket.inet_ntoa(struct.pack(">I", number))


@dataclasses.dataclass
class Answer:
    status: int
    code: int
    request_id: int
    payload: bytes

    @staticmethod
    def of(datagram):
        if len(datagram) < 8:
            raise ValueError(f"an answer of {len(datagram)} bytes")
        status, code, length, request_id = struct.unpack(">HHHH", datagram[:8])
        if length != len(datagram) - 8:
            raise ValueError(f"an answer says {length} bytes and has {len(datagram) - 8}")
        return Answer(status, code, request_id, datagram[8:])


class Refused(Exception):
    """A command was answered with an error status."""

    def __init__(self, answer):
        super().__init__(f"status 0x{answer.status:04X} to command 0x{answer.code - 1:04X}, payload {answer.payload.hex()}")
        self.answer, self.status = answer, answer.status


class NoAnswer(Exception):
    pass


def command_bytes(code, payload=b"", flags=ACKNOWLEDGE, request_id=1, key=KEY, length=None):
    return struct.pack(">BBHHH", key, flags, code, len(payload) if length is None else length, request_id) + payload


class GvcpClient:
    """One application that talks to a camera. Its UDP port is what the camera knows it by."""

    def __init__(self, camera, bind="", timeout_s=1.0, tries=3, port=0):
        self.camera, self.timeout_s, self.tries = camera, timeout_s, tries
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.socket.bind((bind, port))
        self.socket.connect((camera, PORT))
        self.next_id = random.randint(1, 60000)
        self.pending_acks = []  # ms announced by PENDING_ACKs
        self.sent_s = time.monotonic()
        self.retries = 0

    def close(self):
        self.socket.close()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    @property
    def port(self):
        return self.socket.getsockname()[1]

    # --- messages

    def new_id(self):
        self.next_id = self.next_id % 65535 + 1
        return self.next_id

    def send(self, datagram):
        self.sent_s = time.monotonic()
        self.socket.send(datagram)

    def keep_control(self):
        """A heartbeat, when it is time for one."""
        if time.monotonic() - self.sent_s > 1.0:
            try:
                self.exchange(READREG, struct.pack(">I", CCP), tries=1)
            except NoAnswer:
                pass

    def receive(self, timeout_s=None):
        """The next datagram, or None."""
        self.socket.settimeout(max(1e-3, self.timeout_s if timeout_s is None else timeout_s))
        try:
            return self.socket.recv(65535)
        except (TimeoutError, ConnectionRefusedError):
            return None

    def drain(self):
        while self.receive(0.01) is not None:
            pass

    def exchange(self, code, payload=b"", flags=ACKNOWLEDGE, request_id=None, tries=None):
        """Sends a command, again after a time without an answer; PENDING_ACK prolongs the wait."""
        request_id = self.new_id() if request_id is None else request_id
        datagram = command_bytes(code, payload, flags, request_id)
        for attempt in range(self.tries if tries is None else tries):
            self.retries += attempt > 0
            self.send(datagram)
            until = time.monotonic() + self.timeout_s
            while (left := until - time.monotonic()) > 0:
                received = self.receive(left)
                if received is None:
                    continue
                answer = Answer.of(received)
                if answer.request_id != request_id:
                    continue  # late, of an earlier command
                if answer.code == PENDING_ACK:
                    milliseconds = struct.unpack(">HH", answer.payload)[1]
                    self.pending_acks.append(milliseconds)
                    until = time.monotonic() + milliseconds * 1e-3 + self.timeout_s
                    continue
                if answer.code != code + 1:
                    raise ValueError(f"command 0x{code:04X} was answered with 0x{answer.code:04X}")
                return answer
        raise NoAnswer(f"no answer to command 0x{code:04X} from {self.camera}")

    def command(self, code, payload=b"", flags=ACKNOWLEDGE):
        answer = self.exchange(code, payload, flags)
        if answer.status != SUCCESS:
            raise Refused(answer)
        return answer.payload

    # --- registers and memory

    def read_registers(self, *addresses):
        payload = self.command(READREG, struct.pack(f">{len(addresses)}I", *addresses))
        if len(payload) != 4 * len(addresses):
            raise ValueError(f"{len(addresses)} registers were asked for, {len(payload)} bytes came")
        return list(struct.unpack(f">{len(addresses)}I", payload))

    def read_register(self, address):
        return self.read_registers(address)[0]

    def write_registers(self, *pairs):
        payload = self.command(WRITEREG, b"".join(struct.pack(">II", *pair) for pair in pairs))
        if payload != struct.pack(">HH", 0, len(pairs)):
            raise ValueError(f"{len(pairs)} registers were written, the answer is {payload.hex()}")

    def write_register(self, address, value):
        self.write_registers((address, value))

    def read_memory(self, address, count):
        data = b""
        while count > 0:
            piece = min(512, (count + 3) // 4 * 4)
            payload = self.command(READMEM, struct.pack(">IHH", address, 0, piece))
            if payload[:4] != struct.pack(">I", address) or len(payload) != 4 + piece:
                raise ValueError(f"READMEM of {piece} bytes at 0x{address:X} gave {payload[:8].hex()}, {len(payload)} bytes")
            data += payload[4:4 + count]
            address, count = address + piece, count - piece
        return data

    def write_memory(self, address, data):
        payload = self.command(WRITEMEM, struct.pack(">I", address) + data)
        if payload != struct.pack(">HH", 0, len(data)):
            raise ValueError(f"{len(data)} bytes were written, the answer is {payload.hex()}")

    def read_text(self, address, size):
        return self.read_memory(address, size).split(b"\0")[0].decode()

    # --- what a session does

    def control(self, privilege=CCP_CONTROL, key=0):
        self.write_register(CCP, privilege | key << 16)

    def release(self):
        self.write_register(CCP, 0)

    def description(self, url=URL_0):
        """The GenICam XML, unzipped, and its URL."""
        text = self.read_text(url, 512)
        place, address, size = text.split(";")
        if not place.lower().startswith("local:"):
            raise ValueError(f"'{text}' is no local URL")
        data = self.read_memory(int(address, 16), int(size, 16))
        if place.lower().endswith(".zip"):
            import io
            import zipfile
            with zipfile.ZipFile(io.BytesIO(data)) as archive:
                data = archive.read(archive.namelist()[0])
        return data.rstrip(b"\0").decode(), text

    def timestamp_ns(self):
        self.write_register(TIMESTAMP_CONTROL, 2)
        high, low, ticks_high, ticks_low = self.read_registers(TIMESTAMP_HIGH, TIMESTAMP_LOW, TICKS_HIGH, TICKS_LOW)
        return (high << 32 | low) * 1_000_000_000 // (ticks_high << 32 | ticks_low)


# --- commands to everyone

@dataclasses.dataclass
class Discovered:
    sender: str
    registers: bytes

    @property
    def ip(self):
        return socket.inet_ntoa(self.registers[IP:IP + 4])

    @property
    def mac(self):
        return self.registers[MAC_HIGH + 2:MAC_LOW + 4]

    def text(self, address, size):
        return self.registers[address:address + size].split(b"\0")[0].decode()


def to_everyone(source, code, payload=b"", flags=ACKNOWLEDGE, request_id=0xFFFF, to="255.255.255.255", wait_s=0.5):
    """Broadcasts from one of this machine's addresses; all the answers, with their senders."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender:
        sender.setsockopt(socket.SOL_SOCKET, socket.SO_BROADCAST, 1)
        sender.bind((source, 0))
        # A limited broadcast leaves by the default route; this one shall leave by the interface of its source.
        if to == "255.255.255.255" and source.startswith("127."):
            sender.setsockopt(socket.SOL_SOCKET, socket.SO_BINDTODEVICE, b"lo\0")
        sender.sendto(command_bytes(code, payload, flags, request_id), (to, PORT))
        answers, until = [], time.monotonic() + wait_s
        while (left := until - time.monotonic()) > 0:
            sender.settimeout(left)
            try:
                datagram, address = sender.recvfrom(65535)
            except TimeoutError:
                break
            answers.append((Answer.of(datagram), address))
        return answers


def discover(source="127.0.0.1", to="255.255.255.255", wait_s=0.5, flags=ACKNOWLEDGE):
    found = []
    for answer, (sender, port) in to_everyone(source, DISCOVERY, to=to, wait_s=wait_s, flags=flags):
        if answer.code != DISCOVERY + 1 or answer.status != SUCCESS or len(answer.payload) != 248 or port != PORT:
            raise ValueError(f"{sender}:{port} answers discovery with {answer}")
        found.append(Discovered(sender, answer.payload))
    return found


def force_ip_payload(mac, ip, mask="255.0.0.0", gateway="0.0.0.0"):
    payload = bytearray(56)
    payload[2:8] = mac
    for place, address in ((20, ip), (36, mask), (52, gateway)):
        payload[place:place + 4] = socket.inet_aton(address)
    return bytes(payload)


def action_payload(device_key, group_key, group_mask, at_ns=None):
    payload = struct.pack(">III", device_key, group_key, group_mask)
    return payload if at_ns is None else payload + struct.pack(">Q", at_ns)


def resend_payload(block, first, last, channel=0, extended=False):
    if extended:
        return struct.pack(">HHIIQ", channel, 0, first, last, block)
    return struct.pack(">HHII", channel, block, first, last)


# --- the message channel

@dataclasses.dataclass
class Event:
    id: int
    channel: int
    block: int
    timestamp: int
    data: bytes
    request_id: int
    acknowledge: bool  # the camera asked for an acknowledgement


class MessageChannel:
    """Where a camera sends its events. `deaf`: so many messages are read and not acknowledged."""

    def __init__(self, client, bind, deaf=0):
        self.client, self.deaf, self.messages = client, deaf, 0
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.socket.bind((bind, 0))
        self.port = self.socket.getsockname()[1]
        client.write_registers((MCDA, ip_number(bind)), (MCP, self.port))

    def close(self):
        self.client.write_register(MCP, 0)
        self.socket.close()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.socket.close()

    def receive(self, timeout_s=1.0):
        """The events of the next message; none when none comes."""
        self.socket.settimeout(timeout_s)
        try:
            datagram, sender = self.socket.recvfrom(65535)
        except TimeoutError:
            return []
        key, flags, code, length, request_id = struct.unpack(">BBHHH", datagram[:8])
        if key != KEY or length != len(datagram) - 8 or code not in (EVENT, EVENTDATA):
            raise ValueError(f"no event: {datagram[:8].hex()}, {len(datagram)} bytes")
        self.messages += 1
        if flags & ACKNOWLEDGE and self.messages > self.deaf:
            self.socket.sendto(struct.pack(">HHHH", SUCCESS, code + 1, 0, request_id), sender)
        return self._events(datagram[8:], code, flags, request_id)

    @staticmethod
    def _events(payload, code, flags, request_id):
        events, asked = [], bool(flags & ACKNOWLEDGE)
        size = 24 if flags & EXTENDED_IDS else 16
        while len(payload) >= size:
            if flags & EXTENDED_IDS:
                _, event, channel, _, block, timestamp = struct.unpack(">HHHHQQ", payload[:24])
            else:
                _, event, channel, block, timestamp = struct.unpack(">HHHHQ", payload[:16])
            payload = payload[size:]
            data, payload = (payload, b"") if code == EVENTDATA else (b"", payload)
            events.append(Event(event, channel, block, timestamp, data, request_id, asked))
        if payload:
            raise ValueError(f"{len(payload)} bytes past the last event")
        return events
