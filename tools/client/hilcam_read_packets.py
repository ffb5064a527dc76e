#!/usr/bin/python3
"""Reads the space packets of hilcam's outputs.packets and writes pictures (docs/packets.md).

    hilcam_read_packets.py udp:127.0.0.1:5020 --out pictures --frames 10
    hilcam_read_packets.py tcp:127.0.0.1:5020 --out pictures        connects; tcp-listen:..., unix:PATH, unix-listen:PATH
    hilcam_read_packets.py packets/packets.bin --out pictures       or a folder of files
    hilcam_read_packets.py tcp:127.0.0.1:5020 --spacewire rmap      packets inside SpaceWire packets

Each whole frame becomes FOLDER/frame_00000001.pgm (16 bits big-endian, or 8 bits). A frame that lacks packets is
named, with the rows that are missing, and written only with --partial, where missing pixels are 0. Python 3.9 or
later with its standard library. Compressed packets also need the library that compresses them: libaec0, libcharls2,
libopenjp2-7.

As a module: Reader.take(bytes) gives frames from packets; packets_of_stream() and packets_of_spacewire() cut streams.
"""
import argparse
import array
import binascii
import ctypes
import dataclasses
import os
import pathlib
import queue
import select
import socket
import struct
import sys
import tempfile
import threading
import time

RAW_LE, RAW_BE, PACKED, CCSDS_121, JPEG_LS, JPEG_2000 = range(6)
PAYLOADS = ("raw_le", "raw_be", "packed", "ccsds_121", "jpeg_ls", "jpeg_2000")
PRIMARY_BYTES, CRC_BYTES = 6, 2
SECONDARY = struct.Struct(">HIIBBBBBBHHHHHHIQdIIII")
CUC_PREAMBLE, VERSION = 0x9F04, 1
SECONDS_1958_TO_1970 = 4383 * 86400
REVERSED_X, REVERSED_Y, HAS_CRC = 1, 2, 4
IDLE_APID = 0x7FF


class BadPacket(ValueError):
    """Bytes that are no packet of a frame; its text says why."""


def _crc8_table():
    table = []
    for value in range(256):
        for _ in range(8):
            value = value >> 1 ^ 0xE0 if value & 1 else value >> 1
        table.append(value)
    return table


_CRC8 = _crc8_table()


def crc16(data):
    """CRC-16 of CCSDS 132.0-B-3, 4.1.6: x^16 + x^12 + x^5 + 1 from 0xFFFF."""
    return binascii.crc_hqx(data, 0xFFFF)


def crc8(data):
    """CRC-8 of RMAP (ECSS-E-ST-50-52C, annex A): x^8 + x^2 + x + 1, reflected, from 0."""
    crc = 0
    for byte in data:
        crc = _CRC8[crc ^ byte]
    return crc


@dataclasses.dataclass(frozen=True)
class Segment:
    """One packet."""
    apid: int
    flags: int
    count: int
    time_tai_ns: int  # mid-exposure, since 1970-01-01 TAI
    payload: int
    bits: int
    reversed_x: bool
    reversed_y: bool
    has_crc: bool
    binning_x: int
    binning_y: int
    width: int
    height: int
    offset_x: int
    offset_y: int
    first_row: int
    rows: int
    pixel_format: int
    frame: int
    exposure_s: float
    segment: int
    segments: int
    strip_offset: int
    strip_bytes: int
    data: bytes


