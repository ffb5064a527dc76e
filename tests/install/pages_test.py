#!/usr/bin/python3
"""Manual pages and completion as people use them: man reads the pages without a warning, and bash completes by them.

    pages_test.py HILCAM PAGES SOURCE
"""
import os
import pathlib
import shutil
import subprocess
import sys
import unittest

HILCAM, PAGES, SOURCE = sys.argv[1], pathlib.Path(sys.argv[2]), pathlib.Path(sys.argv[3])


def output_of(*words, **more):
    return subprocess.run(words, capture_output=True, text=True, check=True, **more).stdout


def completed(line):
    """What bash offers for the last word of a line."""
    script = f"""
        source {PAGES}/hilcam.bash
        PATH={pathlib.Path(HILCAM).parent}:$PATH
        COMP_WORDS=({line.replace(' _', ' ""')})
        COMP_CWORD=$(( ${{#COMP_WORDS[@]}} - 1 ))
        _hilcam
        printf '%s\\n' "${{COMPREPLY[@]}}" """
    return output_of("bash", "-u", "-c", script, cwd=SOURCE / "configs").split()


class Pages(unittest.TestCase):
    @unittest.skipUnless(shutil.which("man"), "man is not installed")
    def test_man_reads_every_page_without_a_warning(self):
        pages = sorted(PAGES.glob("*.1"))
        self.assertGreater(len(pages), 10)
        for page in pages:
            result = subprocess.run(["man", "--warnings", "-E", "UTF-8", "-l", "-Tutf8", "-Z", page], capture_output=True, text=True,
                                    env=os.environ | {"LC_ALL": "C.UTF-8", "MANROFFSEQ": "", "MANWIDTH": "100"})
            self.assertEqual((result.returncode, result.stderr), (0, ""), page.name)

    def test_every_subcommand_has_a_page_with_its_options(self):
        for command in completed("hilcam _"):
            page = (PAGES / f"hilcam-{command}.1").read_text().replace("\\-", "-")
            for option in completed(f"hilcam {command} -"):
                self.assertIn(f"\\fB{option}\\fR", page, command)
            self.assertIn(f"hilcam-{command} (1)", (PAGES / "hilcam.1").read_text().replace("\\-", "-"))
        self.assertNotIn("make-pages", completed("hilcam _"))

    @unittest.skipUnless(shutil.which("man"), "man is not installed")
    def test_a_page_reads_as_the_help_does(self):
        text = output_of("man", "-l", str(PAGES / "hilcam-run.1"), env=os.environ | {"MANWIDTH": "200", "LC_ALL": "C"})
        self.assertIn("hilcam-run - be the camera, in real time", text)
        self.assertIn("--preview N", text)
        self.assertIn("accepted: 1 to 65535", text)
        text = output_of("man", "-l", str(PAGES / "hilcam-send.1"), env=os.environ | {"MANWIDTH": "200", "LC_ALL": "C"})
        self.assertIn("hilcam send pose --position-m NUMBER NUMBER NUMBER [OPTION]...", text)


class Completion(unittest.TestCase):
    def test_subcommands(self):
        self.assertEqual(completed("hilcam ch"), ["check", "characterise"])
        self.assertIn("pose", completed("hilcam send _"))
        self.assertEqual(completed("hilcam send --to tcp:127.0.0.1:5010 pos"), ["pose"])

    def test_options(self):
        self.assertEqual(completed("hilcam render --st"), ["--stage"])
        self.assertIn("--look-at-m", completed("hilcam send pose --l"))
        self.assertEqual(completed("hilcam render --stage ra"), ["radiance"])
        self.assertEqual(completed("hilcam send lamp o"), ["on", "off"])
        self.assertEqual(completed("hilcam run --duration _"), [])

    def test_keys_and_faults(self):
        self.assertEqual(completed("hilcam run --set camera.shutter.li"), ["camera.shutter.line_time_us="])
        self.assertEqual(completed("hilcam run --set objects.0.mes"), ["objects.0.mesh=", "objects.0.mesh_surface="])
        self.assertEqual(completed("hilcam manual camera.shutter.li"), ["camera.shutter.line_time_us"])
        self.assertEqual(completed("hilcam send fault packet_dr"), ["packet_drop"])
        self.assertIn("clear", completed("hilcam send fault _"))

    def test_files_and_names_of_shipped_ones(self):
        self.assertEqual(completed("hilcam check lor"), ["lorri"])
        self.assertIn("geo_inspection", completed("hilcam run _"))
        self.assertEqual(completed("hilcam run geo_"), ["geo_inspection"])
        self.assertEqual(completed("hilcam characterise lor"), ["lorri"])
        self.assertEqual(completed("hilcam render scenarios/sm"), ["scenarios/small.yaml"])
        self.assertEqual(completed("hilcam run --report qual"), ["quality"])
        self.assertIn("geo_inspection", completed("hilcam run --duration 3 _"))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
