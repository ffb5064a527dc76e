#!/usr/bin/python3
"""`hilcam campaign --slurm` on a real Slurm: slurmctld, two slurmd and munge on this machine; a node dies on the way.

    slurm_test.py HILCAM SOURCE_DIR

Skipped (77) where Debian's slurmctld, slurmd, slurm-client and munge are missing, or this is not root.
"""
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest

HILCAM, SOURCE = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
SCENARIO = SOURCE / "tests/protocol/minimal_scenario.yaml"
PATH = os.environ["PATH"] + ":/usr/sbin:/sbin"
if os.geteuid() != 0 or any(shutil.which(p, path=PATH) is None for p in ("slurmctld", "slurmd", "sbatch", "munged")):
    print("skipped: Slurm needs slurmctld, slurmd, slurm-client and munge of Debian, and root")
    sys.exit(77)

CONFIG = """
ClusterName=hilcam
SlurmctldHost=localhost
SlurmctldPort={port}
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
AuthInfo=socket={top}/munge.socket
CredType=cred/munge
StateSaveLocation={top}/state
SlurmdSpoolDir={top}/spool-%n
SlurmctldPidFile={top}/slurmctld.pid
SlurmdPidFile={top}/slurmd-%n.pid
SlurmctldLogFile={top}/slurmctld.log
SlurmdLogFile={top}/slurmd-%n.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
MpiDefault=none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
ReturnToService=2
SlurmdTimeout=10
InactiveLimit=0
KillWait=2
MessageTimeout=10
SchedulerParameters=batch_sched_delay=0,sched_interval=1
NodeName=node1 NodeHostname=localhost NodeAddr=127.0.0.1 Port={port1} CPUs=1
NodeName=node2 NodeHostname=localhost NodeAddr=127.0.0.1 Port={port2} CPUs=1
PartitionName=all Nodes=ALL Default=YES MaxTime=INFINITE State=UP
"""


class Cluster:
    def __init__(self, top):
        self.top, self.children = pathlib.Path(top), []
        self.environment = {**os.environ, "PATH": PATH, "SLURM_CONF": f"{top}/slurm.conf"}
        for name in ("state", "spool-node1", "spool-node2"):
            (self.top / name).mkdir()
        (self.top / "munge.key").write_bytes(os.urandom(1024))
        os.chmod(self.top / "munge.key", 0o400)
        base = 20000 + os.getpid() % 20000
        (self.top / "slurm.conf").write_text(CONFIG.format(top=top, port=base, port1=base + 1, port2=base + 2))
        (self.top / "cgroup.conf").write_text("CgroupAutomount=no\n")
        self.start("munged", "--foreground", "--force", f"--key-file={top}/munge.key", f"--socket={top}/munge.socket", f"--pid-file={top}/munge.pid",
                   f"--log-file={top}/munge.log", f"--seed-file={top}/munge.seed")
        self.wait(lambda: (self.top / "munge.socket").exists(), 10, "munged")
        self.start("slurmctld", "-D", "-c")
        self.nodes = {name: self.start("slurmd", "-D", "-N", name) for name in ("node1", "node2")}
        self.wait(lambda: self.states().count("idle") == 2, 60, "two idle nodes")

    def start(self, *command):
        log = open(self.top / f"{command[0]}-{len(self.children)}.out", "wb")
        child = subprocess.Popen(command, env=self.environment, stdout=log, stderr=log)
        log.close()
        self.children.append(child)
        return child

    def run(self, *command):
        return subprocess.run(list(map(str, command)), env=self.environment, capture_output=True, text=True, timeout=300)

    def states(self):
        return [s.rstrip("*") for s in self.run("sinfo", "-h", "-N", "-o", "%t").stdout.split()]

    def wait(self, true, seconds, what):
        deadline = time.monotonic() + seconds
        while not true():
            if time.monotonic() > deadline:
                logs = "".join(f"--- {f.name}\n{f.read_text(errors='replace')[-1500:]}" for f in sorted(self.top.glob("*.log")) + sorted(self.top.glob("*.out")))
                raise AssertionError(f"{what} did not come in {seconds} s; sinfo: {self.states()}; squeue: {self.run('squeue').stdout}\n{logs}")
            time.sleep(0.25)

    def kill_node(self, name):
        """The daemon and all that it has started, as if the power had gone."""
        node = self.nodes[name]
        own = set()
        for pid in pathlib.Path("/proc").glob("[0-9]*"):
            try:
                environment = (pid / "environ").read_bytes()
                if f"SLURM_CONF={self.top}/slurm.conf".encode() in environment and f"SLURMD_NODENAME={name}".encode() in environment:
                    own.add(int(pid.name))
            except OSError:
                continue
        node.kill()
        node.wait()
        for pid in own:
            try:
                os.kill(pid, signal.SIGKILL)
            except ProcessLookupError:
                pass
        return len(own)

    def stop(self):
        for child in reversed(self.children):
            if child.poll() is None:
                child.terminate()
        for child in self.children:
            try:
                child.wait(10)
            except subprocess.TimeoutExpired:
                child.kill()
                child.wait()