def parse_packet(packet):
    """A space packet with an image segment. Raises BadPacket."""
    if len(packet) < PRIMARY_BYTES + SECONDARY.size:
        raise BadPacket(f"{len(packet)} bytes are too few for the headers")
    identification, sequence, length = struct.unpack_from(">HHH", packet)
    if len(packet) != PRIMARY_BYTES + length + 1:
        raise BadPacket(f"{len(packet)} bytes, where the primary header says {PRIMARY_BYTES + length + 1}")
    if identification >> 13 != 0 or identification >> 12 & 1 or not identification >> 11 & 1:
        raise BadPacket(f"identification {identification:#06x} is not telemetry with a secondary header, version 0")
    (preamble, seconds, fraction, version, payload, bits, flags, binning_x, binning_y, width, height, offset_x, offset_y,
     first_row, rows, pixel_format, frame, exposure_s, segment, segments, strip_offset,
     strip_bytes) = SECONDARY.unpack_from(packet, PRIMARY_BYTES)
    if preamble != CUC_PREAMBLE:
        raise BadPacket(f"time code {preamble:#06x} is not CUC of 4 + 4 octets since 1958")
    if version != VERSION:
        raise BadPacket(f"version {version} of the secondary header; known: {VERSION}")
    end = len(packet)
    if flags & HAS_CRC:
        end -= CRC_BYTES
        if crc16(packet) != 0:
            raise BadPacket("its CRC is wrong")
    data = bytes(packet[PRIMARY_BYTES + SECONDARY.size:end])
    if (payload >= len(PAYLOADS) or not 1 <= bits <= 16 or width == 0 or rows == 0 or first_row + rows > height or
            segment >= segments or not data or strip_offset + len(data) > strip_bytes):
        raise BadPacket("its secondary header contradicts itself")
    ns = (seconds - SECONDS_1958_TO_1970) * 10**9 + (fraction * 10**9 + 2**31 >> 32)
    return Segment(identification & 0x7FF, sequence >> 14, sequence & 0x3FFF, ns, payload, bits, bool(flags & REVERSED_X),
                   bool(flags & REVERSED_Y), bool(flags & HAS_CRC), binning_x, binning_y, width, height, offset_x, offset_y, first_row, rows,
                   pixel_format, frame, exposure_s, segment, segments, strip_offset, strip_bytes, data)


# --- streams


def packets_of_stream(buffer):
    """(whole packets, the bytes that are left) of a stream of space packets."""
    packets, at = [], 0
    while len(buffer) - at >= PRIMARY_BYTES:
        size = PRIMARY_BYTES + 1 + int.from_bytes(buffer[at + 4:at + 6], "big")
        if len(buffer) - at < size:
            break
        packets.append(bytes(buffer[at:at + size]))
        at += size
    return packets, buffer[at:]


def packets_of_spacewire(buffer):
    """(SpaceWire packets, the bytes that are left) of a stream with a length of four bytes before each packet."""
    packets, at = [], 0
    while len(buffer) - at >= 4:
        size = int.from_bytes(buffer[at:at + 4], "big")
        if len(buffer) - at - 4 < size:
            break
        packets.append(bytes(buffer[at + 4:at + 4 + size]))
        at += 4 + size
    return packets, buffer[at:]


def without_path(cargo):
    """The packet behind its path address: ports are 0 to 31, logical addresses 32 and more (ECSS-E-ST-50-12C)."""
    at = 0
    while at < len(cargo) and cargo[at] < 32:
        at += 1
    return cargo[at:]


def unwrap_ccsds(cargo):
    """The space packet of the CCSDS packet transfer protocol (ECSS-E-ST-50-53C)."""
    cargo = without_path(cargo)
    if len(cargo) < 4 or cargo[1] != 0x02:
        raise BadPacket("no SpaceWire packet of protocol 2")
    if cargo[2] != 0:
        raise BadPacket("the reserved byte is not 0")
    return cargo[4:]


@dataclasses.dataclass(frozen=True)
class RmapWrite:
    """A write command."""
    target: int
    instruction: int
    key: int
    initiator: int
    transaction: int
    address: int  # 40 bits
    data: bytes


def parse_rmap_write(cargo):
    """The write command of ECSS-E-ST-50-52C, 5.3.1. Raises BadPacket."""
    cargo = without_path(cargo)
    if len(cargo) < 17 or cargo[1] != 0x01:
        raise BadPacket("no SpaceWire packet of protocol 1 (RMAP)")
    instruction = cargo[2]
    if instruction >> 5 != 0b011:
        raise BadPacket(f"RMAP instruction {instruction:#04x} is no write command")
    reply_bytes = 4 * (instruction & 3)
    at = 4 + reply_bytes
    if len(cargo) < at + 13:
        raise BadPacket("an RMAP header is cut")
    if crc8(cargo[:at + 12]) != 0:
        raise BadPacket("the CRC of an RMAP header is wrong")
    initiator, transaction, extended, address = struct.unpack_from(">BHBI", cargo, at)
    size = int.from_bytes(cargo[at + 8:at + 11], "big")
    data = cargo[at + 12:]
    if len(data) != size + 1:
        raise BadPacket(f"{len(data) - 1} bytes of RMAP data, where the header says {size}")
    if crc8(data) != 0:
        raise BadPacket("the CRC of RMAP data is wrong")
    return RmapWrite(cargo[0], instruction, cargo[3], initiator, transaction, extended << 32 | address, data[:-1])


