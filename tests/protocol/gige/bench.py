"""What the tests of the camera's outside share: the running program, its files, clients' figures."""
import ctypes
import json
import os
import pathlib
import re
import signal
import socket
import subprocess
import sys
import tempfile
import time

HERE = pathlib.Path(__file__).resolve().parent
SOURCE = HERE.parents[2]
sys.path.insert(0, str(SOURCE / "tools/client"))
from hilcam_client import HILCAM, Client, Expose, Fault  # noqa: E402

SCENARIO = SOURCE / "tests/protocol/minimal_scenario.yaml"
os.environ.setdefault("HILCAM_CACHE", tempfile.gettempdir() + f"/hilcam_test_cache_{os.getuid()}")


def free_port():
    """For commands: a UDP port of 127.0.0.1 that nobody has."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as s:
        s.bind(("127.0.0.1", 0))
        return s.getsockname()[1]


def die_with_parent():
    """No emulator outlives a test that is killed."""
    ctypes.CDLL(None).prctl(1, signal.SIGKILL)  # PR_SET_PDEATHSIG


class Emulator:
    """`hilcam run` with one GigE Vision camera; ends with the block or by stop(), which gives the report. prefix: what starts it."""

    def __init__(self, hilcam, address, folder, *sets, scenario=SCENARIO, port=None, serial=None, arguments=(),
                 namespace=None, dialect=HILCAM, prefix=()):
        self.hilcam, self.address, self.folder = str(hilcam), address, pathlib.Path(folder)
        self.dialect, self.pings = dialect, 0
        self.port = free_port() if port is None else port
        self.report_file = self.folder / f"report_{self.port}.json"
        self.log_file = self.folder / f"hilcam_{self.port}.log"
        self.namespace = ["ip", "netns", "exec", namespace] if namespace else []
        self.sets = [f"outputs.gige.interface={address}", f"outputs.gige.serial={serial or 'T%d' % self.port}",
                     f"commands.udp.port={self.port}", *sets]
        command = [*self.namespace, *prefix, self.hilcam, "run", str(scenario)]
        for value in self.sets:
            command += ["--set", value]
        with self.log_file.open("w") as log:
            self.process = subprocess.Popen([*command, "--report", str(self.report_file), *arguments], stderr=log,
                                            stdout=log, preexec_fn=die_with_parent)
        try:
            self._wait()
        except BaseException:
            self.kill()
            raise

    def _wait(self):
        for _ in range(600):
            if self.process.poll() is not None:
                raise RuntimeError("the emulator ended: " + self.log())
            self.pings += 1
            if self.send("ping", check=False).returncode == 0:
                return
            time.sleep(0.05)
        raise RuntimeError("the emulator does not answer: " + self.log())

    def log(self):
        return self.log_file.read_text()

    def send(self, *arguments, check=True):
        result = subprocess.run([*self.namespace, self.hilcam, "send", "--to", f"127.0.0.1:{self.port}", "--dialect",
                                 self.dialect, "--timeout-ms", "500", *map(str, arguments)], capture_output=True, text=True,
                                timeout=120)
        if check and result.returncode != 0:
            raise RuntimeError(f"send {arguments}: {result.stdout}{result.stderr}")
        return result

    def client(self):
        return Client(f"127.0.0.1:{self.port}", dialect=self.dialect)

    def fault(self, kind, rate=1.0, value=0.0, from_frame=0, frames=0, duration_s=0.0):
        """Orders a fault: fault("packet_drop", rate=0.02, frames=10)."""
        self._order(Fault(kind, rate, value, from_frame, frames, duration_s))

    def clear_faults(self):
        self._order(Fault())

    def expose(self, frames):
        """In lockstep: takes so many frames."""
        self._order(Expose(frames))

    def frames(self):
        """Taken so far, by housekeeping."""
        line = self.send("watch", "--housekeeping", "--json", "--duration-s", 1.5).stdout.splitlines()[-1]
        return json.loads(line)["frames"]

    def _order(self, command):
        """Until it is answered; throws RuntimeError when it is refused or never is."""
        with self.client() as client:
            client.send(command, tries=5)

    def memory_bytes(self):
        """Resident."""
        status = pathlib.Path(f"/proc/{self.process.pid}/status").read_text()
        return int(re.search(r"VmRSS:\s+(\d+) kB", status)[1]) * 1024

    def alive(self):
        return self.process.poll() is None

    def stop(self):
        self.process.send_signal(signal.SIGINT)
        self.process.wait(timeout=60)
        if self.process.returncode != 0:
            raise RuntimeError(f"the emulator ended with {self.process.returncode}: {self.log()}")
        return json.loads(self.report_file.read_text())

    def kill(self):
        if self.process.poll() is None:
            self.process.kill()
        self.process.wait()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.kill()


# --- numbers of the file output as bytes of a pixel format

def wire_bytes(dn, bits, name):
    """What the camera sends of these DN in a pixel format (PFNC name); colour formats that interpolate excepted."""
    import numpy
    flat = dn.reshape(-1).astype(numpy.uint32)
    layout = re.fullmatch(r"(Mono|Bayer[RGB]{2})(\d+)(Packed|p)?", name)
    depth, packing = int(layout[2]), layout[3]
    # Fewer bits: the upper ones. More: so that full scale is full scale; 16 bits: in the most significant ones.
    values = flat >> (bits - depth) if depth < bits else flat << (depth - bits)
    if packing == "Packed":  # two pixels in three bytes: upper eight bits of each, the lower ones between
        a, b = values[0::2], values[1::2]
        low = depth - 8
        mask = (1 << low) - 1
        middle = (a & mask) | (b & mask) << 4
        return numpy.stack([a >> low, middle, b >> low], axis=1).astype(numpy.uint8).tobytes()
    if packing == "p":  # a bit stream, least significant first
        stream = (values[:, None] >> numpy.arange(depth) & 1).astype(numpy.uint8).reshape(-1)
        return numpy.packbits(stream, bitorder="little").tobytes()
    return values.astype(numpy.uint8 if depth == 8 else "<u2").tobytes()


class FrameFiles:
    """The folder of the file output: PNG, or raw of 16 bits a pixel (needs the picture's width)."""

    def __init__(self, folder, raw_width=None):
        self.folder, self.raw_width = pathlib.Path(folder), raw_width
        self.ending = "raw" if raw_width else "png"

    def file(self, frame_id):
        return self.folder / f"frame_{frame_id:08d}.{self.ending}"

    def dn(self, frame_id):
        """(height, width) of DN."""
        import numpy
        if self.raw_width:
            return numpy.fromfile(self.file(frame_id), "<u2").reshape(-1, self.raw_width)
        from PIL import Image
        return numpy.asarray(Image.open(self.file(frame_id))).astype(numpy.uint16)

    def ids(self):
        return sorted(int(path.stem.split("_")[1]) for path in self.folder.glob(f"frame_*.{self.ending}"))


# --- Aravis's test programs

def tool(name):
    """Aravis programs carry their version in some releases of Debian: arv-test-0.8."""
    import shutil
    return shutil.which(name + "-0.8") or shutil.which(name)


# For arv-camera-test on a busy machine. By default Aravis gives a frame up after 100 ms, and at once when it would have to
# ask for more than a quarter of its packets: a camera or a client that waits for the processor looks like that.
PATIENT = ("-m", "3000", "-q", "2")


def camera_test_figures(text):
    """The n_... lines that arv-camera-test ends with."""
    return {match[1]: int(match[2]) for match in re.finditer(r"^\s*(n_\w+)\s*=\s*(-?\d+)", text, re.M)}


def too_busy():
    """Why failures of clients that judge by the clock mean nothing here and now; empty when they do mean something."""
    load, cores = os.getloadavg()[0], os.cpu_count()
    return f"load {load:.1f} on {cores} cores: too busy to judge" if load > 1.5 * cores else ""


def judge_acquisition(test, figures, text, least):
    """Every frame whole, by arv-camera-test's figures."""
    good = figures["n_completed_buffers"] >= least and not any(
        figures[name] for name in ("n_failures", "n_missing_frames", "n_underruns"))
    if not good and too_busy():
        test.skipTest(too_busy() + ": " + str({name: value for name, value in figures.items() if value}))
    test.assertTrue(good, text)


def percentile(sorted_values, share):
    """The value that a share of them does not exceed."""
    if not sorted_values:
        return float("nan")
    return sorted_values[min(len(sorted_values) - 1, max(0, -(-int(share * 1e6) * len(sorted_values) // 1_000_000) - 1))]
