"""Gets the files that the catalogue is made from out of packages of Debian and npm, without installing them."""
import subprocess
import sys

DEBIAN = {"stellarium-data": "./usr/share/stellarium/stars/default/*", "kstars-data": "./usr/share/kstars/*stars.dat"}
TYCHO_INDEX = ("astrometry-data-tycho2-07-littleendian", "./usr/share/astrometry/*", "usr/share/astrometry/index-tycho2-07.littleendian.fits")
CELESTIAL = "d3-celestial"
CELESTIAL_VERSION = "0.7.35"


def run(command, folder):
    try:
        return subprocess.run(command, cwd=folder, check=True, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True).stdout
    except FileNotFoundError:
        sys.exit(f"{command[0]}: not installed; it is needed to get the packages that the catalogue is made from")
    except subprocess.CalledProcessError as error:
        sys.exit(f"{' '.join(command)}: {error.stderr.strip()}")


def extract(archive, pattern, folder):
    """Unpacks the members of a Debian package that match."""
    with subprocess.Popen(["dpkg-deb", "--fsys-tarfile", archive], stdout=subprocess.PIPE) as data:
        subprocess.run(["tar", "-x", "-C", folder, "--wildcards", pattern], stdin=data.stdout, check=True)


def obtain_debian(name, pattern, folder):
    """Downloads a package that the folder lacks, unpacks what matches, and returns its name and version."""
    if not list(folder.glob(f"{name}_*.deb")):
        run(["apt-get", "download", name], folder)
    archive = sorted(folder.glob(f"{name}_*.deb"))[-1]
    extract(archive, pattern, folder)
    return f"{name} {run(['dpkg-deb', '-f', str(archive), 'Version'], folder).strip()}"


def obtain(folder):
    """Gets 330 MB of packages; returns the folders of Stellarium and KStars, d3-celestial's file, and the versions."""
    versions = [obtain_debian(name, pattern, folder) for name, pattern in DEBIAN.items()]
    archive = folder / f"{CELESTIAL}-{CELESTIAL_VERSION}.tgz"
    if not archive.exists():
        run(["npm", "pack", f"{CELESTIAL}@{CELESTIAL_VERSION}"], folder)
    stars = "package/data/stars.14.json"
    run(["tar", "-xzf", str(archive), stars], folder)
    versions.append(f"{CELESTIAL} {CELESTIAL_VERSION}")
    share = folder / "usr/share"
    return share / "stellarium/stars/default", share / "kstars", folder / stars, versions


def obtain_tycho_index(folder):
    """Gets 90 MB; returns the index file and the package's version."""
    name, pattern, file = TYCHO_INDEX
    version = obtain_debian(name, pattern, folder)
    return folder / file, version