# --- decoders: bytes of a whole strip to DN


def _library(name, package):
    try:
        return ctypes.CDLL(name)
    except OSError:
        raise BadPacket(f"{name} is not installed (apt install {package})") from None


class _AecStream(ctypes.Structure):
    _fields_ = [("next_in", ctypes.c_char_p), ("avail_in", ctypes.c_size_t), ("total_in", ctypes.c_size_t),
                ("next_out", ctypes.c_void_p), ("avail_out", ctypes.c_size_t), ("total_out", ctypes.c_size_t),
                ("bits_per_sample", ctypes.c_uint), ("block_size", ctypes.c_uint), ("rsi", ctypes.c_uint),
                ("flags", ctypes.c_uint), ("state", ctypes.c_void_p)]


def _from_bytes(data, bits):
    """Bytes of one or two (of this machine's order) to DN."""
    dn = array.array("H")
    if bits <= 8:
        dn.extend(data)
    else:
        dn.frombytes(data)
    return dn


def decode_ccsds_121(data, pixels, bits):
    library = _library("libaec.so.0", "libaec0")
    each = 1 if bits <= 8 else 2
    out = ctypes.create_string_buffer(pixels * each)
    preprocess, most_significant_first = 8, 4
    order = most_significant_first if sys.byteorder == "big" else 0
    stream = _AecStream(next_in=data, avail_in=len(data), next_out=ctypes.addressof(out), avail_out=len(out),
                        bits_per_sample=bits, block_size=16, rsi=128, flags=preprocess | order)
    if library.aec_buffer_decode(ctypes.byref(stream)) != 0 or stream.total_out != len(out):
        raise BadPacket("libaec cannot decode it")
    return _from_bytes(out.raw, bits)


class _FrameInfo(ctypes.Structure):
    _fields_ = [("width", ctypes.c_uint32), ("height", ctypes.c_uint32), ("bits", ctypes.c_int32), ("components", ctypes.c_int32)]


def decode_jpeg_ls(data, width, rows, bits):
    library = _library("libcharls.so.2", "libcharls2")
    library.charls_jpegls_decoder_create.restype = ctypes.c_void_p
    decoder = ctypes.c_void_p(library.charls_jpegls_decoder_create())
    try:
        info = _FrameInfo()
        out = ctypes.create_string_buffer(width * rows * (1 if bits <= 8 else 2))
        steps = ((library.charls_jpegls_decoder_set_source_buffer, data, ctypes.c_size_t(len(data))),
                 (library.charls_jpegls_decoder_read_header,),
                 (library.charls_jpegls_decoder_get_frame_info, ctypes.byref(info)))
        for step, *arguments in steps:
            if step(decoder, *arguments) != 0:
                raise BadPacket("CharLS cannot decode it")
        if (info.width, info.height, info.bits, info.components) != (width, rows, bits, 1):
            raise BadPacket("the JPEG-LS picture is not that of its secondary header")
        if library.charls_jpegls_decoder_decode_to_buffer(decoder, out, ctypes.c_size_t(len(out)), ctypes.c_uint32(0)) != 0:
            raise BadPacket("CharLS cannot decode it")
        return _from_bytes(out.raw, bits)
    finally:
        library.charls_jpegls_decoder_destroy(decoder)


class _OpjComponent(ctypes.Structure):
    _fields_ = [(name, ctypes.c_uint32) for name in ("dx", "dy", "w", "h", "x0", "y0", "prec", "bpp", "sgnd", "resno", "factor")]
    _fields_ += [("data", ctypes.POINTER(ctypes.c_int32)), ("alpha", ctypes.c_uint16)]


class _OpjImage(ctypes.Structure):
    _fields_ = [(name, ctypes.c_uint32) for name in ("x0", "y0", "x1", "y1", "numcomps")]
    _fields_ += [("color_space", ctypes.c_int), ("comps", ctypes.POINTER(_OpjComponent))]


