#!/usr/bin/python3
"""Takes frames from a GigE Vision camera with Aravis and lays some of them out on a contact sheet.

Prints one line: frames received, failures, rate. Exit status 1 when no frame came or one was incomplete.
"""
import argparse
import pathlib
import sys
import time

import gi
import numpy
from PIL import Image, ImageDraw

gi.require_version("Aravis", "0.8")
from gi.repository import Aravis  # noqa: E402

COLUMNS, ROWS, TILE = 4, 3, 320


def bits_of(pixel_format):
    return {"Mono8": 8, "Mono12": 12, "Mono16": 16}[pixel_format]


def values_of(buffer, bits):
    width, height = buffer.get_image_width(), buffer.get_image_height()
    kind = numpy.uint8 if bits == 8 else numpy.dtype("<u2")
    return numpy.frombuffer(buffer.get_data(), kind, width * height).reshape(height, width)


def picture_of(values, bits, black):
    # One stretch for all: display gamma of 2.2 from the first frame's darkest tenth to the ADC's end.
    shown = numpy.clip((values - black) / (2**bits - 1 - black), 0, 1) ** (1 / 2.2) * 255
    return Image.fromarray(shown.astype(numpy.uint8)).resize((TILE, TILE), Image.LANCZOS)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--camera", default="127.0.0.1", help="address or name")
    parser.add_argument("--seconds", type=float, default=20)
    parser.add_argument("--out", type=pathlib.Path, required=True, help="contact sheet, PNG")
    options = parser.parse_args()

    # The packet-socket receiver needs rights that a newcomer lacks; plain UDP is what it is tested with.
    camera = Aravis.Camera.new(options.camera)
    camera.gv_set_stream_options(Aravis.GvStreamOption.PACKET_SOCKET_DISABLED)
    bits = bits_of(camera.get_pixel_format_as_string())
    stream = camera.create_stream(None, None)
    for _ in range(16):
        stream.push_buffer(Aravis.Buffer.new_allocate(camera.get_payload()))
    camera.start_acquisition()
    tiles, received, incomplete, black = [], 0, 0, None
    begun = time.monotonic()
    while (elapsed := time.monotonic() - begun) < options.seconds:
        buffer = stream.timeout_pop_buffer(2_000_000)
        if buffer is None:
            continue
        if buffer.get_status() == Aravis.BufferStatus.SUCCESS:
            received += 1
            if elapsed >= options.seconds * len(tiles) / (COLUMNS * ROWS):
                values = values_of(buffer, bits)
                if black is None:
                    black = numpy.percentile(values, 10)
                tiles.append((buffer.get_frame_id(), elapsed, picture_of(values, bits, black)))
        else:
            incomplete += 1
        stream.push_buffer(buffer)
    camera.stop_acquisition()

    sheet = Image.new("L", (COLUMNS * TILE, ROWS * (TILE + 16)))
    draw = ImageDraw.Draw(sheet)
    for i, (frame, seconds, tile) in enumerate(tiles[: COLUMNS * ROWS]):
        x, y = i % COLUMNS * TILE, i // COLUMNS * (TILE + 16)
        sheet.paste(tile, (x, y))
        draw.text((x + 4, y + TILE + 2), f"frame {frame}  {seconds:.1f} s  gamma 2.2", fill=200)
    sheet.save(options.out)
    print(f"{received} frames at {received / options.seconds:.1f} frames/s, {incomplete} incomplete")
    sys.exit(0 if received > 0 and incomplete == 0 else 1)


if __name__ == "__main__":
    main()
