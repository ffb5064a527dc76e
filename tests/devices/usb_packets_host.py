#!/usr/bin/python3
"""A USB host that reads hilcam's packets by libusb until the device goes: usb_packets_host.py FILE"""
import ctypes
import sys
import time

VENDOR, PRODUCT, TRANSFER_BYTES = 0x1209, 0x0003, 16384
TIMEOUT = -7  # LIBUSB_ERROR_TIMEOUT
usb = ctypes.CDLL("libusb-1.0.so.0")
usb.libusb_open_device_with_vid_pid.restype = ctypes.c_void_p
usb.libusb_open_device_with_vid_pid.argtypes = [ctypes.c_void_p, ctypes.c_uint16, ctypes.c_uint16]
usb.libusb_get_device.restype = ctypes.c_void_p
usb.libusb_get_device.argtypes = [ctypes.c_void_p]


class Endpoint(ctypes.Structure):
    _fields_ = [("length", ctypes.c_uint8), ("kind", ctypes.c_uint8), ("address", ctypes.c_uint8), ("attributes", ctypes.c_uint8),
                ("max_packet", ctypes.c_uint16), ("interval", ctypes.c_uint8), ("refresh", ctypes.c_uint8), ("synch", ctypes.c_uint8),
                ("extra", ctypes.c_void_p), ("extra_length", ctypes.c_int)]


class Setting(ctypes.Structure):
    _fields_ = [("bytes", ctypes.c_uint8 * 9), ("endpoints", ctypes.POINTER(Endpoint)), ("extra", ctypes.c_void_p), ("extra_length", ctypes.c_int)]


class Interface(ctypes.Structure):
    _fields_ = [("settings", ctypes.POINTER(Setting)), ("count", ctypes.c_int)]


class Configuration(ctypes.Structure):
    _fields_ = [("length", ctypes.c_uint8), ("kind", ctypes.c_uint8), ("total", ctypes.c_uint16), ("rest", ctypes.c_uint8 * 5),
                ("interfaces", ctypes.POINTER(Interface)), ("extra", ctypes.c_void_p), ("extra_length", ctypes.c_int)]


def in_endpoint(handle):
    """The address of the interface's IN endpoint: the controller gives its own numbers."""
    configuration = ctypes.POINTER(Configuration)()
    assert usb.libusb_get_active_config_descriptor(ctypes.c_void_p(usb.libusb_get_device(handle)), ctypes.byref(configuration)) == 0
    setting = configuration.contents.interfaces[0].settings[0]
    return next(setting.endpoints[i].address for i in range(setting.bytes[4]) if setting.endpoints[i].address & 0x80)


def main():
    handle = None
    for _ in range(300):
        assert usb.libusb_init(None) == 0  # anew: without udev, what is plugged in later is not seen
        handle = usb.libusb_open_device_with_vid_pid(None, VENDOR, PRODUCT)
        if handle:
            break
        usb.libusb_exit(None)
        time.sleep(0.1)
    if not handle:
        sys.exit("usb_packets_host: no device")
    handle = ctypes.c_void_p(handle)
    assert usb.libusb_claim_interface(handle, 0) == 0
    endpoint, buffer, got = in_endpoint(handle.value), ctypes.create_string_buffer(TRANSFER_BYTES), ctypes.c_int()
    total = 0
    with open(sys.argv[1], "wb") as out:
        while True:
            status = usb.libusb_bulk_transfer(handle, ctypes.c_ubyte(endpoint), buffer, TRANSFER_BYTES, ctypes.byref(got), 1000)
            out.write(buffer.raw[:got.value])
            total += got.value
            if status not in (0, TIMEOUT):
                break
    print(f"usb_packets_host: {total} bytes until status {status}")
    sys.exit(0 if total else 1)


main()