def decode_jpeg_2000(data, width, rows, bits):
    library = _library("libopenjp2.so.7", "libopenjp2-7")
    for name in ("opj_create_decompress", "opj_stream_create_default_file_stream"):
        getattr(library, name).restype = ctypes.c_void_p
    codec = ctypes.c_void_p(library.opj_create_decompress(0))  # 0: a codestream
    parameters = ctypes.create_string_buffer(1 << 16)  # opj_dparameters_t, which is smaller
    image = ctypes.POINTER(_OpjImage)()
    with tempfile.NamedTemporaryFile(suffix=".j2k") as file:
        file.write(data)
        file.flush()
        stream = ctypes.c_void_p(library.opj_stream_create_default_file_stream(os.fsencode(file.name), 1))
        try:
            library.opj_set_default_decoder_parameters(parameters)
            if not (library.opj_setup_decoder(codec, parameters) and
                    library.opj_read_header(stream, codec, ctypes.byref(image)) and
                    library.opj_decode(codec, stream, image) and library.opj_end_decompress(codec, stream)):
                raise BadPacket("OpenJPEG cannot decode it")
            component = image.contents.comps[0]
            if (image.contents.numcomps, component.w, component.h, component.prec) != (1, width, rows, bits):
                raise BadPacket("the JPEG 2000 picture is not that of its secondary header")
            return array.array("H", component.data[:width * rows])
        finally:
            if image:
                library.opj_image_destroy(image)
            library.opj_stream_destroy(stream)
            library.opj_destroy_codec(codec)


def unpack(data, pixels, bits):
    """Bit after bit, least significant first (the "p" formats of PFNC)."""
    dn, mask, waiting, have, at = array.array("H", bytes(2 * pixels)), (1 << bits) - 1, 0, 0, 0
    for byte in data:
        waiting |= byte << have
        have += 8
        while have >= bits and at < pixels:
            dn[at] = waiting & mask
            waiting >>= bits
            have -= bits
            at += 1
    return dn


def decode(payload, data, width, rows, bits):
    """The DN of a strip's whole payload. Raises BadPacket."""
    pixels = width * rows
    if payload in (RAW_LE, RAW_BE):
        if len(data) != 2 * pixels:
            raise BadPacket(f"{len(data)} bytes for {pixels} pixels of two bytes")
        dn = array.array("H", data)
        if (payload == RAW_BE) != (sys.byteorder == "big"):
            dn.byteswap()
        return dn
    if payload == PACKED:
        if len(data) != (pixels * bits + 7) // 8:
            raise BadPacket(f"{len(data)} bytes for {pixels} pixels of {bits} bits")
        return unpack(data, pixels, bits)
    if payload == CCSDS_121:
        return decode_ccsds_121(data, pixels, bits)
    if payload == JPEG_LS:
        return decode_jpeg_ls(data, width, rows, bits)
    return decode_jpeg_2000(data, width, rows, bits)


# --- frames


class Frame:
    """A frame whose packets arrive, in any order."""

    def __init__(self, first):
        self.first = first  # a Segment; what all segments of a frame have in common is read from it
        self.strips, self.segments = {}, {}

    def add(self, segment):
        same = ("payload", "bits", "width", "height", "segments", "pixel_format", "time_tai_ns", "has_crc")
        if any(getattr(segment, name) != getattr(self.first, name) for name in same):
            raise BadPacket(f"frame {segment.frame}: a packet contradicts the others")
        strip = self.strips.setdefault((segment.first_row, segment.rows, segment.strip_bytes), {})
        strip[segment.strip_offset] = segment.data
        self.segments[segment.segment] = True

    def is_whole(self):
        """All packets are there, and their data make up the strips."""
        return len(self.segments) == self.first.segments and all(
            self._tile(size, parts) for (_, _, size), parts in self.strips.items())

    @staticmethod
    def _tile(size, parts):
        at = 0
        for offset in sorted(parts):
            if offset != at:
                return False
            at += len(parts[offset])
        return at == size

    def missing(self):
        """Rows without all their pixels, as [(first, last), ...]."""
        known = bytearray(self.first.height)
        for (first_row, rows, _), rows_known in self._rows_known():
            known[first_row:first_row + rows] = rows_known
        gaps, begin = [], None
        for row, is_known in enumerate([*known, 1]):
            if not is_known and begin is None:
                begin = row
            elif is_known and begin is not None:
                gaps.append((begin, row - 1))
                begin = None
        return gaps

    def _rows_known(self):
        for key, parts in self.strips.items():
            _, rows, size = key
            if self._tile(size, parts):
                yield key, bytes([1]) * rows
                continue
            known = bytearray(rows)
            bits = {RAW_LE: 16, RAW_BE: 16, PACKED: self.first.bits}.get(self.first.payload)
            if bits is not None:  # what is compressed cannot be decoded in part
                have = bytearray(size)
                for offset, data in parts.items():
                    have[offset:offset + len(data)] = bytes([1]) * len(data)
                for row in range(rows):
                    begin, end = row * self.first.width * bits // 8, -(-(row + 1) * self.first.width * bits // 8)
                    known[row] = all(have[begin:end])
            yield key, bytes(known)

    def pixels(self):
        """The DN, row after row, as array('H'); 0 in rows that are missing. Raises BadPacket where it cannot be decoded."""
        f = self.first
        out = array.array("H", bytes(2 * f.width * f.height))
        for (first_row, rows, size), rows_known in self._rows_known():
            if not any(rows_known):
                continue
            parts = self.strips[(first_row, rows, size)]
            data = bytearray(size)
            for offset, part in parts.items():
                data[offset:offset + len(part)] = part
            dn = decode(f.payload, bytes(data), f.width, rows, f.bits)
            for row in range(rows):
                if rows_known[row]:
                    at = (first_row + row) * f.width
                    out[at:at + f.width] = dn[row * f.width:(row + 1) * f.width]
        return out


