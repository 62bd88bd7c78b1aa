"""Below the messages: HTTP, connections, signals, the command line, and bytes of broken peers."""

import contextlib
import email.utils
import json
import os
import random
import signal
import struct
import subprocess
import threading
import time
import unittest

import cbor2

from command_post import MAPPING_TOKEN, SCORING_TOKEN, CommandPost, cloud, connect, grid, marker, read_answer, state
from patience import wait_until

STATUS = f"GET /api/status HTTP/1.1\r\nHost: here\r\nAuthorization: Bearer {SCORING_TOKEN}\r\n\r\n".encode()


def map_header(length, *headers):
    return "\r\n".join([f"POST /map/update HTTP/1.1\r\nHost: here\r\nAuthorization: Bearer {MAPPING_TOKEN}",
                        "Content-Type: application/cbor", length, *headers]).encode() + b"\r\n\r\n"


class Http(unittest.TestCase):
    def test_connections_stay_open_and_take_pipelined_requests(self):
        with CommandPost() as post, connect(post.scoring) as stream:
            for _ in range(3):
                stream.sendall(STATUS)
                self.assertEqual(read_answer(stream)[0], 200)
            stream.sendall(STATUS + STATUS.replace(b"\r\n\r\n", b"\r\nConnection: close\r\n\r\n"))
            received = b""
            while piece := stream.recv(65536):
                received += piece
            self.assertEqual(received.count(b"HTTP/1.1 200 OK\r\n"), 2)
            self.assertIn(b"Connection: close", received)

    def test_serial_endpoint_serves_the_next_connection_after_the_end_of_the_one_before(self):
        with CommandPost("--serial", transcript=True) as post, connect(post.scoring) as first, connect(post.scoring) as second:
            second.sendall(STATUS)
            for count in range(1, 5):
                first.sendall(STATUS)
                self.assertEqual(read_answer(first)[0], 200)
                self.assertEqual(len(post.lines()), count)
            first.close()
            self.assertEqual(read_answer(second)[0], 200)

    def test_each_answer_has_a_date(self):
        with CommandPost() as post:
            for request in (STATUS, STATUS.replace(b"Authorization", b"Nobody"), STATUS.replace(b"status", b"nothing")):
                with connect(post.scoring) as stream:
                    before = int(time.time())
                    stream.sendall(request)
                    status, headers, _ = read_answer(stream)
                    told = email.utils.parsedate_to_datetime(headers["date"])
                    self.assertRegex(headers["date"], r"^[A-Z][a-z]{2}, \d\d [A-Z][a-z]{2} \d{4} \d\d:\d\d:\d\d GMT$")
                    self.assertTrue(before <= told.timestamp() <= time.time(), (status, headers))

    def test_expect_is_answered_before_the_body_is_there(self):
        body = cbor2.dumps(grid(cbor=True))
        with CommandPost() as post, connect(post.mapping) as stream:
            stream.sendall(map_header(f"Content-Length: {len(body)}", "Expect: 100-continue"))
            self.assertEqual(stream.recv(1000), b"HTTP/1.1 100 Continue\r\n\r\n")
            stream.sendall(body)
            self.assertEqual(read_answer(stream)[0], 200)

    def test_chunked_bodies_a_byte_at_a_time(self):
        body = cbor2.dumps(grid(cbor=True))
        chunks = b"".join(b"%x\r\n%s\r\n" % (len(part), part) for part in (body[:7], body[7:])) + b"0\r\n\r\n"
        with CommandPost() as post, connect(post.mapping) as stream:
            for byte in map_header("Transfer-Encoding: chunked") + chunks:
                stream.sendall(bytes([byte]))
            self.assertEqual(read_answer(stream)[::2], (200, b"null"))

    def test_a_large_map_arrives(self):
        data = struct.pack("<3f", 1, 2, -3) * 2_000_000
        with CommandPost() as post:
            self.assertEqual(post.map_cbor(cloud(data=data, cbor=True)).status_code, 200)

    def test_announced_length_allocates_no_memory(self):
        def data_of(post):
            with open(f"/proc/{post.process.pid}/status", encoding="ascii") as file:
                return next(int(line.split()[1]) * 1024 for line in file if line.startswith("VmData:"))

        with CommandPost() as post, contextlib.ExitStack() as streams:
            before = data_of(post)
            for _ in range(20):
                stream = streams.enter_context(connect(post.mapping))
                stream.sendall(map_header(f"Content-Length: {250 << 20}", "Expect: 100-continue"))
                self.assertEqual(stream.recv(1000), b"HTTP/1.1 100 Continue\r\n\r\n")
                stream.sendall(b"\xa1")
            self.assertLess(data_of(post) - before, 1 << 30, "a stack of 8 MiB each, but not 250 MiB")
            for length in (30_000_000_000, 2**64):
                with connect(post.mapping) as stream:
                    stream.sendall(map_header(f"Content-Length: {length}"))
                    self.assertIn(read_answer(stream)[0], (400, 413))
            self.assertEqual(post.map(grid()).status_code, 200)

    def test_malformed_http_is_answered_and_closed(self):
        table = [(400, b"hello\r\n\r\n"), (400, b"\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03\r\n\r\n"),
                 (400, b"GET /api/status HTTP/9.9\r\n\r\n"), (400, b"GET  HTTP/1.1\r\n\r\n"),
                 (400, STATUS[:-2] + b"Content-Length: x\r\n\r\n"),
                 (431, STATUS[:-2] + b"X: " + b"x" * 20_000 + b"\r\n\r\n"),
                 (413, b"POST /api/artifact_reports HTTP/1.1\r\nContent-Length: 99999999999\r\n\r\n")]
        with CommandPost() as post:
            for status, sent in table:
                with self.subTest(sent=sent[:40]), connect(post.scoring) as stream:
                    stream.sendall(sent)
                    answer = read_answer(stream)
                    self.assertEqual((answer[0], answer[1]["connection"]), (status, "close"))
                    self.assertIsInstance(json.loads(answer[2]), str)
                    self.assertEqual(stream.recv(1), b"")

    def test_missing_and_repeated_fields_are_violations(self):
        host, token = b"Host: here\r\n", b"Authorization: Bearer " + SCORING_TOKEN.encode() + b"\r\n"
        table = [("Host: missing (RFC 9112 3.2)", STATUS.replace(host, b"")),
                 ("Host: given twice (RFC 9110 5.3)", STATUS.replace(host, host * 2)),
                 ("Authorization: given twice (RFC 9110 5.3)", STATUS.replace(token, token * 2)),
                 ("Origin: given twice (RFC 9110 5.3)", STATUS.replace(host, host + b"Origin: null\r\nOrigin: http://here\r\n"))]
        for sentence, sent in table:
            with self.subTest(sentence), CommandPost() as post, connect(post.scoring) as stream:
                stream.sendall(sent)
                status, _, body = read_answer(stream)
                self.assertEqual((status, json.loads(body)), (400, sentence))
                self.assertEqual([each["sentence"] for each in post.record()["violations"]], [sentence])
        with CommandPost() as post, connect(post.scoring) as stream:
            stream.sendall(STATUS.replace(host, b"").replace(b"HTTP/1.1", b"HTTP/1.0"))
            self.assertEqual(read_answer(stream)[0], 200)

    def test_aborted_request_is_recorded_but_not_answered(self):
        with CommandPost() as post:
            with connect(post.mapping) as stream:
                stream.sendall(map_header("Content-Length: 100") + b"\xa3")
            wait_until(lambda: post.record()["requests"], "it to be noted")
            record = post.record()
            self.assertEqual(record["requests"], [{"uri": "(others)", "status": 0, "count": 1}])
            self.assertEqual(record["violation_count"], 0)

    def test_absolute_targets_and_queries(self):
        with CommandPost() as post, connect(post.scoring) as stream:
            stream.sendall(STATUS.replace(b"/api/status", b"http://command-post/api/status?verbose=1"))
            self.assertEqual(read_answer(stream)[0], 200)

    def test_random_bytes_do_not_crash_it(self):
        chance = random.Random(20210401)
        messages = [cbor2.dumps(message) for message in (grid(cbor=True, compression="gzip"), cloud(cbor=True),
                                                         state("X1", "X2"), marker())]
        paths = ["/map/update", "/map/update", "/state/update", "/markers/update"]
        with CommandPost() as post:
            for _ in range(400):
                which = chance.randrange(4)
                body = bytearray(messages[which])
                for _ in range(chance.randint(1, 4)):
                    place = chance.randrange(len(body))
                    body[place:place + chance.randint(0, 2)] = chance.randbytes(chance.randint(0, 3))
                answer = post.mapping_request("POST", paths[which], bytes(body), {"Content-Type": "application/cbor"})
                self.assertIn(answer.status_code, (200, 400, 422))
            for _ in range(50):
                with connect(post.mapping) as stream:
                    stream.sendall(chance.randbytes(200))
            self.assertEqual(post.map(grid()).status_code, 200)

    def test_many_connections_at_once(self):
        with CommandPost() as post:
            idle = [connect(post.scoring) for _ in range(60)]
            statuses = []
            threads = [threading.Thread(target=lambda: statuses.append(post.map(grid()).status_code))
                       for _ in range(20)]
            for thread in threads:
                thread.start()
            for thread in threads:
                thread.join()
            self.assertEqual(statuses, [200] * 20)
            self.assertEqual(post.status().status_code, 200)
            flood = [connect(post.scoring) for _ in range(200)]
            for stream in idle + flood:
                stream.close()
            status = wait_until(lambda: post.status().status_code, "room again after a flood of connections", tolerates=OSError)
            self.assertEqual(status, 200)


