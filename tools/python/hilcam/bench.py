"""A bench: `hilcam run` as a child process, from its start to its end."""
import json
import pathlib
import shutil
import signal
import socket
import subprocess
import tempfile
import time
from typing import Any, Dict, Optional, Sequence, Union

from .times import tai_ns_of_utc


class BenchFailed(RuntimeError):
    """hilcam ended before it ran, or with an error; the message is its own."""


def _free_port(kind) -> int:
    with socket.socket(socket.AF_INET, kind) as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


class Bench:
    """Runs while the object is entered: with Bench("lockstep") as bench: ...

    scenario: a file, or the name of a shipped one. set: values of keys, as --set has them. tcp and udp name free ports on which it takes
    commands, as Client takes them."""

    def __init__(self, scenario: Union[str, pathlib.Path], set: Optional[Dict[str, Any]] = None, frames: int = 0, duration_s: float = 0,
                 options: Sequence[str] = (), program: Union[str, pathlib.Path, None] = None, start_s: float = 120):
        self.scenario, self.options, self.start_s = str(scenario), list(options), start_s
        self.values = dict(set or {})
        self.program = str(program or shutil.which("hilcam") or "hilcam")
        self.limits = (["--frames", str(frames)] if frames else []) + (["--duration", str(duration_s)] if duration_s else [])
        self.process: Optional[subprocess.Popen] = None
        self.report: Optional[Dict[str, Any]] = None  # of the run, once it has ended

    def start(self) -> "Bench":
        """BenchFailed when it does not run."""
        tcp, udp = _free_port(socket.SOCK_STREAM), _free_port(socket.SOCK_DGRAM)
        self.tcp, self.udp = f"tcp:127.0.0.1:{tcp}", f"127.0.0.1:{udp}"
        values = {**self.values, "commands.tcp.port": tcp, "commands.udp.port": udp}
        sets = [word for key, value in values.items() for word in ("--set", f"{key}={self._yaml(value)}")]
        self.start_tai_ns = tai_ns_of_utc(self._start_utc(sets))
        self._folder = tempfile.TemporaryDirectory(prefix="hilcam_bench_")
        folder = pathlib.Path(self._folder.name)
        self._log = folder / "log"
        with open(self._log, "wb") as log:
            self.process = subprocess.Popen([self.program, "run", self.scenario, *sets, *self.limits, "--report", str(folder / "report.json"),
                                             *self.options], stdin=subprocess.DEVNULL, stdout=log, stderr=log)
        deadline = time.monotonic() + self.start_s
        while "running;" not in self.log:
            if self.process.poll() is not None or time.monotonic() > deadline:
                message = self.log.strip() or "hilcam does not start"
                self.stop()
                raise BenchFailed(message)
            time.sleep(0.02)
        return self

    @staticmethod
    def _yaml(value: Any) -> str:
        return value if isinstance(value, str) else json.dumps(value)

    def _start_utc(self, sets: Sequence[str]) -> str:
        """When simulated time begins: as `hilcam check` says it."""
        result = subprocess.run([self.program, "check", self.scenario, *sets, "--json"], capture_output=True, text=True)
        if result.returncode != 0:
            raise BenchFailed(result.stderr.strip())
        return json.loads(result.stdout)["time_utc"]

    @property
    def log(self) -> str:
        return self._log.read_text(errors="replace") if self._log.is_file() else ""

    def wait(self, timeout_s: Optional[float] = None) -> Dict[str, Any]:
        """Until it ends by itself; gives the run's report. BenchFailed when the run did."""
        assert self.process
        status = self.process.wait(timeout_s)
        self._take_report()
        if status != 0:
            raise BenchFailed(self.log.strip())
        return self.report or {}

    def _take_report(self) -> None:
        file = pathlib.Path(self._folder.name) / "report.json"
        if file.is_file():
            self.report = json.loads(file.read_text())

    def stop(self) -> None:
        """Ends it, as Ctrl-C does."""
        if self.process and self.process.poll() is None:
            self.process.send_signal(signal.SIGINT)
            try:
                self.process.wait(30)
            except subprocess.TimeoutExpired:
                self.process.kill()
                self.process.wait()
        self._take_report()

    def __enter__(self) -> "Bench":
        return self.start()

    def __exit__(self, *_: Any) -> None:
        self.stop()
        self._folder.cleanup()
