"""Two network namespaces with a veth pair between them: the camera's machine and the client's, and a wire that loses packets.

Needs root (or an equal right), iproute2 and nftables; open() raises NotHere with a message where they are missing.
"""
import os
import re
import shutil
import subprocess

CAMERA, CLIENT = "10.23.0.1", "10.23.0.2"


class NotHere(Exception):
    pass


def command(*arguments, **options):
    return subprocess.run(arguments, capture_output=True, text=True, timeout=120, **options)


class Wire:
    def __init__(self):
        self.here, self.there = f"hilcam-cam-{os.getpid()}", f"hilcam-cli-{os.getpid()}"

    def open(self):
        if os.geteuid() != 0:
            raise NotHere("needs root: network namespaces")
        for program, package in (("ip", "iproute2"), ("nft", "nftables")):
            if shutil.which(program) is None:
                raise NotHere(f"{program} is not installed (Debian package {package})")
        try:
            for name in (self.here, self.there):
                self.must("ip", "netns", "add", name)
            self.must("ip", "link", "add", "hcam0", "netns", self.here, "type", "veth", "peer", "name", "hcli0", "netns",
                      self.there)
            for name, device, address in ((self.here, "hcam0", CAMERA), (self.there, "hcli0", CLIENT)):
                self.must("ip", "-n", name, "addr", "add", address + "/24", "brd", "+", "dev", device)
                self.must("ip", "-n", name, "link", "set", device, "up")
                self.must("ip", "-n", name, "link", "set", "lo", "up")
            # Aravis asks 255.255.255.255, which needs a way out.
            self.must("ip", "-n", self.there, "route", "add", "default", "dev", "hcli0")
        except NotHere:
            self.close()
            raise
        return self

    def close(self):
        for name in (self.here, self.there):
            command("ip", "netns", "del", name)

    def __enter__(self):
        return self.open()

    def __exit__(self, *_):
        self.close()

    @staticmethod
    def must(*arguments, **options):
        result = command(*arguments, **options)
        if result.returncode != 0:
            raise NotHere(f"{' '.join(arguments)}: {result.stderr.strip()}")
        return result.stdout

    def at_camera(self, *arguments, **options):
        return command("ip", "netns", "exec", self.here, *arguments, **options)

    def at_client(self, *arguments, **options):
        return command("ip", "netns", "exec", self.there, *arguments, **options)

    def lose(self, one_in):
        """One in so many stream packets, on their way out of the camera's machine: behind its socket, as on a wire."""
        rules = ('table netdev hilcam {\n chain out {\n type filter hook egress device "hcam0" priority 0\n'
                 f" udp sport != 3956 numgen random mod {one_in} == 0 counter drop\n }}\n}}\n")
        result = self.at_camera("nft", "-f", "-", input=rules)
        if result.returncode != 0:
            raise NotHere("this kernel's nftables cannot drop at egress: " + result.stderr.strip())

    def lost(self):
        return int(re.search(r"packets (\d+)", self.at_camera("nft", "list", "ruleset").stdout)[1])

    def lose_nothing(self):
        self.at_camera("nft", "flush", "ruleset")

    def cable(self, plugged):
        self.must("ip", "-n", self.here, "link", "set", "hcam0", "up" if plugged else "down")