class Slurm(unittest.TestCase):
    def test_an_array_makes_the_same_bits_though_a_node_dies(self):
        with tempfile.TemporaryDirectory() as top:
            top = pathlib.Path(top)
            (top / "c.yaml").write_text(f"name: c\nscenario: {SCENARIO}\ncount: 40\nview: {{size_px: {{log_uniform: [60, 170]}}}}\nlabels: [coco]\n")
            subprocess.run([HILCAM, "campaign", top / "c.yaml", "--out", top / "alone"], check=True, capture_output=True)
            (top / "slurm").mkdir()
            cluster = Cluster(top / "slurm")
            try:
                shared = top / "shared"
                result = cluster.run(HILCAM, "campaign", top / "c.yaml", "--out", shared, "--slurm", "--task-s", 1)
                self.assertEqual(result.returncode, 0, result.stderr)
                self.assertRegex(result.stderr, r"tasks of \d+ cases")
                self.assertRegex(result.stderr, r"submitted: job \d+, and \d+ to put its results together")
                done = lambda: len(list((shared / "cases").glob("0*.json")))  # noqa: E731
                cluster.wait(lambda: done() >= 6, 120, "six cases")
                killed = cluster.kill_node("node2")
                self.assertGreater(killed, 0)
                self.assertLess(done(), 40)
                time.sleep(12)  # until Slurm takes it for dead
                cluster.nodes["node2"] = cluster.start("slurmd", "-D", "-N", "node2")
                cluster.wait(lambda: (shared / "index.csv").is_file() and not cluster.run("squeue", "-h").stdout.strip(), 300, "the last job")
                if (shared / "index.csv").read_text() != (top / "alone/index.csv").read_text():
                    # Tasks that Slurm gave up are written anew, and only those.
                    again = cluster.run(HILCAM, "campaign", top / "c.yaml", "--out", shared, "--slurm", "--task-s", 1)
                    self.assertEqual(again.returncode, 0, again.stderr)
                    cluster.wait(lambda: not cluster.run("squeue", "-h").stdout.strip(), 300, "the second array")
                for name in ("index.csv", "coco/all.json"):
                    self.assertEqual((shared / name).read_bytes(), (top / "alone" / name).read_bytes(), name)
                for n in range(1, 41):
                    self.assertEqual((shared / f"images/{n:06d}.png").read_bytes(), (top / f"alone/images/{n:06d}.png").read_bytes())
                self.assertIn("no case is missing", cluster.run(HILCAM, "campaign", top / "c.yaml", "--out", shared, "--slurm").stderr)
            finally:
                cluster.stop()


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + sys.argv[3:], verbosity=2)
