"""Makes the package's wheel and source archive for pip (PEP 517), with Python's own library alone.

What `hilcam/` holds goes in as it is; links are followed. The version is that of hilcam/__init__.py. Two wheels of the same files have the
same bytes.
"""
import base64
import hashlib
import io
import pathlib
import re
import tarfile
import zipfile

HERE = pathlib.Path(__file__).resolve().parent
TAG = "py3-none-any"


def version():
    return re.search(r'^__version__ = "([^"]+)"$', (HERE / "hilcam/__init__.py").read_text(), re.MULTILINE)[1]


def metadata():
    return (f"Metadata-Version: 2.1\nName: hilcam\nVersion: {version()}\n"
            "Summary: Benches, commands, truth and campaigns of hilcam, a spacecraft camera for the test bench\n"
            "Requires-Python: >=3.9\nProvides-Extra: arrays\nRequires-Dist: numpy ; extra == 'arrays'\n")


def package_files():
    """The package's files by their names in a wheel."""
    files = sorted(p for p in (HERE / "hilcam").iterdir() if p.suffix == ".py" or p.name == "py.typed")
    return {f"hilcam/{p.name}": p.read_bytes() for p in files}


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    info = f"hilcam-{version()}.dist-info"
    files = package_files()
    files[f"{info}/METADATA"] = metadata().encode()
    files[f"{info}/WHEEL"] = f"Wheel-Version: 1.0\nGenerator: wheel_of_hilcam\nRoot-Is-Purelib: true\nTag: {TAG}\n".encode()
    rows = []
    for name, content in files.items():
        digest = base64.urlsafe_b64encode(hashlib.sha256(content).digest()).rstrip(b"=").decode()
        rows.append(f"{name},sha256={digest},{len(content)}\n")
    files[f"{info}/RECORD"] = "".join([*rows, f"{info}/RECORD,,\n"]).encode()
    wheel = f"hilcam-{version()}-{TAG}.whl"
    with zipfile.ZipFile(pathlib.Path(wheel_directory) / wheel, "w", zipfile.ZIP_DEFLATED) as out:
        for name, content in files.items():
            entry = zipfile.ZipInfo(name)
            entry.external_attr, entry.compress_type = 0o644 << 16, zipfile.ZIP_DEFLATED
            out.writestr(entry, content)
    return wheel


def build_sdist(sdist_directory, config_settings=None):
    top = f"hilcam-{version()}"
    files = {**package_files(), "PKG-INFO": metadata().encode()}
    for name in ("pyproject.toml", "README.md", pathlib.Path(__file__).name):
        files[name] = (HERE / name).read_bytes()
    with tarfile.open(pathlib.Path(sdist_directory) / f"{top}.tar.gz", "w:gz") as out:
        for name, content in files.items():
            entry = tarfile.TarInfo(f"{top}/{name}")
            entry.size = len(content)
            out.addfile(entry, io.BytesIO(content))
    return f"{top}.tar.gz"
