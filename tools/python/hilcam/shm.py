"""Frames from the shared memory of `outputs.shm`, without a copy: docs/shared_memory.md."""
import dataclasses
import fcntl
import mmap
import os
import pathlib
import struct
import time
from typing import Any, BinaryIO, Iterator, Optional, Tuple

import numpy

VERSION = 1
_MAGIC = b"HLCSHM 1"
_HEADER = struct.Struct("=8sIIIIQQIIII8x64s16s")
_REPORT = struct.Struct("=QqqqdddIIIIIIIIqQIIq3d4d")
_LEAST_HEADER, _LEAST_SLOT = 208, 184
_POLL_S = 1e-4
_LOOK_S = 0.05  # for a writer that was killed
_REVERSE_X, _REVERSE_Y, _HAS_POSE, _HAS_TRUTH = 1, 2, 4, 8


class SharedMemoryError(RuntimeError):
    """There is none of that name, or not one that this reader knows."""


class Overtaken(RuntimeError):
    """The ring went round while a frame was read: what was seen of it may be of two frames."""


@dataclasses.dataclass(frozen=True)
class SharedFrameReport:
    """What is known of a frame. Times are ns: TAI since 1970 on the simulated clock, monotonic ones on this machine's CLOCK_MONOTONIC
    (time.monotonic_ns()); 0 means none."""
    id: int  # of the frame in its run, from 1; skipped frames leave a gap
    exposure_mid_tai_ns: int
    exposure_mid_monotonic_ns: int
    published_monotonic_ns: int
    exposure_s: float
    gain_db: float
    black_level_dn: float
    bits: int
    width_px: int
    height_px: int
    binning_x: int
    binning_y: int
    pose_sequence: int
    trigger_sequence: int
    pose_tai_ns: int
    faults: int  # docs/faults.md
    quality_level: int
    command_arrival_monotonic_ns: int
    reverse_x: bool
    reverse_y: bool
    has_truth: bool
    position_m: Optional[Tuple[float, float, float]]  # the camera's at the exposure's middle; None: the shutter stayed closed
    attitude_wxyz: Optional[Tuple[float, float, float, float]]


class SharedFrame:
    """A frame in the memory: `pixels` is a view that cannot be written (rows, columns; uint16), valid while is_whole()."""

    def __init__(self, ring: "SharedFrames", number: int, report: SharedFrameReport, pixels: numpy.ndarray):
        self._ring, self.number, self.report, self.pixels = ring, number, report, pixels

    def is_whole(self) -> bool:
        """True while the memory still holds this frame. Ask after the pixels were read."""
        return self._ring._sequence(self.number) == 2 * self.number

    def copy(self) -> numpy.ndarray:
        """The pixels as an array of their own. Overtaken when the writer has begun another frame there."""
        out = self.pixels.copy()
        if not self.is_whole():
            raise Overtaken(f"frame {self.number} was overwritten while it was copied: more outputs.shm.slots, or read sooner")
        return out


