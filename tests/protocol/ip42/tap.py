"""Stands between 42 and hilcam, passes everything on, and keeps what it sees: 42's messages, and how long 42 waited for each answer."""
import socket
import threading
import time


class Tap:
    def __init__(self, hilcam_port):
        self.messages, self.held_s = [], []
        self.listener = socket.create_server(("127.0.0.1", 0))
        self.port = self.listener.getsockname()[1]
        self.hilcam_port = hilcam_port
        self.thread = threading.Thread(target=self.run, daemon=True)
        self.thread.start()

    def run(self):
        near, _ = self.listener.accept()
        far = socket.create_connection(("127.0.0.1", self.hilcam_port))
        for end in (near, far):
            end.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        text = b""
        while True:
            more = near.recv(65536)
            if not more:
                break
            text += more
            far.sendall(more)
            if not text.endswith(b"[ENDMSG]\n") and not text.endswith(b"[EOF]\n"):
                continue
            begun = time.monotonic()
            answer = b""
            while len(answer) < 4:
                answer += far.recv(4 - len(answer)) or b"gone"
            near.sendall(answer)
            self.held_s.append(time.monotonic() - begun)
            self.messages.append(text.decode())
            text = b""
        far.close()
        near.close()
        self.listener.close()
