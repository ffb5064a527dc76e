#!/usr/bin/env bash
# Commands over a real USB stack, both ways round. Runs in the test machine as root (tools/check-devices usb): HILCAM
# is the program, with usb_pose_gadget and usb_receiver beside it.
#
# 1. A gadget (FunctionFS on dummy_hcd) sends 10,000 poses to hilcam's libusb receiver; the cable is pulled and
#    plugged while it does; all come, in order.
# 2. The same gadget and the whole emulator with commands.usb.
# 3. hilcam is the device (commands.functionfs), `hilcam send --to usb:...` the host; the device leaves the bus by
#    a fault and comes back.
set -u
hilcam=$HILCAM
bin=$(dirname "$hilcam")
scenario=/run/scenario.yaml
failures=0
for program in hilcam usb_pose_gadget usb_receiver; do
    [ -x "$bin/$program" ] || { echo "usb: $bin/$program is missing; build it"; exit 1; }
done
cat >$scenario <<'Y'
name: usb
time_utc: 2026-03-20T14:00:00Z
camera: {name: usb, width_px: 64, height_px: 48, pitch_um: 5.5, focal_length_mm: 2.5, f_number: 8, quantum_efficiency: 0.5,
    full_well_e: 13500, read_noise_e: 5, gain_dn_e: 0.29, bits: 12, exposure_ms: 0.15, frame_rate_hz: 10}
camera_pose: {position_m: [0, -40, 0], attitude: look_at, look_at_m: [0, 0, 0], up: [0, 0, 1]}
spectrum_edges_um: [0.4, 0.7, 0.95]
quality: {samples_per_axis: 1, max_depth: 1, guard_px: 16}
Y
say() { echo "usb: $*"; }
check() { if [ "$1" -eq 0 ]; then say "PASS $2"; else say "FAIL $2"; failures=$((failures + 1)); fi; }

modprobe libcomposite && modprobe usb_f_fs && modprobe dummy_hcd num=2 || exit 1
mountpoint -q /sys/kernel/config || mount -t configfs none /sys/kernel/config
controllers=(/sys/class/udc/*)
controllers=("${controllers[@]##*/}")
say "controllers: ${controllers[*]}"

make_gadget() { # name, product id
    local gadget=/sys/kernel/config/usb_gadget/$1
    mkdir -p "$gadget" && cd "$gadget" || exit 1
    echo 0x1209 >idVendor && echo "$2" >idProduct
    mkdir -p strings/0x409 configs/c.1/strings/0x409 "functions/ffs.$1"
    echo "$1-1" >strings/0x409/serialnumber
    echo hilcam >strings/0x409/manufacturer
    echo "$1" >strings/0x409/product
    ln -s "functions/ffs.$1" configs/c.1/
    mkdir -p "/dev/ffs-$1" && mount -t functionfs "$1" "/dev/ffs-$1" || exit 1
    cd - >/dev/null || exit 1
}
plug() { echo "${controllers[0]}" >/sys/kernel/config/usb_gadget/poses/UDC; }
pull() { echo >/sys/kernel/config/usb_gadget/poses/UDC; }
start_gadget() { # count
    rm -f /run/says && mkfifo /run/says
    timeout 200 "$bin/usb_pose_gadget" /dev/ffs-poses "$1" >/run/says &
    gadget=$!
    exec 7</run/says
    read -r line <&7
    say "gadget: $line"
}

make_gadget poses 0x0001
start_gadget 10000
"$bin/usb_receiver" 1209:0001:poses-1 10000 120 &
receiver=$!
sleep 0.5 # absent at first
plug
for mark in $(seq 500 1000 8500); do
    acknowledged=0
    while [ "$acknowledged" -lt $mark ] && read -r -t 60 _ acknowledged _ <&7; do :; done
    pull
    sleep 0.5
    plug
    say "pulled and plugged after $acknowledged poses"
done
wait $receiver
check $? "10,000 poses in order, with nine pulls"
wait $gadget
check $? "every pose was acknowledged"
tail -n 1 <&7
pull

start_gadget 2000
"$hilcam" run "$scenario" --set 'commands={usb: {device: "1209:0001"}}' --duration 120 --report /run/report.json \
    2>/run/hilcam.log &
emulator=$!
plug
wait $gadget
check $? "2,000 poses to the emulator were acknowledged"
tail -n 1 <&7
kill -INT $emulator
wait $emulator
check $? "the emulator ended well"
/usr/bin/python3 - <<'P'
import json, sys
c = json.load(open("/run/report.json"))["commands"]
print("usb: the emulator's report:", c)
sys.exit(c["received"] < 2000 or c["refused"] != 0 or c["lost"] != 0)
P
check $? "its report counts them, none refused or lost"
pull

make_gadget camera 0x0002
camera="mount: /dev/ffs-camera, gadget: /sys/kernel/config/usb_gadget/camera, controller: ${controllers[1]}"
"$hilcam" run "$scenario" --duration 200 --set "commands={functionfs: {$camera}}" 2>/run/hilcam.log &
emulator=$!
send() { timeout 30 "$hilcam" send --to usb:1209:0002 --timeout-ms 5000 "$@"; }
present() { lsusb -d 1209:0002 >/dev/null; }
for _ in $(seq 300); do present && break; sleep 0.1; done
sleep 0.5
send ping
check $? "hilcam as a USB device answers"
send fly --rate-hz 100 --duration-s 5
check $? "500 poses from a USB host"
send watch --frames 5 --duration-s 20 | grep -c '^frame' | grep -qx 5
check $? "frame reports over USB"
send fault usb_short_transfer --rate 0.5
send fly --rate-hz 100 --duration-s 2
check $? "answers cut in two transfers"
send fault usb_short_transfer --rate 0
send fault usb_bad_crc --rate 1 # its own answer is wrong already
timeout 30 "$hilcam" send --to usb:1209:0002 --timeout-ms 300 ping
[ $? -eq 1 ]
check $? "an answer with a wrong CRC is no answer"
send fault usb_bad_crc --rate 0
check $? "the order that ends it is answered"
send ping
check $? "and then all is well again"
send fault usb_detach --duration-s 4
sleep 1
! present
check $? "the device has left the bus"
for _ in $(seq 100); do present && break; sleep 0.1; done
sleep 0.5
send ping
check $? "it came back and answers"
kill -INT $emulator
wait $emulator
check $? "the emulator ended well"
cat /run/hilcam.log
say "$failures failures"
exit $failures
