"""A Command Post that does as it is told, one word for each request to scoring: for what a well-behaved one never does.

    python3 scripted_post.py ADDRESS:PORT LOG WORD [WORD ...]

After the last word, every request is answered like "ok". Each request's method, path and body become a line of LOG.
"""

import json
import socket
import struct
import sys
import threading
import time

words = sys.argv[3:]
lock = threading.Lock()
reports = 0

STATUS = {"score": 0, "run_clock": 12.5, "remaining_reports": 20, "current_team": "adit"}


def read_request(peer):
    data = b""
    while b"\r\n\r\n" not in data:
        piece = peer.recv(65536)
        if not piece:
            return None
        data += piece
    head, _, rest = data.partition(b"\r\n\r\n")
    length = 0
    for line in head.split(b"\r\n")[1:]:
        name, _, value = line.partition(b":")
        if name.lower() == b"content-length":
            length = int(value)
    while len(rest) < length:
        rest += peer.recv(65536)
    method, path, _ = head.split(b"\r\n")[0].decode().split(" ")
    return method, path, rest.decode()


def answer(status, content, content_type="application/json", extra=""):
    return (f"HTTP/1.1 {status} X\r\nContent-Type: {content_type}\r\n{extra}Content-Length: {len(content)}\r\n\r\n"
            f"{content}").encode()


def recorded(content):
    global reports
    reports += 1
    report = json.loads(content)
    return json.dumps({"url": "http://<ipaddress>:<port>/api/artifact_reports/1", "id": reports, **report,
                       "submitted_datetime": "2021-09-24T00:00:00", "run_clock": 12.5, "team": "adit", "run": "1",
                       "report_status": "scored", "score_change": 0})


def do(word, peer, content):
    """Sends what the word asks for; False closes the connection."""
    if word == "ok":
        peer.sendall(answer(201, recorded(content)))
    elif word == "html500":
        peer.sendall(answer(500, "<html>Internal Server Error</html>", "text/html"))
    elif word == "html404":
        peer.sendall(answer(404, "<h1>Not Found</h1>", "text/html"))
    elif word == "422":
        peer.sendall(answer(422, json.dumps("Missing field: 'y'")))
    elif word == "detail401":
        peer.sendall(answer(401, json.dumps({"detail": "Invalid token."}), extra="WWW-Authenticate: Bearer\r\n"))
    elif word == "429":
        peer.sendall(answer(429, json.dumps("Too many requests")))
    elif word == "garbage":
        peer.sendall(b"\x00\x01\x02 no HTTP at all\r\n\r\n")
        return False
    elif word == "silence":
        time.sleep(30)
        return False
    elif word == "half":
        peer.sendall(answer(201, recorded(content))[:60])
        return False
    elif word == "close":
        return False
    elif word == "reset":
        peer.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
        return False
    elif word.startswith("slow"):
        time.sleep(float(word[4:]))
        peer.sendall(answer(201, recorded(content)))
    return True


def serve(peer):
    with peer:
        while request := read_request(peer):
            method, path, content = request
            with lock:
                with open(sys.argv[2], "a", encoding="utf-8") as log:
                    log.write(json.dumps([method, path, content]) + "\n")
                word = words.pop(0) if method == "POST" and words else "ok"
            if method == "GET":
                peer.sendall(answer(200, json.dumps(STATUS)))
            elif not do(word, peer, content):
                return


address, _, port = sys.argv[1].rpartition(":")
listener = socket.create_server((address, int(port)))
print("listening", flush=True)
while True:
    connection, _ = listener.accept()
    threading.Thread(target=serve, args=(connection,), daemon=True).start()
