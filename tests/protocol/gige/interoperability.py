#!/usr/bin/python3
"""The tables of docs/interoperability.md, measured here and now, as Markdown.

    interoperability.py HILCAM [conformance] [acquisition] [loss] [cycles] [latency] [--seconds 60]

Without a name: all of them. Wants a machine with nothing else to do.
"""
import argparse
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import time

import gvcp_client as g
import latency
from arv_lines import conformance
from bench import SOURCE, Emulator, camera_test_figures, tool
from wire import CAMERA, NotHere, Wire

ADDRESS = "127.0.23.13"
FAKE = """ip link set lo up
{fake} -i 127.0.0.1 -s FAKE1 & fake=$!
sleep 1
{test} -n '*FAKE1*'
kill $fake
"""
# Sizes of a picture of the test scene, for what a client takes; its rendering is no part of the question.
BIG = {"1024 x 1024 Mono12, 60 Hz": ("1024", "1024", "60", ()),
       "2048 x 2048 Mono8, 25 Hz": ("2048", "2048", "25", ("PixelFormat=Mono8",))}


def sizes(width, height, rate):
    return (f"camera.width_px={width}", f"camera.height_px={height}", f"camera.frame_rate_hz={rate}",
            "camera.pitch_um=2.75", "quality.max_depth=1", "quality.guard_px=0")


def version():
    text = subprocess.run([tool("arv-tool"), "--version"], capture_output=True, text=True).stdout.strip()
    return text or "unknown"


def arv_test(options, *sets, configuration=""):
    with tempfile.TemporaryDirectory() as folder, Emulator(options.hilcam, ADDRESS, folder, *sets) as emulator:
        file = pathlib.Path(folder) / "arv-test.cfg"
        file.write_text(configuration)
        told = ["-c", file] if configuration else []
        return conformance(subprocess.run([tool("arv-test"), "-n", f"*T{emulator.port}*", *told],
                                          capture_output=True, text=True, timeout=120).stdout)


def conformance_table(options):
    ours = arv_test(options)
    parts = arv_test(options, "outputs.gige.multipart=true",
                     configuration="[hilcam:test-camera]\nSensorSize=256;192\nMultipart=Intensity Confidence\n")
    isolated = ["unshare", "-n"] if os.geteuid() == 0 else ["unshare", "-rn"]
    text = subprocess.run([*isolated, "bash", "-c", FAKE.format(fake=tool("arv-fake-gv-camera"), test=tool("arv-test"))],
                          capture_output=True, text=True, timeout=120)
    theirs = conformance(text.stdout)
    print(f"`arv-test` (Aravis {version()}): as it comes; told of the sensor's size and of two parts, with `outputs.gige.multipart`; "
          "and Aravis's fake camera, as it comes:\n\n| test | hilcam | hilcam, multipart | Aravis's fake camera |\n|---|---|---|---|")
    for name in dict.fromkeys([*ours, *parts, *theirs]):
        cells = [" ".join(side[name]).strip() if name in side else "" for side in (ours, parts, theirs)]
        print("|", name, "|", " | ".join(cells), "|")


def figures_row(name, figures, seconds, extra=""):
    cells = [f"{figures['n_completed_buffers']} in {seconds:.0f} s",
             *(figures[key] for key in ("n_failures", "n_missing_frames", "n_resend_requests", "n_resent_packets")), extra]
    print("|", name, "|", " | ".join(map(str, cells)), "|", flush=True)


HEAD = "| stream | frames | failures | missing | asked again | resent | {} |\n|---|---|---|---|---|---|---|"


def acquisition_table(options):
    print(HEAD.format("exposures missed"))
    for name, (width, height, rate, features) in BIG.items():
        with tempfile.TemporaryDirectory() as folder, \
                Emulator(options.hilcam, ADDRESS, folder, *sizes(width, height, rate)) as emulator:
            text = subprocess.run([tool("arv-camera-test"), "-n", ADDRESS, "--no-packet-socket", "-a",
                                   f"--duration={options.seconds:.0f}", *(f"--features={f}" for f in features)],
                                  capture_output=True, text=True, timeout=options.seconds + 60).stdout
            report = emulator.stop()
        figures_row(name, camera_test_figures(text), options.seconds, str(report["deadline_misses"]))


