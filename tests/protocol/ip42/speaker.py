"""42 as its socket speaks (Source/AutoCode/TxRxIPC.c, Source/42ipc.c): one message of lines for each step, then it stands still until the four
bytes "Ack\\0" have come.
"""
import datetime
import socket
import time


def numbers(values):
    return "[" + " ".join(f"{value:18.12e}" for value in values) + "]"


def time_line(when):
    """when: a datetime, UTC."""
    return f"TIME {when.year}-{when.timetuple().tm_yday:03}-{when:%H:%M}:{when.second + when.microsecond / 1e6:012.9f}\n"


def spacecraft(number, position, velocity=(0, 0, 0), bodies=(((0, 0, 0, 1), (0, 0, 0)),), sun=(1, 0, 0)):
    """position, velocity: from the reference orbit; bodies: attitude (scalar last) and rate of each."""
    name = f"SC[{number}]"
    lines = [f"{name}.qn = {numbers(bodies[0][0])}", f"{name}.wn = {numbers(bodies[0][1])}", f"{name}.PosR = {numbers(position)}",
             f"{name}.VelR = {numbers(velocity)}"]
    if sun:
        lines.append(f"{name}.svb = {numbers(sun)}")
    lines += [f"{name}.bvb = {numbers((1e-5, 0, 0))}", f"{name}.Hvb = {numbers((0, 0, 0))}"]
    for k, (attitude, rate) in enumerate(bodies):
        lines += [f"{name}.B[{k}].wn = {numbers(rate)}", f"{name}.B[{k}].qn = {numbers(attitude)}"]
    return "\n".join(lines) + "\n"


def orbit(number, position, velocity):
    return f"Orb[{number}].PosN = {numbers(position)}\nOrb[{number}].VelN = {numbers(velocity)}\n"


class Speaker:
    """Connects to a port (CLIENT in Inp_IPC.txt), or listens at it for one peer (SERVER)."""

    def __init__(self, port, serves=False, patience_s=30):
        if serves:
            with socket.create_server(("127.0.0.1", port)) as listener:
                listener.settimeout(patience_s)
                self.socket, _ = listener.accept()
        else:
            end = time.monotonic() + patience_s
            while True:
                try:
                    self.socket = socket.create_connection(("127.0.0.1", port))
                    break
                except ConnectionRefusedError:
                    if time.monotonic() > end:
                        raise
                    time.sleep(0.05)
        self.socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        self.socket.settimeout(60)

    def step(self, text, end="[ENDMSG]\n"):
        """The seconds for which 42 stood still."""
        begun = time.monotonic()
        self.socket.sendall((text + end).encode())
        answer = b""
        while len(answer) < 4:
            more = self.socket.recv(4 - len(answer))
            if not more:
                raise ConnectionError("hilcam closed the connection")
            answer += more
        assert answer == b"Ack\0", answer
        return time.monotonic() - begun

    def close(self):
        self.socket.close()


EPOCH = datetime.datetime(2026, 3, 20, 14, 0, 0)


def after(seconds):
    return EPOCH + datetime.timedelta(seconds=seconds)