class Reader:
    """Puts packets together. Frames come out of take() when they are whole, and when `patience` later frames have begun."""

    def __init__(self, apid=None, patience=2):
        self.apid, self.patience = apid, patience
        self.open, self.done = {}, {}
        self.packets, self.bad, self.next_count, self.missing = 0, [], {}, {}

    def take(self, packet):
        """The frames that this packet completes, and older ones that stay incomplete."""
        try:
            segment = parse_packet(packet)
            if segment.apid == IDLE_APID or self.apid not in (None, segment.apid):
                return []
            self._count(segment)
            key = (segment.apid, segment.frame)
            if key in self.done:
                return []  # a late copy
            frame = self.open.setdefault(key, Frame(segment))
            frame.add(segment)
        except BadPacket as error:
            self.bad.append(str(error))
            return []
        out = [self._close(key)] if frame.is_whole() else []
        old = [k for k in self.open if k[0] == segment.apid and k[1] + self.patience <= segment.frame]
        return [self._close(k) for k in sorted(old)] + out

    def rest(self):
        """The frames that are not whole at the end."""
        return [self._close(key) for key in sorted(self.open)]

    def _close(self, key):
        self.done[key] = True
        while len(self.done) > 1000:
            del self.done[next(iter(self.done))]
        return self.open.pop(key)

    @property
    def lost(self):
        """How many packets the sequence counts say are missing."""
        return sum(map(len, self.missing.values()))

    def _count(self, segment):
        self.packets += 1
        after = self.next_count.get(segment.apid, segment.count)  # counts that do not begin anew
        missing = self.missing.setdefault(segment.apid, set())
        ahead = (segment.count - after) % 0x4000
        if ahead >= 0x2000:  # one that comes late, or twice
            missing.discard(after - 0x4000 + ahead)
            return
        missing.update(range(after, after + ahead))
        self.next_count[segment.apid] = after + ahead + 1


# --- sources


def _address(text):
    host, _, port = text.rpartition(":")
    return host or "127.0.0.1", int(port)


def _stream_socket(kind, where):
    if kind in ("tcp", "unix"):
        s = socket.socket(socket.AF_INET if kind == "tcp" else socket.AF_UNIX, socket.SOCK_STREAM)
        for _ in range(100):  # hilcam may still be starting
            try:
                s.connect(_address(where) if kind == "tcp" else where)
                return s
            except (ConnectionRefusedError, FileNotFoundError):
                time.sleep(0.1)
        sys.exit(f"{kind}:{where}: nobody listens there")
    listener = socket.socket(socket.AF_INET if kind == "tcp-listen" else socket.AF_UNIX, socket.SOCK_STREAM)
    listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    listener.bind(_address(where) if kind == "tcp-listen" else where)
    listener.listen(1)
    return listener.accept()[0]


