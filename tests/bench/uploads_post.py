"""A Command Post that accepts all requests, PORT: prints a line for each request with a body: the monotonic times of its first and
last byte, and its size."""

import re
import socket
import sys
import threading
import time

REPLY = b"HTTP/1.1 200 OK\r\nContent-Type: application/json\r\nContent-Length: 4\r\n\r\nnull"
PIECE = bytearray(1 << 20)
said = threading.Lock()


def serve(connection):
    came = b""
    while True:
        while b"\r\n\r\n" not in came:
            some = connection.recv(65536)
            if not some:
                return
            came += some
        first = time.monotonic()
        head, _, came = came.partition(b"\r\n\r\n")
        length = re.search(rb"content-length: *(\d+)", head, re.IGNORECASE)
        size = int(length[1]) if length else 0
        left = size - len(came)
        while left > 0:
            took = connection.recv_into(PIECE, min(left, len(PIECE)))
            if not took:
                return
            left -= took
        came = b""
        if size:
            with said:
                print(first, time.monotonic(), size, flush=True)
        connection.sendall(REPLY)


listener = socket.create_server(("127.0.0.1", int(sys.argv[1])))
while True:
    connected = listener.accept()[0]
    connected.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
    threading.Thread(target=serve, args=(connected,), daemon=True).start()