class SharedFrames:
    """The frames of a running hilcam: with SharedFrames("hilcam") as frames: for frame in frames.follow(): ...

    Frames are numbered from 1 without gaps. Any number of readers; none holds the camera up."""

    def __init__(self, name: str = "hilcam", wait_s: float = 0):
        """Opens it; wait_s: so long one that is not there yet is waited for. SharedMemoryError says what is wrong."""
        self.name = name
        deadline = time.monotonic() + wait_s
        while True:
            try:
                path = pathlib.Path("/dev/shm") / name
                self._file = self._opened(path)
                try:
                    return self._open(path)
                except BaseException:
                    self._file.close()
                    raise
            except _NotReady as error:
                if time.monotonic() >= deadline:
                    raise SharedMemoryError(str(error)) from None
            time.sleep(0.01)

    @staticmethod
    def _opened(path: pathlib.Path) -> BinaryIO:
        try:
            return open(path, "rb")
        except FileNotFoundError:
            raise _NotReady(f"{path}: there is no such shared memory: does hilcam run with outputs.shm?") from None
        except OSError as error:
            raise SharedMemoryError(f"{path}: {error.strerror}") from None

    def _open(self, path: pathlib.Path) -> None:
        size = os.fstat(self._file.fileno()).st_size
        if size < _LEAST_HEADER:
            raise _NotReady(f"{path}: not ready yet")
        try:
            self._map: Any = mmap.mmap(self._file.fileno(), size, prot=mmap.PROT_READ)
        except OSError as error:
            raise SharedMemoryError(f"{path}: {error.strerror}") from None
        (magic, version, self._header_bytes, self.slots, self._slot_header_bytes, self._slot_bytes, segment_bytes, self.max_width_px,
         self.max_height_px, pixel_bytes, self.writer_pid, camera, colors) = _HEADER.unpack_from(self._map, 0)
        if magic == bytes(8):
            raise _NotReady(f"{path}: not ready yet")
        if magic != _MAGIC:
            raise SharedMemoryError(f"{path}: not a shared memory of hilcam's")
        if version != VERSION:
            raise SharedMemoryError(f"{path}: version {version} of hilcam's shared memory; accepted: {VERSION}")
        if (segment_bytes != size or pixel_bytes != 2 or self.slots < 1 or not _LEAST_HEADER <= self._header_bytes <= size
                or self._header_bytes % 8 or self._slot_header_bytes < _LEAST_SLOT or self._slot_header_bytes % 8 or self._slot_bytes % 8
                or self._slot_bytes < self._slot_header_bytes or self._header_bytes + self.slots * self._slot_bytes > size):
            raise SharedMemoryError(f"{path}: its header's figures do not fit its size")
        self.camera = camera.split(b"\0")[0].decode(errors="replace")
        self.colors = colors.split(b"\0")[0].decode(errors="replace")  # "RGGB", ...; empty: no filters
        # Aligned words are read in one piece, which struct does not promise.
        self._words = numpy.frombuffer(self._map, numpy.uint64, size // 8)
        self._news = numpy.frombuffer(self._map, numpy.uint32, _LEAST_HEADER // 4)

    def _place(self, number: int) -> int:
        return self._header_bytes + (number - 1) % self.slots * self._slot_bytes

    def _sequence(self, number: int) -> int:
        return int(self._words[self._place(number) // 8])

    @property
    def newest(self) -> int:
        """The number of the newest frame; 0: there is none yet."""
        return int(self._words[24])

    @property
    def has_ended(self) -> bool:
        """True when hilcam has ended or was killed, or another one has taken the name: open it again."""
        return bool(self._news[51]) or self._is_abandoned()

    def _is_abandoned(self) -> bool:
        """The writer holds a lock on its memory while it lives, however it ends."""
        try:
            fcntl.flock(self._file, fcntl.LOCK_SH | fcntl.LOCK_NB)
        except BlockingIOError:
            return False
        fcntl.flock(self._file, fcntl.LOCK_UN)
        return True

    def get(self, number: int) -> Optional[SharedFrame]:
        """The frame of that number; None when it is not there yet, or no longer."""
        if number < 1 or self._sequence(number) != 2 * number:
            return None
        place = self._place(number)
        (frame, mid, mid_monotonic, published, exposure_s, gain_db, black_dn, bits, width, height, row_bytes, binning_x, binning_y, pose,
         trigger, pose_time, faults, quality, flags, arrival, *camera) = _REPORT.unpack_from(self._map, place + 8)
        if self._sequence(number) != 2 * number:
            return None
        if row_bytes < 2 * width or row_bytes % 2 or row_bytes * height > self._slot_bytes - self._slot_header_bytes:
            raise SharedMemoryError(f"/dev/shm/{self.name}: frame {number} does not fit its slot")
        pixels = numpy.frombuffer(self._map, numpy.uint16, row_bytes // 2 * height, place + self._slot_header_bytes)
        has_pose = flags & _HAS_POSE
        report = SharedFrameReport(frame, mid, mid_monotonic, published, exposure_s, gain_db, black_dn, bits, width, height, binning_x,
                                   binning_y, pose, trigger, pose_time, faults, quality, arrival, bool(flags & _REVERSE_X),
                                   bool(flags & _REVERSE_Y), bool(flags & _HAS_TRUTH), tuple(camera[:3]) if has_pose else None,
                                   tuple(camera[3:]) if has_pose else None)
        return SharedFrame(self, number, report, pixels.reshape(height, row_bytes // 2)[:, :width])

    def wait(self, after: int, timeout_s: float = 10) -> bool:
        """Until there is a frame newer than number `after`: True; False when hilcam has ended or was killed. TimeoutError."""
        deadline, looked = time.monotonic() + timeout_s, -_LOOK_S
        while self.newest <= after:
            now = time.monotonic()
            if bool(self._news[51]) or now - looked > _LOOK_S:
                looked = now
                if self.has_ended:
                    return self.newest > after
            if now > deadline:
                raise TimeoutError(f"/dev/shm/{self.name}: no frame after number {after} within {timeout_s:g} s")
            time.sleep(_POLL_S)
        return True

    def follow(self, after: Optional[int] = None, timeout_s: float = 10) -> Iterator[SharedFrame]:
        """Frames as they come, from number after + 1 (None: from the next one) to hilcam's end. Those that the ring has lost meanwhile are
        left out; their numbers are missing."""
        number = self.newest if after is None else after
        while self.wait(number, timeout_s):
            number = max(number + 1, self.newest - self.slots + 2)
            frame = self.get(number)
            if frame is not None:
                yield frame

    def close(self) -> None:
        """Views of frames stay valid as long as they are held."""
        self._words = self._news = None
        try:
            self._map.close()
        except BufferError:
            pass  # a frame's pixels are held: the memory goes with them
        self._file.close()
        self._map = None

    def __enter__(self) -> "SharedFrames":
        return self

    def __exit__(self, *_: Any) -> None:
        self.close()


class _NotReady(SharedMemoryError):
    pass
