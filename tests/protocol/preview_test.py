#!/usr/bin/python3
"""The preview of the real program: in a real browser, and under abuse.

    preview_test.py HILCAM SOURCE_DIR [--screenshot FILE.png]
"""
import contextlib
import datetime
import http.server
import io
import json
import mimetypes
import os
import pathlib
import signal
import socket
import struct
import subprocess
import sys
import tempfile
import threading
import time
import unittest
import urllib.error
import urllib.request

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import browser
from browser import Browser, Page

HILCAM, SOURCE = sys.argv[1], pathlib.Path(sys.argv[2])
SCENARIO = SOURCE / "tests/protocol/minimal_scenario.yaml"
PORT = 15262
URL = f"http://127.0.0.1:{PORT}"


class Running:
    """hilcam run --preview, with a folder of frames beside it."""

    def __init__(self, *extra, files=True, scenario=SCENARIO):
        self.folder = tempfile.TemporaryDirectory()
        self.frames = pathlib.Path(self.folder.name) / "frames"
        self.report = pathlib.Path(self.folder.name) / "report.json"
        files = ["--set", f"outputs.files.folder={self.frames}"] if files else []
        self.process = subprocess.Popen(
            [HILCAM, "run", str(scenario), "--preview", str(PORT), "--set", f"commands.udp.port={PORT + 1}", *files,
             "--report", str(self.report), *extra], stderr=subprocess.PIPE, text=True)

    def __enter__(self):
        for _ in range(1200):
            try:
                get("/status")
                return self
            except OSError:
                if self.process.poll() is not None:
                    raise RuntimeError(self.process.stderr.read())
                time.sleep(0.1)
        raise RuntimeError("the preview does not answer")

    def memory_mb(self):
        for line in pathlib.Path(f"/proc/{self.process.pid}/status").read_text().splitlines():
            if line.startswith("VmRSS"):
                return int(line.split()[1]) / 1024
        raise RuntimeError("no VmRSS")

    def file_of(self, frame):
        return self.frames / f"frame_{frame:08d}.png"

    def stop(self):
        self.process.send_signal(signal.SIGINT)
        _, log = self.process.communicate(timeout=20)
        assert self.process.returncode == 0, log
        return json.loads(self.report.read_text())

    def __exit__(self, *_):
        if self.process.poll() is None:
            self.process.kill()
            self.process.communicate()
        self.folder.cleanup()


def get(path, **headers):
    with urllib.request.urlopen(urllib.request.Request(URL + path, headers=headers), timeout=10) as answer:
        return answer.read()


def status():
    return json.loads(get("/status"))


def post(path, body, **headers):
    headers.setdefault("Origin", URL)
    request = urllib.request.Request(URL + path, data=body.encode() if isinstance(body, str) else body, headers=headers)
    with urllib.request.urlopen(request, timeout=10) as answer:
        return answer.status


def refusal(call, *arguments, **options):
    try:
        call(*arguments, **options)
    except urllib.error.HTTPError as error:
        return error.code, error.read().decode()
    raise AssertionError("not refused")


def fetch_picture(query=""):
    """Id, x, y, width, height, step and samples of GET /frame, as docs/preview.md has them."""
    data = get("/frame" + query)
    assert data[:4] == b"HCP1"
    begin, frame = struct.unpack_from("<IQ", data, 4)
    x, y, width, height, step = struct.unpack_from("<5I", data, 24)
    return frame, x, y, width, height, step, data[begin:]


LIGHTS = ("emission", "direct.sun", "direct.lamps", "direct.planetshine", "indirect.mirrored_sun", "indirect.diffuse",
          "indirect.glossy", "rays.glossy", "rays.mirror", "rays.transmission", "rays.path", "background", "air", "points")
BLACK_DN = 64  # of the scenario's camera


def light_of(data):
    """Sum of a picture's DN above black."""
    numbers = struct.unpack(f"<{len(data) // 2}H", data)
    return sum(numbers) - BLACK_DN * len(numbers)


def picture_of(data):
    """Size, 16-bit samples and texts of a PNG's or TIFF's bytes."""
    from PIL import Image
    with Image.open(io.BytesIO(data)) as image:
        words = dict(image.text) if image.format == "PNG" else json.loads(image.tag_v2[270])
        return image.size, struct.pack(f"<{image.width * image.height}H", *image.getdata()), words


def wait_for(condition, seconds=20):
    deadline = time.monotonic() + seconds
    while not condition():
        if time.monotonic() > deadline:
            raise AssertionError("does not come true")
        time.sleep(0.05)


def read_png(file, patience=5):
    """16-bit samples of a frame's file, row by row; waits until it is complete."""
    from PIL import Image
    deadline = time.monotonic() + patience
    while True:
        try:
            with Image.open(file) as image:
                return image.size, struct.pack(f"<{image.width * image.height}H", *image.getdata())
        except (OSError, SyntaxError):  # not there yet, or half
            if time.monotonic() > deadline:
                raise
            time.sleep(0.05)