def pieces(source, idle_s):
    """(bytes, is a whole datagram) from a socket, a file or a folder, until the sender ends or idle_s pass."""
    kind, _, where = source.partition(":")
    if kind == "udp":
        s = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        s.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 1 << 24)
        s.bind(_address(where))
        arrived = queue.SimpleQueue()
        # A thread of its own empties the kernel's buffer, which overflows while a picture is decoded.
        threading.Thread(target=lambda: [arrived.put(s.recv(65535)) for _ in iter(int, 1)], daemon=True).start()
        try:
            while True:
                yield arrived.get(timeout=idle_s), True
        except queue.Empty:
            return
    elif kind in ("tcp", "tcp-listen", "unix", "unix-listen"):
        s = _stream_socket(kind, where)
        while select.select([s], [], [], idle_s)[0]:
            data = s.recv(1 << 16)
            if not data:
                return
            yield data, False
    else:
        path = pathlib.Path(source)
        for file in sorted(path.glob("*.bin")) if path.is_dir() else [path]:
            yield file.read_bytes(), False


def packets(source, spacewire=None, idle_s=None):
    """Space packets of a source. spacewire: ccsds, rmap or None. Those that are no such packets come as BadPacket."""
    cut = packets_of_spacewire if spacewire else packets_of_stream
    left = b""
    for data, is_whole in pieces(source, idle_s):
        if is_whole:
            found = [data]
        else:
            found, left = cut(left + data)
        for packet in found:
            try:
                yield packet if spacewire is None else unwrap_ccsds(packet) if spacewire == "ccsds" else parse_rmap_write(packet).data
            except BadPacket as error:
                yield error
    if left:
        yield BadPacket(f"{len(left)} bytes at the end are no whole packet")


def write_pgm(path, pixels, width, height, bits):
    data = bytes(pixels) if bits <= 8 else None
    if data is None:
        big = array.array("H", pixels)
        if sys.byteorder == "little":
            big.byteswap()
        data = big.tobytes()
    path.write_bytes(b"P5\n%d %d\n%d\n" % (width, height, (1 << bits) - 1) + data)


def rows_text(gaps):
    return ", ".join(f"{a}" if a == b else f"{a}-{b}" for a, b in gaps)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("source")
    parser.add_argument("--out", type=pathlib.Path, help="folder of the pictures; none: frames are only listed")
    parser.add_argument("--frames", type=int, default=0, help="end after so many frames, whole or not")
    parser.add_argument("--apid", type=lambda text: int(text, 0), help="only packets of this APID")
    parser.add_argument("--spacewire", choices=("ccsds", "rmap"))
    parser.add_argument("--idle", type=float, metavar="S", help="end when nothing has come for so long")
    parser.add_argument("--partial", action="store_true", help="also write frames that lack packets")
    arguments = parser.parse_args()
    if arguments.out:
        arguments.out.mkdir(parents=True, exist_ok=True)
    reader, whole, incomplete = Reader(arguments.apid), 0, 0

    def finish(frame):
        nonlocal whole, incomplete
        f, gaps = frame.first, frame.missing()
        problem = None
        try:
            pixels = frame.pixels() if frame.is_whole() or arguments.partial else None
        except BadPacket as error:
            pixels, problem = None, str(error)
        good = frame.is_whole() and problem is None
        whole, incomplete = whole + good, incomplete + (not good)
        said = f"frame {f.frame}: {f.width} x {f.height}, {f.bits} bits, {PAYLOADS[f.payload]}"
        if not frame.is_whole():
            said += f"; {f.segments - len(frame.segments)} of {f.segments} packets lost, rows {rows_text(gaps)} missing"
        print(said + (f"; {problem}" if problem else ""), flush=True)
        if arguments.out and pixels is not None:
            name = f"frame_{f.frame:08d}{'' if good else '_partial'}.pgm"
            write_pgm(arguments.out / name, pixels, f.width, f.height, f.bits)

    try:
        for packet in packets(arguments.source, arguments.spacewire, arguments.idle):
            if isinstance(packet, BadPacket):
                reader.bad.append(str(packet))
                continue
            for frame in reader.take(packet):
                finish(frame)
            if arguments.frames and whole + incomplete >= arguments.frames:
                break
    except KeyboardInterrupt:
        pass
    if not (arguments.frames and whole + incomplete >= arguments.frames):
        for frame in reader.rest():
            finish(frame)
    print(f"{whole} frames whole, {incomplete} not; {reader.packets} packets, {reader.lost} lost, {len(reader.bad)} bad"
          + (f" (first: {reader.bad[0]})" if reader.bad else ""))
    sys.exit(0 if whole and not incomplete and not reader.bad else 1)


if __name__ == "__main__":
    main()