class Process(unittest.TestCase):
    def test_stops_at_once_during_requests(self):
        for how in (signal.SIGTERM, signal.SIGINT):
            with CommandPost() as post:
                open_streams = [connect(post.scoring), connect(post.mapping)]
                open_streams[1].sendall(map_header("Content-Length: 1000000") + b"\xa3")
                begun = time.monotonic()
                code, out, _ = post.stop(how)
                self.assertEqual(code, 0)
                self.assertLess(time.monotonic() - begun, 30, "it has 60 s for a connection that sends nothing")
                self.assertIn("violations of the ICD: 0", out)
                for stream in open_streams:
                    stream.close()

    def test_sigusr1_prints_the_summary_and_goes_on(self):
        with CommandPost() as post:
            post.map(grid(name="X1"))
            post.report({"x": 1, "y": 2, "z": 3, "type": "Drill"})
            post.process.send_signal(signal.SIGUSR1)
            lines = [post.process.stdout.readline() for _ in range(8)]
            self.assertIn("  /map/update: 200 x 1\n", lines)
            self.assertIn("  grid X1: 1\n", lines)
            self.assertIn("reports: 1, score 0, 44 remaining\n", lines)
            self.assertEqual(post.status().status_code, 200)

    def test_verbose_prints_each_request_but_no_token(self):
        with CommandPost("--verbose") as post:
            post.map(grid(name="X1"))
            post.mapping_request("POST", "/map/update", grid(), {"Authorization": "Bearer wrong-token-123"})
            _, out, err = post.stop()
            self.assertIn('"POST /map/update grid X1": 200\n', out)
            self.assertIn('"POST /map/update": 401', out)
            for text in (out, err):
                for token in (MAPPING_TOKEN, SCORING_TOKEN, "wrong-token-123"):
                    self.assertNotIn(token, text)

    def test_wrong_use_is_explained_and_exits_2(self):
        with CommandPost() as post:
            good = post.command[1:]
            bad_csv = post.write("bad.csv", "type,x,y,z\nDrill,1,2,3\nSpoon,1,2,3\n")
            no_secrets = os.path.join(post.folder.name, "none")
            table = [
                (["--as-measure"], "unknown word '--as-measure'"), (["--team"], "--team wants a value"),
                (["--mapping", "here:1"], "mapping: here:1: not a numeric address"),
                (["--mapping", post.mapping], f"mapping: {post.mapping}: Address already in use"),
                (["--scoring", "127.0.0.1"], "--scoring: expected ADDR:PORT, got '127.0.0.1'"),
                (["--rate", "-1"], "--rate: expected 0 to 1e+09, got '-1'"), (["--duration", "nan"], "--duration: expected"),
                (["--secrets", no_secrets], "none/scoring.token: cannot be read"),
                (["--artifacts", bad_csv], "bad.csv:3: expected an artifact type"),
                (["--transcript", "/proc/none"], "/proc/none"),
            ]
            for more, sentence in table:
                with self.subTest(more=more):
                    done = subprocess.run([post.command[0], *good, *more], capture_output=True, text=True, timeout=30,
                                          check=False)
                    self.assertEqual(done.returncode, 2)
                    self.assertIn(sentence, done.stderr)

    def test_ipv6(self):
        with CommandPost("--control", "[::1]:0") as post:
            self.assertRegex(post.control, r"^\[::1\]:\d+$")
            self.assertEqual(post.record()["state"], "running")
