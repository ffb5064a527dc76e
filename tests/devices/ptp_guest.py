#!/usr/bin/python3
"""The guest's side of ptp_test.py, as root in the guest of tools/vm -n, whose eth0 is the wire.

    ptp_guest.py slave HILCAM FOLDER SECONDS REST    the camera, and ptp4l as a slave that steers the guest's own kernel clock; writes
                                                     FOLDER/slave.json: [second, camera minus kernel clock in ns, half width in ns].
                                                     Both go on for the rest, so that the host can judge, too
    ptp_guest.py master FOLDER STEP_AFTER SECONDS    ptp4l as a master of the guest's kernel clock, which steps by 1 s after a while

Lines that begin with `guest:` say how far it is.
"""
import json
import pathlib
import subprocess
import sys
import tempfile
import time

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "protocol/gige"))
CAMERA, MASTER, SECOND_NS = "10.23.0.1", "10.23.0.3", 1_000_000_000


def run(*command):
    result = subprocess.run([str(word) for word in command], capture_output=True, text=True)
    assert result.returncode == 0, f"{command}: {result.stdout}{result.stderr}"


def plug_in(address):
    run("modprobe", "virtio_net")
    for _ in range(100):
        if pathlib.Path("/sys/class/net/eth0").exists():
            break
        time.sleep(0.1)
    run("ip", "addr", "add", address + "/24", "brd", "+", "dev", "eth0")
    run("ip", "link", "set", "eth0", "up")


def ptp4l(*options, log):
    return subprocess.Popen(["ptp4l", "-i", "eth0", "-m", *options], stdout=open(log, "w"), stderr=subprocess.STDOUT)


def configuration(folder, text):
    file = pathlib.Path(folder, "ptp4l.cfg")
    file.write_text("[global]\ntime_stamping software\nuds_address /run/ptp4l\nlogAnnounceInterval -1\nlogSyncInterval -1\n"
                    "logMinDelayReqInterval -1\nannounceReceiptTimeout 3\ntx_timestamp_timeout 100\n" + text)
    return str(file)


def slave(hilcam, folder, seconds, rest):
    from ptp_judge import CLOCKS, sample
    import gvcp_client as g
    plug_in(CAMERA)
    log = pathlib.Path(folder, "slave_ptp4l.log")
    # The guest's clock begins with the second of its RTC. Without steps ptp4l would take minutes for what an emulated machine's
    # first stamps make it believe.
    kernel = ptp4l("-f", configuration(tempfile.mkdtemp(), "slaveOnly 1\nfirst_step_threshold 0.00002\nstep_threshold 0.002\n"), log=log)
    camera_log = open(pathlib.Path(folder, "slave_hilcam.log"), "w")
    sets = [f"outputs.gige.interface={CAMERA}", "camera.frame_rate_hz=1",
            "outputs.gige.clock={source: ptp, start: machine, offset_s: 1, ppm: 50, enable_ptp: true}"]
    camera = subprocess.Popen([hilcam, "run", str(HERE / "camera.yaml"), *(word for s in sets for word in ("--set", s))],
                              stdout=camera_log, stderr=subprocess.STDOUT)
    print("guest: camera started", flush=True)
    client = g.GvcpClient(CAMERA, CAMERA)
    samples, begin = [], time.monotonic()
    while time.monotonic() < begin + seconds:
        assert camera.poll() is None and kernel.poll() is None, "the camera or ptp4l has ended"
        try:
            client.control()
            samples.append((time.monotonic() - begin, *sample(client, CLOCKS["realtime"])))
            client.release()
        except g.NoAnswer:
            pass  # it has not begun
        time.sleep(0.5)
    pathlib.Path(folder, "slave.json").write_text(json.dumps(samples))
    print("guest: judged", flush=True)
    time.sleep(rest)
    camera.terminate()
    camera.wait()
    kernel.kill()


def master(folder, step_after, seconds):
    plug_in(MASTER)
    process = ptp4l("-f", configuration(tempfile.mkdtemp(), "masterOnly 1\n"), log=pathlib.Path(folder, "master_ptp4l.log"))
    print("guest: master started", flush=True)
    time.sleep(step_after)
    time.clock_settime_ns(time.CLOCK_REALTIME, time.clock_gettime_ns(time.CLOCK_REALTIME) + SECOND_NS)
    print("guest: the master's clock stepped by 1 s", flush=True)
    time.sleep(seconds)
    process.kill()


if __name__ == "__main__":
    if sys.argv[1] == "slave":
        slave(sys.argv[2], sys.argv[3], float(sys.argv[4]), float(sys.argv[5]))
    else:
        master(sys.argv[2], float(sys.argv[3]), float(sys.argv[4]))