class Requests(unittest.TestCase):
    """What any client may send, without a browser."""

    @classmethod
    def setUpClass(cls):
        cls.emulator = Running().__enter__()

    @classmethod
    def tearDownClass(cls):
        cls.emulator.__exit__()

    def test_pictures_are_the_frames_and_parts_of_them(self):
        frame, x, y, width, height, step, data = fetch_picture()
        self.assertEqual((x, y, width, height, step), (0, 0, 256, 192, 1))
        size, whole = read_png(self.emulator.file_of(frame))
        self.assertEqual((size, data), ((256, 192), whole))
        frame, x, y, width, height, step, data = fetch_picture("?x=100&y=90&width=40&height=30")
        self.assertEqual((x, y, width, height, step), (100, 90, 40, 30, 1))
        _, whole = read_png(self.emulator.file_of(frame))
        self.assertEqual(data, b"".join(whole[2 * (256 * row + 100):][:80] for row in range(90, 120)))
        self.assertNotEqual(len(set(data)), 1, "the target is in this part")
        newer = fetch_picture(f"?after={frame}")[0]
        self.assertGreater(newer, frame)
        self.assertEqual(fetch_picture("?step=4")[3:6], (64, 48, 4))

    def test_numbers_are_those_of_the_frame(self):
        for query in ("", "&format=tiff"):
            data = get("/numbers?viewer=5" + query)
            size, numbers, words = picture_of(data)
            frame = int(words["frame"])
            self.assertEqual((size, numbers), read_png(self.emulator.file_of(frame)))
            self.assertGreater(len(set(numbers)), 1)
            self.assertIn("protocol_test", words["scenario"])
            self.assertEqual(data[:2], b"\x89P" if not query else b"II")

    def test_a_frame_that_is_held_stays(self):
        frame = fetch_picture("?viewer=6&hold=1")[0]
        wait_for(lambda: fetch_picture()[0] > frame + 5)
        _, numbers, _ = picture_of(get(f"/numbers?viewer=6&frame={frame}"))
        self.assertEqual(numbers, read_png(self.emulator.file_of(frame))[1])
        code, text = refusal(get, f"/numbers?viewer=6&frame={frame + 1}")
        self.assertEqual(code, 404)
        self.assertIn(f"frame {frame + 1} is no longer here; freeze the picture", text)

    def test_truth_is_told_to_who_asks(self):
        data = get("/frame?viewer=8&truth=1")
        frame, = struct.unpack_from("<Q", data, 8)
        self.assertEqual(struct.unpack_from("<I", data, 136)[0], 1)
        truth = json.loads(get(f"/truth?frame={frame}"))
        self.assertEqual(truth["frame"], frame)
        self.assertEqual([thing["name"] for thing in truth["objects"]], ["target"])
        left, top, width, height = truth["objects"][0]["visible_box_px"]
        self.assertTrue(0 <= left < left + width <= 256 and 0 <= top < top + height <= 192)
        self.assertEqual(refusal(get, "/truth?frame=999999999")[0], 404)
        # Nobody asks any more: no frame's truth is worked out.
        def told():
            return next(o for o in status()["outputs"] if o["name"] == "truth for the preview")["frames"]
        time.sleep(3)
        before, frames = told(), status()["frames"]
        wait_for(lambda: status()["frames"] > frames + 20)
        self.assertEqual(told(), before)

    def test_parts_of_the_light_add_up_to_the_picture(self):
        light, least = {}, 65535
        for name in LIGHTS:
            frame, x, y, width, height, step, data = fetch_picture(f"?viewer=31&light={name}")
            self.assertEqual((x, y, width, height, step), (0, 0, 256, 192, 1))
            light[name] = light_of(data)
            least = min(least, *struct.unpack(f"<{256 * 192}H", data))
        self.assertEqual(least, BLACK_DN, "without noise")
        self.assertGreater(light["direct.sun"], 0)
        # The lens' falloff, and light that it spreads over the edge, are the picture's alone.
        picture = light_of(read_png(self.emulator.file_of(frame))[1])
        self.assertLess(abs(sum(light.values()) / picture - 1), 0.1, (light, picture))

    def test_a_part_is_of_another_frame_each_time_and_cut_as_the_picture(self):
        first = fetch_picture("?viewer=32&light=direct.sun")
        second = fetch_picture(f"?viewer=32&light=direct.sun&after={first[0]}&x=100&y=90&width=40&height=30")
        self.assertNotEqual(second[0], first[0])
        self.assertEqual(second[1:6], (100, 90, 40, 30, 1))
        self.assertEqual(second[6][:80], first[6][2 * (256 * 90 + 100):][:80], "nothing moves")
        data = get("/frame?viewer=32&light=air&truth=1")
        frame, = struct.unpack_from("<Q", data, 8)
        self.assertEqual(struct.unpack_from("<I", data, 136)[0], 1)
        self.assertEqual(json.loads(get(f"/truth?frame={frame}"))["frame"], frame)

    def test_who_asks_for_a_part_and_leaves_stands_in_nobodys_way(self):
        post("/settings", "triggered=1&trigger_source=software")
        try:
            for name in LIGHTS:
                with socket.create_connection(("127.0.0.1", PORT), timeout=10) as s:
                    s.sendall(b"GET /frame?viewer=33&light=%s&after=1 HTTP/1.1\r\nHost: 127.0.0.1:%d\r\n\r\n" % (name.encode(), PORT))
                    time.sleep(0.2)
        finally:
            post("/settings", "triggered=0")
        wait_for(lambda: get("/frame?viewer=34&light=direct.lamps&after=1")[:4] == b"HCP1")

    def test_times_are_utc_by_the_servers_leap_seconds(self):
        data = get("/frame?viewer=9")
        tai_ns, = struct.unpack_from("<q", data, 48)
        utc = data[144:176].rstrip(b"\0").decode()
        by_hand = datetime.datetime(1970, 1, 1) + datetime.timedelta(microseconds=tai_ns // 1000) - datetime.timedelta(seconds=37)
        found = datetime.datetime.strptime(utc, "%Y-%m-%dT%H:%M:%S.%fZ")
        self.assertLess(abs((found - by_hand).total_seconds()), 0.001)

    def test_bad_requests_get_one_line(self):
        for code, needle, call in (
                (400, "'step' is '0'", lambda: get("/frame?step=0")),
                (400, "unknown key 'colour'", lambda: get("/frame?colour=1")),
                (400, "character 37", lambda: get("/frame?x=%20")),
                (400, "'light' is 'sun'; accepted: emission, direct.sun, ", lambda: get("/frame?light=sun")),
                (404, "no such page", lambda: get("/secret")),
                (400, "'format' is 'gif'; accepted: png, tiff", lambda: get("/numbers?format=gif")),
                (400, "missing key 'frame'", lambda: get("/truth")),
                (400, "accepted: a number", lambda: post("/settings", "exposure_s=long")),
                (409, "exposure_s: found 1000000000; accepted: ", lambda: post("/settings", "exposure_s=1e9")),
                (400, "value is outside its kind's range", lambda: post("/fault", "kind=image_tear&value=7")),
                (400, "a name of GET /status", lambda: post("/fault", "kind=meteor")),
                (409, "does not listen", lambda: post("/trigger", "source=software")),
                (413, "accepted: up to 4096 bytes", lambda: post("/settings", b"x" * 5000)),
                (403, "Origin", lambda: post("/fault", "clear_all=1", Origin="http://evil.example")),
                (403, "Origin", lambda: post("/fault", "clear_all=1", Origin="null")),
                (403, "not known here", lambda: get("/status", Host="evil.example")),
                (403, "not known here",
                 lambda: post("/fault", "clear_all=1", Host="evil.example:80", Origin="http://evil.example:80"))):
            with self.subTest(needle):
                found, text = refusal(call)
                self.assertEqual(found, code)
                self.assertIn(needle, text)
                self.assertEqual(text.count("\n"), 1)

    def test_two_hosts_or_one_that_hides_another_are_refused(self):
        def raw(*headers):
            with socket.create_connection(("127.0.0.1", PORT), timeout=10) as s:
                s.sendall("\r\n".join(["GET /status HTTP/1.1", *headers, "Connection: close", "", ""]).encode())
                return s.recv(4096).split(b"\r\n")[0]
        own = f"Host: 127.0.0.1:{PORT}"
        self.assertIn(b" 200 ", raw(own))
        self.assertIn(b" 400 ", raw(own, "Host: evil.example"))
        self.assertIn(b" 400 ", raw())
        self.assertIn(b" 403 ", raw(own + "@evil.example"))

    def test_beyond_loopback_somebody_has_to_be_named(self):
        def run(*sets):
            return subprocess.run([HILCAM, "run", str(SCENARIO), "--preview", str(PORT + 4), "--frames", "1", *sets],
                                  capture_output=True, text=True, timeout=60)
        open_to_all = ("--set", "outputs.preview.address=0.0.0.0")
        refused = run(*open_to_all)
        self.assertEqual(refused.returncode, 2)
        self.assertIn("hilcam: --set outputs.preview.address: found '0.0.0.0', which others can reach; give 'outputs.preview.allow' too",
                      refused.stderr)
        self.assertEqual(run(*open_to_all, "--set", "outputs.preview.allow=[10.0.0.0/8]").returncode, 0)

    def test_nothing_is_copied_while_nobody_looks(self):
        def copies():
            return next(o for o in status()["outputs"] if o["name"].startswith("preview"))["figures"]["copies"]
        time.sleep(3)  # of the last request, until the slot stops asking
        before, frames = copies(), status()["frames"]
        wait_for(lambda: status()["frames"] > frames + 20)
        self.assertEqual(copies(), before)
        fetch_picture("?after=1")
        wait_for(lambda: copies() > before)

    def test_the_port_is_not_shared(self):
        second = subprocess.run([HILCAM, "run", str(SCENARIO), "--preview", str(PORT), "--frames", "1"],
                                capture_output=True, text=True, timeout=60)
        self.assertEqual(second.returncode, 1)
        self.assertIn(f"127.0.0.1:{PORT} cannot be had", second.stderr)

    def test_a_start_that_fails_after_the_preview_ends_in_order(self):
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as taken:
            taken.bind(("127.0.0.1", PORT + 2))
            second = subprocess.run([HILCAM, "run", str(SCENARIO), "--preview", str(PORT + 3), "--set",
                                     f"commands.udp.port={PORT + 2}"], capture_output=True, text=True, timeout=60)
        self.assertEqual(second.returncode, 1, second.stderr)
        self.assertIn(str(PORT + 2), second.stderr)


class Abuse(unittest.TestCase):
    def test_floods_and_silent_clients_do_not_harm_the_loop(self):
        with Running(files=False) as emulator:
            fetch_picture()
            wait_for(lambda: status()["frames"] > 60)
            memory = emulator.memory_mb()
            address = ("127.0.0.1", PORT)
            frames = status()["frames"]

            silent = []  # connections that say nothing, or half a header
            for i in range(120):
                s = socket.socket()
                s.settimeout(5)
                s.setblocking(False)
                s.connect_ex(address)
                silent.append(s)
            time.sleep(0.5)
            for s in silent[::2]:
                try:
                    s.send(b"GET /frame HTTP/1.1\r\nHo")
                except OSError:
                    pass
            # Headers without end.
            endless = socket.create_connection(address, timeout=10)
            sent = 0
            try:
                endless.sendall(b"GET /status HTTP/1.1\r\nHost: 127.0.0.1\r\n")
                while sent < 1 << 26:
                    sent += endless.send(b"a: b\r\n" * 1000)
            except OSError:
                pass
            self.assertLess(sent, 1 << 26, "endless headers are cut off")
            for s in silent:
                s.close()
            endless.close()

            wait_for(lambda: self.answers())
            # A large body, announced or not.
            for header in (b"Content-Length: 10485760", b"Transfer-Encoding: chunked", b"Content-Length: -1"):
                s = socket.create_connection(address, timeout=10)
                answer = b""
                try:
                    s.sendall(b"POST /settings HTTP/1.1\r\nHost: 127.0.0.1:%d\r\nOrigin: http://127.0.0.1:%d\r\n%s\r\n\r\n"
                              % (PORT, PORT, header))
                    answer = s.recv(4096)
                    for _ in range(160):
                        s.sendall(b"x" * 65536)
                except OSError:
                    pass
                self.assertRegex(answer, rb"^HTTP/1.1 4(11|13) ")
                s.close()
            # Clients that ask for pictures and do not read them.
            deaf = []
            for i in range(40):
                s = socket.socket()
                s.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
                s.setblocking(False)
                s.connect_ex(address)
                deaf.append(s)
            time.sleep(0.3)
            for i, s in enumerate(deaf):
                try:
                    s.send(b"GET /frame?viewer=%d HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n" % (i + 1))
                except OSError:
                    pass
            time.sleep(1)
            for s in deaf:
                s.close()
            wait_for(lambda: self.answers())
            for _ in range(200):  # garbage and floods
                try:
                    with socket.create_connection(address, timeout=5) as s:
                        s.sendall(os.urandom(64) + b"\r\n\r\n")
                except OSError:
                    pass
            wait_for(lambda: self.answers(), 60)
            self.assertGreater(status()["frames"], frames, "the loop goes on")
            growth = emulator.memory_mb() - memory
            self.assertLess(growth, 150, "MB")
            # A client that sends byte by byte does not hold up the end.
            drip = socket.create_connection(address, timeout=5)
            drip.sendall(b"GET / HTTP/1.1\r\n")
            report = emulator.stop()
            drip.close()
            print(f"\n  {report['deadline_misses']} of {report['frames']} exposures missed, memory grew by {growth:.0f} MB",
                  end=" ", file=sys.stderr)

    def test_who_is_not_named_gets_no_answer_but_that(self):
        with Running("--set", "outputs.preview.allow=[127.0.0.1]", files=False):
            wait_for(lambda: status()["frames"] > 0)
            with socket.socket() as stranger:
                stranger.bind(("127.0.22.10", 0))
                stranger.settimeout(10)
                stranger.connect(("127.0.0.1", PORT))
                try:
                    stranger.sendall(b"GET /status HTTP/1.1\r\nHost: 127.0.0.1:%d\r\n\r\n" % PORT)
                    answer = b"".join(iter(lambda: stranger.recv(4096), b""))
                except ConnectionError:
                    answer = b""  # hung up on before the request was read
            # Or in the midst of the answer: there is nothing else in it.
            head, _, body = answer.partition(b"\r\n\r\n")
            if head:
                self.assertIn(b" 403 ", head)
            self.assertTrue(b"127.0.22.10 is not among outputs.preview.allow".startswith(body.strip()), body)

    def test_a_viewer_does_not_wait_for_those_who_dawdle(self):
        with Running(files=False):
            dawdlers = []
            for _ in range(500):
                s = socket.socket()
                s.setblocking(False)
                s.connect_ex(("127.0.0.1", PORT))
                dawdlers.append(s)
            time.sleep(0.2)
            for s in dawdlers:
                try:
                    s.send(b"GET /status HTTP/1.1\r\nX-Slow: ")
                except OSError:
                    pass
            begun = time.monotonic()
            with urllib.request.urlopen(f"{URL}/frame?viewer=7", timeout=60) as answer:
                answer.read()
            # It was half a minute, the longest that a connection may last.
            self.assertLess(time.monotonic() - begun, 12)
            for s in dawdlers:
                s.close()

    @staticmethod
    def answers():
        try:
            return status()["frames"] > 0
        except OSError:
            return False


@unittest.skipUnless(browser.PROGRAM, "Chromium is missing: the page is not looked at")
class PageInBrowser(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.emulator = Running().__enter__()
        cls.browser = Browser()

    @classmethod
    def tearDownClass(cls):
        cls.browser.close()
        report = cls.emulator.stop()
        cls.emulator.__exit__()
        assert next(o for o in report["outputs"] if o["name"].startswith("preview"))["frames"] > 0

    def setUp(self):
        post("/fault", "clear_all=1")
        post("/settings", "exposure_s=0.00015&gain_db=0&test_pattern=off&running=1&triggered=0&binning_x=1&binning_y=1")
        self.page = self.open()

    def tearDown(self):
        self.assertEqual(self.page.complaints(), [])
        self.page.close()

    def open(self, **options):
        page = Page(self.browser, URL + "/", **options)
        page.wait("window.preview && preview.frame && document.getElementById('trigger') && true")
        return page

    def freeze(self, page):
        page.run("document.activeElement.blur()")
        page.key(" ")
        page.wait("preview.frozen")
        return page.run("Number(preview.frame.id)")

    def samples(self, page):
        return bytes(page.run("Array.from(new Uint8Array(preview.frame.samples.slice().buffer))"))

    def test_it_shows_the_frames_pixel_by_pixel(self):
        frame = self.freeze(self.page)
        _, whole = read_png(self.emulator.file_of(frame))
        self.assertEqual(self.samples(self.page), whole)
        time.sleep(0.5)
        self.assertEqual(self.page.run("Number(preview.frame.id)"), frame, "frozen")
        self.page.key(" ")
        self.page.wait(f"Number(preview.frame.id) > {frame}")
        for url in self.page.requested():
            self.assertTrue(url.startswith((URL + "/", "data:")), url)

    def test_until_there_is_a_picture_the_page_says_what_it_waits_for(self):
        """The program's page from a server that answers as a camera does which loads, and then waits for a trigger."""
        seen, loaded = status(), threading.Event()

        class Loading(http.server.BaseHTTPRequestHandler):
            def do_GET(self):
                name = self.path.split("?")[0].lstrip("/")
                if name == "status":
                    loaded.wait(60)
                    answer = json.dumps(seen | {"settings": seen["settings"] | {"triggered": True}}).encode()
                elif name in ("frame", "truth"):
                    answer = None
                    time.sleep(0.2)
                else:
                    answer = get("/" + name)
                self.send_response(200 if answer is not None else 204)
                for word, value in (("Content-Length", len(answer or b"")), ("Content-Type", mimetypes.guess_type(name or "a.html")[0] or "application/json")):
                    self.send_header(word, str(value))
                with contextlib.suppress(BrokenPipeError):  # the page has gone meanwhile
                    self.end_headers()
                    self.wfile.write(answer or b"")

            def log_message(self, *_):
                pass

        with http.server.ThreadingHTTPServer(("127.0.0.1", 0), Loading) as server:
            threading.Thread(target=server.serve_forever, daemon=True).start()
            page = Page(self.browser, f"http://127.0.0.1:{server.server_port}/")
            waiting = "document.getElementById('waiting').textContent"
            shown = "['.side', '.figures', '.pair'].map(c => document.querySelector(c).getClientRects().length > 0)"
            try:
                page.wait(f"document.getElementById('waiting') && {waiting}.startsWith(\"waiting for the camera's first answer: loading, \")")
                self.assertEqual(page.run(shown), [False, False, False])
                loaded.set()
                page.wait(f"{waiting} === 'no frame yet: the camera waits for a trigger'")
                self.assertEqual(page.run(shown), [True, True, False])
            finally:
                loaded.set()
                page.close()
                server.shutdown()
        self.assertEqual(self.page.run(waiting), "")
        self.assertEqual(self.page.run(shown), [True, True, True])

    def test_counters_that_are_nought_are_not_listed(self):
        self.page.wait("document.getElementById('outputs').textContent.includes('frames ')")
        listed = self.page.run("Array.from(document.querySelectorAll('.output .figures')).map(f => f.textContent)")
        self.assertGreater(len(listed), 0)
        for figures in listed:
            self.assertNotRegex(figures, r"(?<!frames) 0(?: |$)")

    def test_the_columns_are_about_as_long_as_each_other(self):
        page = self.open(width=1440, height=900)
        left, right = (f"document.querySelector('{name}').getBoundingClientRect()" for name in (".figures .card:last-child", ".faults"))
        self.assertLess(page.run(f"Math.abs({left}.bottom - {right}.bottom) / Math.max({left}.bottom, {right}.bottom)"), 0.3)
        page.close()

    def test_the_value_under_the_cursor_and_on_the_canvas(self):
        page = self.page
        frame = self.freeze(page)
        _, whole = read_png(self.emulator.file_of(frame))
        value = lambda x, y: struct.unpack_from("<H", whole, 2 * (256 * y + x))[0]
        brightest = max(range(256 * 192), key=lambda i: value(i % 256, i // 256))
        page.run("document.getElementById('auto').value = 'full', document.getElementById('auto').dispatchEvent(new Event('change'))")
        for zoom, (x, y) in ((None, (10, 20)), (None, (brightest % 256, brightest // 256)), (16, (128, 96)), (50, (120, 90))):
            if zoom:
                page.run(f"preview.zoom({zoom})")
            else:
                page.run("preview.fit()")
            # Where the page draws the pixel's middle, by its own view.
            at = page.run(f"""(() => {{ const r = preview.canvas.getBoundingClientRect(), s = preview.shownScale(), c = preview.shownCentre();
                return [r.left + preview.canvas.width / 2 + ({x} + .5 - c.x) * s, r.top + preview.canvas.height / 2 + ({y} + .5 - c.y) * s,
                        s]; }})()""")
            page.mouse("mouseMoved", at[0], at[1])
            text = page.run("document.getElementById('pixel').textContent")
            self.assertIn(f"x {x}  y {y}   {value(x, y)} DN", text)
            self.assertIn(" e⁻", text)
            # The canvas has it at 8 bits of full scale: beside the middle where the middle has the figure.
            beside = 0.4 * at[2] if at[2] > 40 else 0
            grey = page.run(f"""(() => {{ const r = preview.canvas.getBoundingClientRect(), one = new OffscreenCanvas(1, 1).getContext('2d');
                one.drawImage(preview.canvas, Math.floor({at[0] - beside} - r.left), Math.floor({at[1] - beside} - r.top), 1, 1, 0, 0, 1, 1);
                return Array.from(one.getImageData(0, 0, 1, 1).data); }})()""")
            self.assertEqual(len(set(grey[:3])), 1)
            self.assertAlmostEqual(grey[0], value(x, y) * 255 / 4095, delta=1)

    def test_stretch_zoom_and_keys(self):
        page = self.page
        self.freeze(page)
        page.run("preview.auto = 'manual', preview.black = 64, preview.white = 1088")
        for stretch, middle in (("linear", 127.5), ("sqrt", 255 * 0.5 ** 0.5)):
            page.run(f"document.getElementById('stretch').value = '{stretch}', document.getElementById('stretch').dispatchEvent(new Event('change'))")
            table = page.run("Array.from(preview.table())")
            self.assertAlmostEqual(table[576], middle, delta=1)
            self.assertEqual((table[64], table[63], table[1088], table[4095]), (0, 0, 255, 255))
        for stretch in ("log", "asinh"):
            table = page.run(f"preview.stretch = '{stretch}', Array.from(preview.table())")
            self.assertEqual(table, sorted(table))
            self.assertGreater(table[576], 190)
        fitted = page.run("preview.shownScale()")
        page.key("1")
        self.assertEqual(page.run("preview.shownScale()"), 1)
        page.key("f")
        self.assertEqual(page.run("preview.shownScale()"), fitted)
        box = page.run("(() => { const r = preview.canvas.getBoundingClientRect(); return [r.left, r.top]; })()")
        spot = (box[0] + 200, box[1] + 150)
        before = page.run("preview.toFrame({x: 200, y: 150})")
        page.mouse("mouseWheel", *spot, deltaX=0, deltaY=-600)
        page.wait(f"preview.shownScale() > {3.9 * fitted}")
        after = page.run("preview.toFrame({x: 200, y: 150})")
        self.assertAlmostEqual(before["x"], after["x"], delta=0.01)  # the point under the cursor stays
        self.assertAlmostEqual(before["y"], after["y"], delta=0.01)
        scale = page.run("preview.shownScale()")
        page.mouse("mousePressed", *spot, button="left", clickCount=1)
        page.mouse("mouseMoved", spot[0] + 100, spot[1], button="left", buttons=1)
        page.mouse("mouseReleased", spot[0] + 100, spot[1], button="left", clickCount=1)
        self.assertAlmostEqual(page.run("preview.toFrame({x: 200, y: 150})")["x"], before["x"] - 100 / scale, delta=0.01)

    def test_settings_reach_the_camera(self):
        page = self.page
        change = "const i = document.getElementById('set-{}'); i.value = '{}'; i.dispatchEvent(new Event('change'))"
        page.run("{" + change.format("exposure_s", 2.5) + "}")
        wait_for(lambda: status()["settings"]["exposure_s"] == 0.0025)
        page.wait("preview.frame.exposure === 0.0025")
        page.run("{" + change.format("gain_db", 6) + "}")
        wait_for(lambda: status()["settings"]["gain_db"] == 6)
        page.run("{" + change.format("test_pattern", "ramp_horizontal") + "}")
        wait_for(lambda: status()["settings"]["test_pattern"] == "ramp_horizontal")
        page.wait("preview.valueAt(7, 3) === 7 && preview.valueAt(255, 100) === 255")
        # A command from elsewhere shows here.
        sent = subprocess.run([HILCAM, "send", "--to", f"127.0.0.1:{PORT + 1}", "settings", "--gain-db", "3"], timeout=10)
        self.assertEqual(sent.returncode, 0)
        page.wait("document.getElementById('set-gain_db').value === '3'")
        page.run("document.getElementById('run').click()")
        wait_for(lambda: not status()["settings"]["running"])
        page.wait("document.getElementById('chips').textContent.includes('stopped')")
        page.run("document.getElementById('run').click()")
        wait_for(lambda: status()["settings"]["running"])
        # Triggered: a click makes a frame.
        page.run("{" + change.format("triggered", 1) + "}")
        page.wait("!document.getElementById('trigger').disabled")
        # A trigger during the last free-running exposure would be missed, as it should.
        wait_for(self.no_more_frames)
        seen = page.run("Number(preview.frame.id)")
        page.run("document.getElementById('trigger').click()")
        page.wait(f"Number(preview.frame.id) > {seen}")
        page.run("{" + change.format("triggered", 0) + "}")
        page.run("{" + change.format("binning_x", 2) + "}")
        page.wait("preview.frame.frameWidth === 128 && preview.frame.frameHeight === 96")
        # A refused value is said, and the old one stays.
        page.run("{" + change.format("gain_db", 99) + "}")
        page.wait("document.getElementById('settings-answer').textContent.includes('gain_db: found 99; accepted: ')")
        self.assertEqual(status()["settings"]["gain_db"], 3)
        self.forgive(" 409 ")

    @staticmethod
    def no_more_frames():
        before = status()["frames"]
        time.sleep(0.3)
        return status()["frames"] == before

    def forgive(self, needle):
        """A refusal that the test asked for is logged by the browser."""
        complaints = self.page.complaints()
        self.assertTrue(all(needle.strip() in c for c in complaints), complaints)
        self.browser.events.clear()

    def test_how_time_goes_is_seen(self):
        page = self.page
        send = lambda *words: subprocess.run([HILCAM, "send", "--to", f"127.0.0.1:{PORT + 1}", "clock", *words], timeout=10,
                                             check=True, stdout=subprocess.DEVNULL)
        chips, frame = (f"document.getElementById('{name}').textContent" for name in ("chips", "frame"))
        self.assertNotIn("time", page.run(chips))
        try:
            send("pause")
            page.wait(f"{chips}.includes('time stands') && {frame}.includes('time_stands')")
            send("--scale", "0.5")
            send("resume")
            page.wait(f"{chips}.includes('time 0.5 times') && !{frame}.includes('time_stands')")
        finally:
            send("--scale", "1")
            send("resume")
        page.wait(f"!{chips}.includes('time')")

    def test_a_fault_button_strikes(self):
        page = self.page
        self.browser.events.clear()
        strikes = lambda: next(f for f in status()["faults"] if f["kind"] == "image_black")["strikes"]
        before = strikes()
        page.run("document.querySelector('#fault-image_black button').click()")
        page.wait("document.querySelector('#fault-image_black').classList.contains('active')")
        self.check_strikes(strikes, before)
        page.run("document.getElementById('clear').click()")
        wait_for(lambda: not any("order" in f for f in status()["faults"]))
        page.wait("!document.querySelector('.fault.active')")
        # So many frames from now on.
        page.run("document.getElementById('frames').value = 5, document.querySelector('#fault-image_saturated button').click()")
        wait_for(lambda: any("order" in f for f in status()["faults"]))
        found = next(f for f in status()["faults"] if f["kind"] == "image_saturated")["order"]
        self.assertEqual(found["frames"], 5)
        self.assertGreater(found["from_frame"], 1)
        page.wait("!document.querySelector('.fault.active')")
        page.run("document.getElementById('value').value = 9, document.querySelector('#fault-image_tear button').click()")
        page.wait("document.getElementById('fault-answer').textContent.includes('outside its kind')")
        self.forgive("400")

    def test_faults_are_folded_and_those_that_nothing_shows_say_why(self):
        page = self.page
        groups = page.run("""Array.from(document.querySelectorAll('#faults details')).map(d => [d.open, d.querySelector('summary').textContent])""")
        self.assertEqual(len(groups), 8)
        self.assertFalse(any(opened for opened, _ in groups))
        self.assertIn("not without outputs.gige", groups[0][1])
        self.assertEqual(page.run("document.querySelector('#fault-packet_drop button').disabled"), True)
        self.assertIn("that takes outputs.gige", page.run("document.querySelector('#fault-packet_drop').textContent"))
        self.assertEqual(page.run("document.querySelector('#fault-image_tear button').disabled"), False)
        self.assertNotIn("`", page.run("document.getElementById('faults').textContent"))
        # One that is in force is seen, and can be ended although nothing shows it.
        post("/fault", "kind=frame_drop&frames=0")
        page.wait("document.querySelector('#fault-frame_drop').classList.contains('active')")
        self.assertTrue(page.run("document.querySelector('#fault-frame_drop').closest('details').open"))
        page.run("document.querySelector('#fault-frame_drop button').click()")
        wait_for(lambda: not any("order" in f for f in status()["faults"]))

    def switch(self, name, on=True):
        self.page.run(f"{{ const i = document.getElementById('{name}'); i.checked = {json.dumps(on)}; i.dispatchEvent(new Event('change')); }}")

    def test_truth_is_drawn_over_the_picture(self):
        page = self.page
        for layer in ("boxes", "names", "boresight"):
            self.switch("show-" + layer)
        drawn = page.wait("preview.drawn?.boxes > 0 && preview.drawn")
        self.assertGreaterEqual(drawn["names"], 1)
        self.assertEqual((drawn["stars"], drawn["boresight"]), (0, 1))
        frame = self.freeze(page)
        # What is drawn belongs to the frame that is shown: the boxes hold the pixels that are not sky.
        self.assertEqual(page.run("preview.frame.truth.frame"), frame)
        left, top, width, height = page.run("preview.frame.truth.objects[0].visible_box_px")
        _, whole = read_png(self.emulator.file_of(frame))
        bright = [i for i in range(256 * 192) if struct.unpack_from("<H", whole, 2 * i)[0] > 500]
        self.assertGreater(len(bright), 20)
        boxes = page.run("[...preview.frame.truth.objects, ...preview.frame.truth.bodies].map(t => t.visible_box_px).filter(b => b)")
        inside = [i for i in bright if any(x - 2 <= i % 256 < x + w + 2 and y - 2 <= i // 256 < y + h + 2 for x, y, w, h in boxes)]
        self.assertGreater(len(inside), 0.9 * len(bright))
        # The box's edge is on the canvas, in its colour, and gone when it is switched off.
        at = page.run(f"(() => {{ const s = preview.shownScale(), c = preview.shownCentre(); return [preview.canvas.width / 2 + ({left} - c.x) * s,"
                      f" preview.canvas.height / 2 + ({top} + {height} / 2 - c.y) * s]; }})()")
        yellow = f"""(() => {{ const c = new OffscreenCanvas(5, 1).getContext('2d');
            c.drawImage(preview.canvas, {round(at[0])} - 2, {round(at[1])}, 5, 1, 0, 0, 5, 1);
            const d = c.getImageData(0, 0, 5, 1).data;
            for (let i = 0; i < d.length; i += 4) if (d[i] > 150 && d[i] > 2 * d[i + 2]) return true;
            return false; }})()"""
        self.assertTrue(page.run(yellow))
        self.switch("show-boxes", False)
        self.assertFalse(page.run(yellow))
        page.key(" ")

    def choose_light(self, page, light):
        page.run(f"{{ const i = document.getElementById('light'); i.value = {json.dumps(light)}; i.dispatchEvent(new Event('change')); }}")
        page.wait(f"preview.frame.light === {json.dumps(light)}")

    def test_one_part_of_the_light_is_shown_as_the_picture_is(self):
        page, answer = self.page, "document.getElementById('light-answer').textContent"
        self.choose_light(page, "direct.sun")
        self.assertEqual(page.run("preview.statistics.least"), BLACK_DN, "without noise")
        self.assertGreater(page.run("preview.statistics.most"), 500)
        page.wait("location.hash.includes('light=direct.sun')")
        self.assertIn("light direct.sun", page.run("document.getElementById('chips').textContent"))
        self.assertEqual(page.run("[document.getElementById('save-png').disabled, document.getElementById('save-view').disabled]"), [True, False])
        first = page.run("Number(preview.frame.id)")
        page.wait(f"Number(preview.frame.id) > {first} && preview.frame.light === 'direct.sun'")
        # With what is drawn over it.
        self.switch("show-boxes")
        page.wait("preview.drawn?.boxes > 0 && preview.frame.light === 'direct.sun'")
        self.switch("show-boxes", False)
        # What is frozen stays.
        frame = self.freeze(page)
        page.run("{ const i = document.getElementById('light'); i.value = 'air'; i.dispatchEvent(new Event('change')); }")
        self.assertIn("stays as it is", page.run(answer))
        self.assertEqual(page.run("[Number(preview.frame.id), preview.frame.light]"), [frame, "direct.sun"])
        page.key(" ")
        page.wait("preview.frame.light === 'air'")
        self.choose_light(page, "")
        self.assertEqual(page.run(f"[{answer}, document.getElementById('save-png').disabled]"), ["", False])
        page.run("location.hash = '#light=evil'")
        page.wait("preview.light === ''")

    def test_a_profile_is_drawn_along_a_line(self):
        page = self.page
        frame = self.freeze(page)
        page.run("document.getElementById('profile-tool').click()")
        points = page.run("""(() => { const r = preview.canvas.getBoundingClientRect(), s = preview.shownScale(), c = preview.shownCentre();
            return [[40.5, 96.5], [200.5, 96.5]].map(([x, y]) => [r.left + preview.canvas.width / 2 + (x - c.x) * s,
                r.top + preview.canvas.height / 2 + (y - c.y) * s]); })()""")
        page.mouse("mousePressed", *points[0], button="left", clickCount=1)
        page.mouse("mouseMoved", *points[1], button="left", buttons=1)
        page.mouse("mouseReleased", *points[1], button="left", clickCount=1)
        page.wait("!document.getElementById('profile-card').hidden")
        values = page.run("import('./profile.js').then(m => m.samplesAlong(preview, preview.line))")
        _, whole = read_png(self.emulator.file_of(frame))
        row = struct.unpack_from("<256H", whole, 2 * 256 * 96)
        # The ends are where the screen's pixels are.
        self.assertIn(len(values), (160, 161, 162))
        self.assertIn(values[5:-5], [list(row[i + 5:i + len(values) - 5]) for i in (39, 40, 41)])
        self.assertIn(f"{min(values)} to {max(values)} DN", page.run("document.getElementById('profile-of').textContent"))
        page.key("Escape")
        self.assertTrue(page.run("document.getElementById('profile-card').hidden"))
        page.key(" ")

    def test_the_view_is_in_the_address_and_comes_back(self):
        page = self.page
        page.run("{ const i = document.getElementById('stretch'); i.value = 'asinh'; i.dispatchEvent(new Event('change')); }")
        page.run("{ const i = document.getElementById('white'); i.value = 1000; i.dispatchEvent(new Event('input')); }")
        self.switch("show-boresight")
        self.switch("histogram-log", False)
        page.run("preview.zoom(8, {x: 100, y: 100})")
        page.run("document.getElementById('profile-tool').click(), preview.setLine({x: 10, y: 10}, {x: 200, y: 90})")
        page.wait("location.hash.includes('profile=') && location.hash.includes('zoom=8')")
        state = "[preview.stretch, preview.auto, preview.white, preview.scale, preview.centre, [...preview.layers], preview.line]"
        before = page.run(state)
        page.call("Page.reload")
        page.wait("window.preview && preview.frame && document.getElementById('trigger') && preview.drawn?.boresight === 1")
        after = page.run(state)
        for old, new in zip(before, after):
            if isinstance(old, dict):
                for key in old:
                    self.assertAlmostEqual(old[key], new[key], delta=1e-3)
            else:
                self.assertEqual(old, new)
        self.assertEqual(page.run("[document.getElementById('stretch').value, document.getElementById('show-boresight').checked,"
                                  "document.getElementById('histogram-log').checked]"), ["asinh", True, False])
        # Nonsense is left out.
        page.run("location.hash = '#stretch=plaid&zoom=-1&show=boxes,evil&profile=1,2,x,4&black=NaN'")
        page.wait("preview.stretch === 'asinh' && preview.scale === 0 && preview.layers.size === 1 && preview.line === null")

    def test_pictures_are_saved(self):
        page = self.page
        with tempfile.TemporaryDirectory() as folder:
            self.browser.call("Browser.setDownloadBehavior", behavior="allow", downloadPath=folder)
            frame = self.freeze(page)
            time.sleep(0.5)  # the camera goes on meanwhile
            def saved(button, name):
                file = pathlib.Path(folder) / name
                page.run(f"document.getElementById('{button}').click()")
                wait_for(lambda: file.exists() and file.stat().st_size > 0 or page.run("document.getElementById('save-answer').textContent"))
                self.assertEqual(page.run("document.getElementById('save-answer').textContent"), "")
                return file.read_bytes()
            whole = read_png(self.emulator.file_of(frame))
            self.assertEqual(picture_of(saved("save-png", f"camera1_frame{frame}.png"))[:2], whole)
            self.assertEqual(picture_of(saved("save-tiff", f"camera1_frame{frame}.tiff"))[:2], whole)
            from PIL import Image
            with Image.open(io.BytesIO(saved("save-view", f"view_frame{frame}.png"))) as view:
                self.assertEqual(list(view.size), page.run("[preview.canvas.width, preview.canvas.height]"))
            page.key(" ")

    def test_times_and_latency_say_what_they_are(self):
        page = self.page
        text = page.run("document.getElementById('frame').textContent")
        self.assertRegex(text, r"Exposed at2026-03-20 14:\d\d:\d\d\.\d{3} UTC2026-03-20 14:\d\d:\d\d\.\d{3} TAI")
        subprocess.run([HILCAM, "send", "--to", f"127.0.0.1:{PORT + 1}", "pose", "--position-m", "22", "15", "7", "--look-at-m", "0",
                        "0", "0", "--up", "0", "0", "1"], timeout=10, check=True, stdout=subprocess.DEVNULL)
        page.wait("preview.frame.poseSequence > 0")
        page.wait("document.getElementById('latency').getAttribute('aria-label')?.includes('commands are shown')")
        self.assertRegex(page.run("document.getElementById('frame').textContent"), r"Pose tag[^,]* UTC[^,]* TAI|Pose tagnone")
        label = "document.getElementById('histogram').getAttribute('aria-label')"
        self.assertIn("logarithmic", page.run(label))
        self.switch("histogram-log", False)
        page.wait(f"{label}.includes('linear')")

    def check_strikes(self, strikes, before):
        wait_for(lambda: strikes() > before + 3)
        self.page.wait("Math.max(...preview.frame.samples) === 0")
        self.page.wait("document.getElementById('frame').textContent.includes('image_black')")
        self.page.wait("/[1-9]/.test(document.querySelector('#fault-image_black .strikes').textContent)")

    def test_several_viewers_and_one_is_killed(self):
        second = self.open(dark=True)
        with Browser() as other:
            third = Page(other, URL + "/")
            third.wait("window.preview && preview.frame && true")
            wait_for(lambda: self.viewers() >= 3)
            for page in (self.page, second, third):
                page.wait("preview.shownRate() > 0")
        # The third's browser is dead by now.
        frame = self.page.run("Number(preview.frame.id)")
        self.page.wait(f"Number(preview.frame.id) > {frame + 5}")
        second.close()
        wait_for(lambda: self.viewers() == 1)

    def viewers(self):
        return next(o for o in status()["outputs"] if o["name"].startswith("preview"))["figures"]["viewers"]

    def test_a_narrow_window_has_no_sideways_scroll(self):
        for width in (360, 390, 700, 1280, 1440, 1800):
            self.page.resize(width, 800)
            self.page.wait(f"document.documentElement.scrollWidth <= {width}")


class FramesThatAreNotTakenApart(unittest.TestCase):
    def test_the_page_says_why_and_shows_the_picture(self):
        if not browser.PROGRAM:
            self.skipTest("Chromium is missing: the page is not looked at")
        with Running("--set", "quality.motion=exact", files=False) as emulator, Browser() as b:
            code, text = refusal(get, "/frame?viewer=1&light=air")
            self.assertEqual(code, 409)
            self.assertIn("quality.motion: found exact", text)
            page = Page(b, URL + "/#light=direct.sun")
            page.wait("document.getElementById('light-answer')?.textContent.includes('quality.motion: found exact')", 60)
            page.wait("window.preview?.frame?.light === '' && document.getElementById('light').value === ''")
            emulator.stop()


class LargeFrames(unittest.TestCase):
    def test_only_the_part_in_view_is_fetched(self):
        if not browser.PROGRAM:
            self.skipTest("Chromium is missing: the page is not looked at")
        size = ("--set", "camera.width_px=2048", "--set", "camera.height_px=1536", "--set", "camera.frame_rate_hz=4",
                "--set", "camera.pitch_um=0.7")
        with Running(*size) as emulator, Browser() as b:
            page = Page(b, URL + "/")
            page.wait("window.preview && preview.frame && preview.frame.step > 1", 60)
            self.assertLess(page.run("preview.frame.samples.length"), 1.7e6)
            page.run("preview.zoom(8)")
            page.wait("preview.frame.step === 1 && preview.frame.width < 400")
            page.run("document.activeElement.blur()")
            page.key(" ")
            page.wait("preview.frozen")
            frame, x, y = page.run("[Number(preview.frame.id), preview.frame.x + 7, preview.frame.y + 5]")
            _, whole = read_png(emulator.file_of(frame))
            self.assertEqual(page.run(f"preview.valueAt({x}, {y})"), struct.unpack_from("<H", whole, 2 * (2048 * y + x))[0])
            self.assertEqual(page.complaints(), [])
            emulator.stop()


def take_screenshot(file):
    """docs/preview.png: a run with a client, commands and a fault."""
    scenario = SOURCE / "configs/scenarios/geo_inspection.yaml"
    with Running("--set", "outputs.gige.interface=127.0.26.1", "--set", "quality.samples_per_axis=1", files=False, scenario=scenario), Browser() as b:
        client = subprocess.Popen(["arv-camera-test-0.8", "-n", "127.0.26.1", "--no-packet-socket", "--duration=60"],
                                  stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        fly = subprocess.Popen([HILCAM, "send", "--to", f"127.0.0.1:{PORT + 1}", "fly", "--from-m", "22", "15", "7",
                                "--duration-s", "60", "--rate-hz", "50"], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        post("/fault", "kind=packet_drop&rate=0.002")
        page = Page(b, URL + "/#stretch=sqrt&show=boxes,names,boresight&profile=180,520,840,470", width=1840, height=1500)
        page.wait("window.preview && preview.drawn?.boxes > 0", 60)
        wait_for(lambda: status()["latency_ms"]["last_packet"]["count"] > 10, 40)
        page.mouse("mouseMoved", 480, 420)
        time.sleep(1.5)
        page.screenshot(file)
        client.kill()
        fly.kill()


if __name__ == "__main__":
    os.environ.setdefault("HILCAM_CACHE", tempfile.gettempdir() + f"/hilcam_test_cache_{os.getuid()}")
    if "--screenshot" in sys.argv:
        take_screenshot(sys.argv[sys.argv.index("--screenshot") + 1])
    else:
        unittest.main(argv=[sys.argv[0]] + sys.argv[3:], verbosity=2)
