"""What the programs that make pages with plots (tools/hilcam-plot-*) have in common, for their tests."""
import os
import shutil
import subprocess


def has_matplotlib():
    return subprocess.run(["/usr/bin/python3", "-c", "import matplotlib"], capture_output=True).returncode == 0


def stands_alone(test, page):
    for forbidden in ("<script", "<link", "<img"):
        test.assertNotIn(forbidden, page)


def page_without_matplotlib(test, program, made, folder):
    """Makes the page of `made` again, in `folder`, where Matplotlib is missing; gives the page."""
    shutil.copytree(made, folder, ignore=shutil.ignore_patterns("*.svg", "*.html"))
    hidden = folder / "hidden"
    hidden.mkdir()
    (hidden / "matplotlib.py").write_text("raise ImportError('hidden')\n")
    result = subprocess.run([program, folder], capture_output=True, text=True, timeout=60,
                            env={**os.environ, "PYTHONPATH": str(hidden)})
    test.assertEqual(result.returncode, 0, result.stderr)
    test.assertRegex(result.stderr, "Matplotlib is missing: no plots? (is|are) made; install python3-matplotlib")
    test.assertEqual(list(folder.glob("*.svg")), [])
    return (folder / "index.html").read_text()
