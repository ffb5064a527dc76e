#!/usr/bin/python3
"""Makes a case for the simulator 42 from the sample files in its folder InOut: two spacecraft that meet in a low orbit (docs/42.md).

    make_case.py FOLDER_OF_42 [--name rendezvous] [--port 10001] [--serve] [--seconds 480]

Spacecraft 0 has the camera (+z of its body 0) and holds it along the orbit's velocity, its +y down to the Earth. Spacecraft 1 is 40 m ahead,
turns, and comes nearer; it has a wing on a joint (body 1), which turns, too. 42 connects to hilcam; with --serve, hilcam connects to 42.
"""
import argparse
import pathlib
import re
import shutil


def put(lines, comment, value, nth=0):
    """Gives the nth line whose comment (after the "!") has this text another value; the rest of the line is kept."""
    at = [k for k, line in enumerate(lines) if "!" in line and comment in line.split("!", 1)[1]]
    lines[at[nth]] = f"{value}   !{lines[at[nth]].split('!', 1)[1]}"


def edited(path, changes):
    lines = path.read_text().splitlines()
    for comment, value, *nth in changes:
        put(lines, comment, value, *nth)
    return lines


def write(path, lines):
    path.write_text("\n".join(lines) + "\n")


class Case:
    def __init__(self, home, name, port, serves, duration_s):
        """home: 42's folder. serves: 42 is the SERVER."""
        self.folder = pathlib.Path(home) / name
        shutil.copytree(pathlib.Path(home) / "InOut", self.folder, dirs_exist_ok=True)
        self.write_sim(duration_s)
        self.write_spacecraft()
        write(self.folder / "Inp_IPC.txt",
              ["<<<< 42: sockets >>>>", "1 ! number", "**** IPC 0", "TX ! mode", '"State00.42" ! file', f"{'SERVER' if serves else 'CLIENT'} ! role",
               f"localhost {port} ! host and port", "TRUE ! blocking", "FALSE ! echo", "2 ! prefixes", '"SC" ! 0', '"Orb" ! 1'])

    def write_sim(self, duration_s):
        sim = edited(self.folder / "Inp_Sim.txt",
                     [("Time Mode", "FAST"), ("Sim Duration", f"{duration_s} 0.1"), ("Graphics Front End", "FALSE"),
                      ("Date (UTC)", "03 20 2026"), ("Time (UTC)", "14 46 00.00"), ("Mars and its moons", "FALSE"), ("Number of Spacecraft", "2"), ("Input file for SC 0", "TRUE 0 SC_Eye.txt")])
        at = next(k for k, line in enumerate(sim) if "SC_Eye" in line)
        sim.insert(at + 1, "TRUE 0 SC_Target.txt ! second")
        write(self.folder / "Inp_Sim.txt", sim)
        write(self.folder / "Orb_LEO.txt",
              edited(self.folder / "Orb_LEO.txt", [("Periapsis & Apoapsis", "500.0 500.0"), ("Inclination", "52.0"), ("True Anomaly", "75.0"),
                                                   ("Formation Frame Fixed", "L"), ("Formation Origin expressed", "L")]))
        write(self.folder / "Inp_Cmd.txt",
              ["<<<< 42: commands >>>>", "0.0 Align SC[0].B[0] Primary Vector [0.0 0.0 1.0] with L-frame Vector [1.0 0.0 0.0]",
               "0.0 Align SC[0].B[0] Secondary Vector [0.0 1.0 0.0] with L-frame Vector [0.0 0.0 1.0]", "EOF"])

    def write_spacecraft(self):
        simple = self.folder / "SC_Simple.txt"
        # L-frame: x velocity, y minus the orbit's normal, z nadir. Body +z along x, +y along z.
        write(self.folder / "SC_Eye.txt",
              edited(simple, [("Flight Software", "INSTANT_FSW"), ("Orbit Prop", "ENCKE"), ("Ang Vel wrt", "LQL"), ("Ang Vel (deg/sec)", "0.0 0.0 0.0"),
                              ("Quaternion", "0.5 0.5 0.5 0.5")]))
        lines = edited(simple, [("Flight Software", "PASSIVE_FSW"), ("Orbit Prop", "ENCKE"), ("Pos wrt Formation", "40.0 -5.0 3.0"),
                                ("Vel wrt Formation", "-0.045 0.014 -0.030"), ("Ang Vel (deg/sec)", "0.3 0.5 2.0"), ("Number of Bodies", "2"),
                                ("Initial Rates", "1.0 0.0 0.0")])
        # A second body like the first, before the joints.
        begin = next(k for k, line in enumerate(lines) if re.search(r"Body 0 =", line))
        end = next(k for k, line in enumerate(lines) if k > begin and line.startswith("****"))
        second = [line.replace("Body 0", "Body 1") for line in lines[begin:end]]
        second = [line if "Mass" not in line or "mass center" in line else "1.0 ! Mass" for line in second]
        second = ["0.1 0.1 0.1 ! Moments" if "Moments of Inertia" in line else line for line in second]
        lines[end:end] = second
        write(self.folder / "SC_Target.txt", lines)

    def remove(self):
        shutil.rmtree(self.folder)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("home", help="42's own folder")
    parser.add_argument("--name", default="rendezvous")
    parser.add_argument("--port", type=int, default=10001)
    parser.add_argument("--serve", action="store_true", help="hilcam connects to 42")
    parser.add_argument("--seconds", type=float, default=480)
    options = parser.parse_args()
    Case(options.home, options.name, options.port, options.serve, options.seconds)
    print(f"now, in {options.home}: ./42 {options.name}")