def loss_table(options):
    print(HEAD.format("lost on the way"))
    arguments = ["-i", "1400", "-j", "never", f"--duration={options.seconds:.0f}"]
    with tempfile.TemporaryDirectory() as folder, Emulator(options.hilcam, ADDRESS, folder) as emulator:
        emulator.fault("packet_drop", rate=0.02)
        text = subprocess.run([tool("arv-camera-test"), "-n", ADDRESS, "--no-packet-socket", *arguments], capture_output=True,
                              text=True, timeout=options.seconds + 60).stdout
        figures_row("loopback, fault `packet_drop` 2 %", camera_test_figures(text), options.seconds)
    try:
        with Wire() as wire, tempfile.TemporaryDirectory() as folder:
            with Emulator(options.hilcam, CAMERA, folder, namespace=wire.here):
                for name, receiver in (("plain sockets", ["--no-packet-socket"]), ("packet socket", [])):
                    wire.lose(50)
                    text = wire.at_client(tool("arv-camera-test"), "-n", CAMERA, *arguments, *receiver).stdout
                    figures_row(f"veth, nftables 2 %, {name}", camera_test_figures(text), options.seconds, str(wire.lost()))
                    wire.lose_nothing()
    except NotHere as error:
        print(f"(veth: {error})")


def cycles_table(options):
    print("| what | times | got the camera again |\n|---|---|---|")
    with tempfile.TemporaryDirectory() as folder, Emulator(options.hilcam, ADDRESS, folder):
        whole = 0
        for _ in range(100):
            text = subprocess.run([tool("arv-camera-test"), "-n", ADDRESS, "--no-packet-socket", "--duration=1"],
                                  capture_output=True, text=True, timeout=60).stdout
            figures = camera_test_figures(text)
            whole += figures.get("n_completed_buffers", 0) > 0 and figures["n_failures"] == 0
        print(f"| connect, start, stop, leave | 100 | {whole} |")
        again = 0
        for _ in range(20):
            client = subprocess.Popen([tool("arv-camera-test"), "-n", ADDRESS, "--no-packet-socket", "--duration=60"],
                                      stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            time.sleep(1)
            client.send_signal(signal.SIGKILL)
            client.wait()
            with g.GvcpClient(ADDRESS) as watcher:
                until = time.monotonic() + 10
                while watcher.read_register(g.CCP) and time.monotonic() < until:
                    time.sleep(0.1)
            text = subprocess.run([tool("arv-camera-test"), "-n", ADDRESS, "--no-packet-socket", "--duration=1"],
                                  capture_output=True, text=True, timeout=60).stdout
            again += camera_test_figures(text).get("n_completed_buffers", 0) > 0
        print(f"| SIGKILL while streaming, heartbeat runs out, another connects | 20 | {again} |")


def latency_table(options):
    print(latency.HEADER)
    geo = SOURCE / "configs/scenarios/geo_inspection.yaml"
    for name, scenario in (("test scene, 256 x 192, 30 Hz", latency.SCENARIO), ("`geo_inspection`", geo)):
        for prefer in latency.PREFERENCES:
            result = latency.measure(options.hilcam, scenario, prefer, options.seconds, 200)
            print(latency.rows(name, prefer, *result), flush=True)


def main():
    tables = {"conformance": conformance_table, "acquisition": acquisition_table, "loss": loss_table, "cycles": cycles_table,
              "latency": latency_table}
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("hilcam", type=pathlib.Path)
    parser.add_argument("tables", nargs="*", metavar="TABLE", help=", ".join(tables))
    parser.add_argument("--seconds", type=float, default=60)
    options = parser.parse_args()
    for name in options.tables or tables:
        if name not in tables:
            sys.exit(f"'{name}' is no table; accepted: {', '.join(tables)}")
        print(f"<!-- {name} -->")
        tables[name](options)
        print(flush=True)


if __name__ == "__main__":
    main()
