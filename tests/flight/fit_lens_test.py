#!/usr/bin/python3
"""tools/fit_lens.py: a law of its own form comes back, one of another form to what it says, and what is no table is refused.

    fit_lens_test.py SOURCE_DIR
"""
import pathlib
import subprocess
import sys
import tempfile
import unittest

import numpy

SOURCE_DIR = pathlib.Path(sys.argv.pop(1)).resolve()
TOOL = SOURCE_DIR / "tools/fit_lens.py"


def fit_lens(text, *options):
    """Runs the tool on a table; returns (status, lists of terms, standard error)."""
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder) / "table.txt"
        path.write_text(text)
        run = subprocess.run([sys.executable, TOOL, path, *options], capture_output=True, text=True, check=False)
    terms = [[float(word) for word in line.split("[")[1].strip("]").split(",")] for line in run.stdout.splitlines()]
    return run.returncode, terms, run.stderr


def table(law, reach_mm=6):
    """Lines of a grid of places and of where a law has them."""
    places = [(x, y) for x in numpy.linspace(-reach_mm, reach_mm, 15) for y in numpy.linspace(-reach_mm, reach_mm, 15)]
    return "# mm\n" + "\n".join(f"{x:.12g}, {y:.12g} {' '.join(f'{v:.15g}' for v in law(x, y))}" for x, y in places)


class FitLens(unittest.TestCase):
    def test_a_polynomial_comes_back(self):
        status, (x, y), said = fit_lens(table(lambda x, y: (x + 0.1 + 2e-3 * x * y - 3e-5 * y**3, y - 4e-3 * x + 1e-6 * x**4 * y)), "--pitch-um", "5")
        self.assertEqual(status, 0, said)
        self.assertEqual((len(x), len(y)), (21, 21))
        expected = {"x": {0: 0.1, 4: 2e-3, 9: -3e-5}, "y": {1: -4e-3, 16: 1e-6}}
        for name, terms in (("x", x), ("y", y)):
            for i, term in enumerate(terms):
                self.assertAlmostEqual(term, expected[name].get(i, 0), delta=1e-11, msg=f"{name}[{i}]")

    def test_what_another_form_leaves_is_said(self):
        status, (x, _), said = fit_lens(table(lambda x, y: (x * (1 + 1e-3 * (x * x + y * y)), y * (1 + 1e-3 * (x * x + y * y)))), "--order", "2", "--pitch-um", "10")
        self.assertEqual((status, len(x)), (0, 6))
        # At the corner: 432 um of the cubic, of which a plane takes the part of its least squares.
        left_px = float(said.split("(")[1].split(" px")[0])
        self.assertGreater(left_px, 5)
        self.assertLess(left_px, 43.2 * 2**0.5)

    def test_what_is_no_table_is_refused(self):
        for text, options, message in (
            ("1 2 3 4\n1 2 3\n", (), "line 2: found '1 2 3'; accepted: four numbers"),
            ("1 2 3 nan\n", (), "line 1: found '1 2 3 nan'"),
            ("one two 3 4\n", (), "line 1: found 'one two 3 4'"),
            ("0 0 0 0\n", (), "found 1 places; accepted: at least 21 for order 5"),
            ("1 1 1 1\n" * 30, ("--order", "1"), "do not tell the terms of order 1 apart"),
        ):
            status, terms, said = fit_lens(text, *options)
            self.assertEqual((status, terms), (1, []))
            self.assertIn(message, said)
            self.assertNotIn("Traceback", said)


if __name__ == "__main__":
    unittest.main()
