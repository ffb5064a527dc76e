#!/usr/bin/python3
"""The camera's GenICam description: complete, valid, and true.

    description_test.py HILCAM
"""
import collections
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

import gvcp_client as g
from bench import SOURCE, tool
from camera_case import CameraTest
from genicam_client import Features

sys.path.insert(0, str(SOURCE / "tools"))
import make_feature_table  # noqa: E402

CameraTest.hilcam = sys.argv[1]
CameraTest.address = "127.0.23.14"


class Description(CameraTest):
    # Features that clients rely on: SFNC names, mandatory ones first.
    NEEDED = """Width Height PixelFormat PayloadSize AcquisitionMode AcquisitionStart AcquisitionStop
        DeviceVendorName DeviceModelName DeviceVersion DeviceFirmwareVersion DeviceSerialNumber DeviceUserID
        DeviceManufacturerInfo SensorWidth SensorHeight WidthMax HeightMax OffsetX OffsetY
        BinningHorizontal BinningVertical ReverseX ReverseY
        TestPattern ExposureMode ExposureTime ExposureAuto Gain BlackLevel AcquisitionFrameRate AcquisitionFrameRateEnable
        AcquisitionFrameCount AcquisitionBurstFrameCount TriggerSelector TriggerMode TriggerSource TriggerSoftware
        TriggerActivation TriggerDelay GevSCPSPacketSize GevSCPSFireTestPacket GevSCPSDoNotFragment GevSCPD
        GevTimestampTickFrequency GevTimestampValue GevTimestampControlLatch GevTimestampControlReset GevHeartbeatTimeout
        GevCCP GevMACAddress GevCurrentIPAddress GevStreamChannelCount TLParamsLocked DeviceReset DeviceTemperature
        ChunkModeActive ChunkSelector ChunkEnable ChunkFrameID ChunkTimestamp ChunkExposureTime ChunkGain ChunkWidth
        ChunkHeight ChunkOffsetX ChunkOffsetY ChunkPixelFormat EventSelector EventNotification UserSetSelector UserSetLoad
        UserSetSave UserSetDefault PtpEnable PtpStatus ActionDeviceKey ActionGroupKey ActionGroupMask""".split()

    def test_the_url_has_the_form_that_clients_read(self):
        client = self.client()
        self.assertRegex(client.read_text(g.URL_0, 512), r"^Local:///[^;\s/]+\.(xml|zip);[0-9A-Fa-f]+;[0-9A-Fa-f]+$")

    def test_both_urls_give_the_same_description(self):
        client = self.client()
        first, second = client.description(g.URL_0), client.description(g.URL_1)
        self.assertEqual(first[0], second[0])
        self.assertIn(".zip", (first[1] + second[1]).lower())

    def test_the_features_that_clients_rely_on_are_there(self):
        features = Features(self.client())
        self.assertEqual([name for name in self.NEEDED if name not in features], [])

    def test_every_feature_that_says_it_can_be_read_can(self):
        features = Features(self.client())
        chunks = set(features.chunk_ids())
        failed = {}
        for name, kind in features.kinds.items():
            if kind not in ("Integer", "Float", "Boolean", "Enumeration", "StringReg", "IntReg", "MaskedIntReg", "FloatReg",
                            "IntSwissKnife", "SwissKnife", "Converter", "IntConverter") or name in chunks:
                continue
            node = name
            while features.text(node, "pValue"):
                node = features.text(node, "pValue")
            if features.text(node, "AccessMode") == "WO" or features.text(node, "pPort", "Device") != "Device":
                continue
            try:
                value = features.get(name)
                low, high = features.limit(name, "Min"), features.limit(name, "Max")
                if kind in ("Integer", "Float") and low is not None and high is not None:
                    self.assertTrue(low <= value <= high, f"{name} is {value}, not {low} to {high}")
                if kind == "Enumeration":
                    self.assertIn(value, features.entries(name), name)
            except g.Refused as error:
                failed[name] = str(error)
        self.assertEqual(failed, {})

    def test_it_is_valid_by_the_schema(self):
        """GenApi's schema 1.1 lies inside arv-test, which itself validates against 1.0's whatever it is asked for."""
        program = tool("arv-test")
        if program is None or shutil.which("xmllint") is None:
            self.skipTest("arv-test or xmllint is not installed (aravis-tools, libxml2-utils)")
        with open(program, "rb") as binary:
            schema = re.search(rb"<xs:schema[^>]*GenApi/Version_1_1.*?</xs:schema>", binary.read(), re.S)
        with tempfile.NamedTemporaryFile(suffix=".xsd") as rules, tempfile.NamedTemporaryFile(suffix=".xml") as description:
            rules.write(schema[0])
            description.write(self.client().description()[0].encode())
            rules.flush(), description.flush()
            result = subprocess.run(["xmllint", "--noout", "--schema", rules.name, description.name],
                                    capture_output=True, text=True)
            self.assertEqual(result.returncode, 0, result.stderr)

    def test_links_between_nodes_lead_somewhere(self):
        features = Features(self.client())
        for name, element in features.nodes.items():
            for child in element:
                tag = child.tag.split("}")[-1]
                if tag.startswith("p") and tag[1:2].isupper():
                    self.assertIn(child.text, features.nodes, f"{tag} of {name}")

    def test_categories_hold_every_feature_once(self):
        features = Features(self.client())
        listed = collections.Counter(text for name, kind in features.kinds.items() if kind == "Category"
                                     for text in features.texts(name, "pFeature"))
        self.assertEqual([name for name, count in listed.items() if count != 1], [])
        reached, ahead = set(), ["Root"]
        while ahead:
            name = ahead.pop()
            reached.add(name)
            if features.kinds[name] == "Category":
                ahead += features.texts(name, "pFeature")
        self.assertEqual([name for name in self.NEEDED if name not in reached], [])

    def test_the_documents_table_is_what_the_camera_serves(self):
        document = (SOURCE / "docs/genicam.md").read_text()
        served = self.client().description()[0]
        made = make_feature_table.with_table(document, served if isinstance(served, str) else served.decode())
        self.assertEqual(made, document, "tools/make_feature_table.py makes docs/genicam.md anew")

    def documented(self):
        """docs/genicam.md, of this test's camera."""
        text = (SOURCE / "docs/genicam.md").read_text()
        serial = next(s.split("=")[1] for s in self.emulator.sets if s.startswith("outputs.gige.serial"))
        return text.replace("127.0.77.1", self.address).replace("test-camera-W1", "test-camera-" + serial)

    def test_the_documents_lines_for_a_shell_print_what_it_says(self):
        program = tool("arv-tool")
        if program is None:
            self.skipTest("arv-tool is missing")
        sessions = re.findall(r"^    \$ arv-tool-0.8(.*)\n((?:    [^$].*\n)+)", self.documented(), re.M)
        self.assertGreaterEqual(len(sessions), 6)
        for arguments, printed in sessions:
            result = subprocess.run([program, *arguments.split()], capture_output=True, text=True, timeout=60)
            expected = [line.strip() for line in printed.splitlines()]
            found = [line.strip() for line in result.stdout.splitlines()]
            # Without an address it lists the cameras of other tests, too.
            self.assertEqual([line for line in found if line in expected], expected, arguments + result.stdout + result.stderr)

    def test_the_documents_program_reads_chunks(self):
        try:
            import gi
            gi.require_version("Aravis", "0.8")
        except (ImportError, ValueError) as error:
            self.skipTest(str(error))
        program, = re.findall(r"```python\n(.*?)```", self.documented(), re.S)
        for _ in range(10):  # a frame that a busy client loses is left out
            result = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, timeout=60)
            self.assertEqual(result.returncode, 0, result.stderr)
            lines = [line.split() for line in result.stdout.splitlines()]
            if len(lines) == 3:
                break
        self.assertEqual(len(lines), 3)
        for before, after in zip(lines, lines[1:]):
            frames, time_ns = int(after[0]) - int(before[0]), int(after[3]) - int(before[3])
            self.assertAlmostEqual(time_ns, frames * 1e9 / 30, delta=1e5)
            self.assertEqual(float(after[1]), 150)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[2:]], verbosity=2)
