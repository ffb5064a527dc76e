#!/usr/bin/env bash
# Frames as space packets over a real USB stack (tools/check-devices usb): hilcam is the device, with FunctionFS on
# dummy_hcd, and a host reads its bulk IN endpoint by libusb. Runs in the test machine as root; HILCAM is the program.
set -u
hilcam=$HILCAM
source=$(cd "$(dirname "$0")/../.." && pwd)
scenario=/run/packets.yaml
failures=0
cat >$scenario <<'Y'
name: usb_packets
time_utc: 2026-03-20T14:00:00Z
camera: {name: usb, width_px: 64, height_px: 48, pitch_um: 5.5, focal_length_mm: 2.5, f_number: 8, quantum_efficiency: 0.5,
    full_well_e: 13500, read_noise_e: 5, gain_dn_e: 0.29, bits: 12, exposure_ms: 0.15, frame_rate_hz: 20}
camera_pose: {position_m: [0, -40, 0], attitude: look_at, look_at_m: [0, 0, 0], up: [0, 0, 1]}
spectrum_edges_um: [0.4, 0.7, 0.95]
quality: {samples_per_axis: 1, max_depth: 1, guard_px: 16}
Y
say() { echo "usb_packets: $*"; }
check() { if [ "$1" -eq 0 ]; then say "PASS $2"; else say "FAIL $2"; failures=$((failures + 1)); fi; }

modprobe libcomposite && modprobe usb_f_fs && modprobe dummy_hcd || exit 1
mountpoint -q /sys/kernel/config || mount -t configfs none /sys/kernel/config
controller=$(ls /sys/class/udc | head -n 1)
gadget=/sys/kernel/config/usb_gadget/packets
mkdir -p $gadget && cd $gadget || exit 1
echo 0x1209 >idVendor && echo 0x0003 >idProduct
mkdir -p strings/0x409 configs/c.1/strings/0x409 functions/ffs.packets
echo packets-1 >strings/0x409/serialnumber
ln -s functions/ffs.packets configs/c.1/
mkdir -p /dev/ffs-packets && mount -t functionfs packets /dev/ffs-packets || exit 1

# packet_bytes 1024: packets and transfers fill whole USB packets, which need one of no bytes at their end.
for bytes in 1400 1024; do
    rm -rf /run/frames
    "$hilcam" run $scenario --frames 200 --report /run/report.json --set outputs.files.folder=/run/frames \
        --set outputs.files.format=raw \
        --set "outputs.packets={transport: usb, path: /dev/ffs-packets, packet_bytes: $bytes, when_slow: wait}" 2>/run/hilcam.log &
    emulator=$!
    timeout 120 /usr/bin/python3 "$source/tests/devices/usb_packets_host.py" /run/packets.bin &
    host=$!
    for _ in $(seq 300); do echo "$controller" >$gadget/UDC 2>/dev/null && break; sleep 0.1; done
    wait $host
    check $? "a host has read packets of $bytes bytes"
    wait $emulator
    check $? "the emulator ended well"
    cat /run/hilcam.log
    PYTHONPATH=$source/tools/client /usr/bin/python3 - <<'P'
import hilcam_read_packets as r, json, pathlib, sys
reader = r.Reader()
frames = {f.first.frame: f for p in r.packets("/run/packets.bin") for f in reader.take(p)}
sent = {int(p.stem[-8:]): p.read_bytes() for p in pathlib.Path("/run/frames").glob("*.raw")}
same = all(f.pixels().tobytes() == sent[n] for n, f in frames.items())
# A host that has configured the device may read later than hilcam's patience lasts: then frames are missing, once.
there = [n in frames for n in sorted(sent) if n >= min(frames)]
gaps = sum(was and not now for was, now in zip(there, there[1:]))
print(f"usb_packets: {len(frames)} of {len(sent)} frames, {gaps} gaps, {reader.lost} packets lost, {len(reader.bad)} bad, same: {same}")
sys.exit(not same or gaps > 1 or len(reader.bad) > 0 or len(frames) < 100 or max(frames) != max(sent))
P
    check $? "whole frames, bit for bit, up to the last"
    echo >$gadget/UDC 2>/dev/null
done
say "$failures failures"
exit $failures
