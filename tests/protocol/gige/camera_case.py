"""The base of the tests with a running emulator and clients of our own."""
import struct
import tempfile
import time
import unittest

import gvcp_client as g
from bench import Emulator, FrameFiles, wire_bytes
from genicam_client import Features
from gvsp_client import StreamReceiver

CLIENT, OTHER = "127.0.23.101", "127.0.23.102"


class CameraTest(unittest.TestCase):
    """One emulator for a class of tests; each begins with nobody in control and no fault."""
    hilcam, address, sets = "hilcam", "127.0.23.1", ()

    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.emulator = Emulator(cls.hilcam, cls.address, cls.folder.name,
                                *(value.format(folder=cls.folder.name) for value in cls.sets))
        cls.faulty, cls.xml = False, None

    @classmethod
    def tearDownClass(cls):
        cls.emulator.stop()
        cls.folder.cleanup()

    def setUp(self):
        """A camera keeps its settings from one client to the next: begin with the factory's."""
        self.clients = []
        with g.GvcpClient(self.address, CLIENT) as client:
            self.eventually("the camera is free", lambda: client.exchange(g.WRITEREG, struct.pack(
                ">II", g.CCP, g.CCP_CONTROL)).status == g.SUCCESS)
            type(self).xml = self.xml or client.description()[0]
            features = Features(client, self.xml)
            features.set("UserSetSelector", "Default")
            features.execute("UserSetLoad")
            client.write_registers((g.HEARTBEAT, 3000), (g.GVCP_CONFIG, 0), (g.GVSP_CONFIG, 0))
            client.release()

    def tearDown(self):
        for client in self.clients:
            try:
                client.tries = 1
                client.exchange(g.WRITEREG, struct.pack(">II", g.CCP, 0))
            except g.NoAnswer:
                pass
            client.close()
        if self.faulty:
            type(self).faulty = False
            self.emulator.clear_faults()
        self.assertTrue(self.emulator.alive(), self.emulator.log())

    def client(self, bind=CLIENT, **options):
        self.clients.append(g.GvcpClient(self.address, bind, **options))
        return self.clients[-1]

    def features(self, client=None):
        return Features(client or self.controller())

    def controller(self, bind=CLIENT, **options):
        client = self.client(bind, **options)
        client.control()
        return client

    def fault(self, kind, **options):
        type(self).faulty = True
        self.emulator.fault(kind, **options)

    def refused(self, status, call, *arguments):
        with self.assertRaises(g.Refused) as caught:
            call(*arguments)
        statuses = status if isinstance(status, tuple) else (status,)
        self.assertIn(caught.exception.status, statuses, str(caught.exception))
        return caught.exception.answer

    def eventually(self, what, condition, timeout_s=20.0):
        until = time.monotonic() + timeout_s
        while not condition():
            self.assertLess(time.monotonic(), until, what)
            time.sleep(0.02)


class StreamTest(CameraTest):
    """The scenario's camera with its frames in files, 12 bits."""
    BITS = 12

    @classmethod
    def setUpClass(cls):
        # Raw files at half the frame rate: a busy machine writes them, too.
        cls.sets = (*cls.sets, "outputs.files.folder={folder}/frames", "outputs.files.format=raw", "camera.frame_rate_hz=15")
        super().setUpClass()
        cls.files = FrameFiles(cls.folder.name + "/frames", 256)

    def setUp(self):
        super().setUp()
        self.camera = self.controller()
        self.feature = Features(self.camera)

    def tearDown(self):
        try:
            self.feature.execute("AcquisitionStop")
        finally:
            super().tearDown()

    def chunks_on(self, *names):
        """Frame ids tell which file a frame is."""
        self.feature.set("ChunkModeActive", True)
        for name in self.feature.entries("ChunkSelector"):
            self.feature.set("ChunkSelector", name)
            if name != "Image":
                self.feature.set("ChunkEnable", not names or name in names)

    def streaming(self, packet_bytes=1500, **options):
        stream = StreamReceiver(self.camera, CLIENT, **options).open(packet_bytes)
        self.addCleanup(stream.close)
        self.feature.execute("AcquisitionStart")
        return stream

    def stop(self):
        self.feature.execute("AcquisitionStop")

    def expected(self, frame_id, name, window=None):
        """A frame's bytes as its file has them."""
        file = self.files.file(frame_id)
        # The file's thread writes after the loop; the next file's existence says that this one is whole.
        self.eventually(f"frame file {frame_id}", lambda: file.exists() and max(self.files.ids()) > frame_id)
        dn = self.files.dn(frame_id)
        if window:
            x, y, w, h = window
            dn = dn[y:y + h, x:x + w]
        return wire_bytes(dn, self.BITS, name)

    def frame_id(self, frame):
        return self.feature.chunk_values(frame)["ChunkFrameID"]

    def same_as_file(self, frame, name="Mono12", window=None):
        self.assertTrue(frame.complete, f"missing {frame.missing}")
        frame_id = self.frame_id(frame)
        self.assertEqual(frame.image, self.expected(frame_id, name, window), f"frame {frame_id} as {name}")
