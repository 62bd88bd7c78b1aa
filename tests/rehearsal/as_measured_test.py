"""The public test servers' measured behaviour, row by row."""

import gzip
import select
import time
import unittest
import zlib

import cbor2

from command_post import (DROP, MAPPING_TOKEN, SCORING_TOKEN, CommandPost, changed, cloud, connect, fields, grid,
                          marker, read_answer, state, two_at_once)

CBOR = {"Content-Type": "application/cbor"}
REPORT = {"x": 1, "y": 2, "z": 3, "type": "Drill"}


def raw_map(post, body, *headers, stream=None):
    """Posts on a bare connection, so that the test sees how it ends."""
    stream = stream or connect(post.mapping)
    lines = ["POST /map/update HTTP/1.1", "Host: here", f"Authorization: Bearer {MAPPING_TOKEN}",
             "Content-Type: application/cbor", f"Content-Length: {len(body)}", *headers]
    stream.sendall("\r\n".join(lines).encode() + b"\r\n\r\n" + body)
    return stream


class Mapping(unittest.TestCase):
    def test_each_row_of_the_table(self):
        packed = gzip.compress(cbor2.dumps(grid(cbor=True)))
        deflated = zlib.compress(cbor2.dumps(grid(cbor=True)))
        bare = deflated[2:-4]
        double = cloud(schema=fields(8, 8), point_step=24, data=bytes(48))
        mixed = cloud(schema=fields()[:2] + [{"name": "z", "offset": 8, "datatype": 8, "count": 1}], point_step=16,
                      data=bytes(32))
        turned = {"x": 0, "y": 0, "z": 0, "w": 0}
        lower = {"Authorization": f"bearer {MAPPING_TOKEN}"}
        table = [
            ("token in another case", 401, "/map/update", grid(), lower),
            ("charset", 422, "/map/update", grid(), {"Content-Type": "application/json; charset=utf-8"}),
            ("map without name", 422, "/map/update", changed(grid(), name=DROP), {}),
            ("map with an empty name", 200, "/map/update", changed(grid(), name=""), {}),
            ("state without header", 422, "/state/update", changed(state("X1"), header=DROP), {}),
            ("state with an empty header", 200, "/state/update", changed(state("X1"), header={}), {}),
            ("marker without ns", 422, "/markers/update", marker(ns=DROP), {}),
            ("marker without id", 422, "/markers/update", marker(id=DROP), {}),
            ("delete without pose", 422, "/markers/update", marker(action=2, pose=DROP), {}),
            ("marker without scale", 200, "/markers/update", marker(scale=DROP), {}),
            ("marker without color", 200, "/markers/update", marker(color=DROP), {}),
            ("lifetime as ROS has it", 200, "/markers/update", marker(lifetime={"secs": 1, "nsecs": 2}), {}),
            ("lifetime that is none", 200, "/markers/update", marker(lifetime="for ever"), {}),
            ("another frame", 200, "/map/update", changed(grid(), msg__header__frame_id="map"), {}),
            ("gzip around the body", 200, "/map/update", packed, {**CBOR, "Content-Encoding": "gzip"}),
            ("deflate around the body", 200, "/map/update", deflated, {**CBOR, "Content-Encoding": "deflate"}),
            ("bare deflate", 200, "/map/update", bare, {**CBOR, "Content-Encoding": "deflate"}),
            ("gzip that is none", 400, "/map/update", b"gzip", {**CBOR, "Content-Encoding": "gzip"}),
            ("an array of integers", 422, "/map/update", changed(grid(), msg__data=[0, 1, 2, 3, 4, 5]), {}),
            ("stamp as ROS has it", 422, "/map/update",
             changed(grid(), msg__header__stamp={"secs": 1, "nsecs": 2}), {}),
            ("negative stamp", 422, "/map/update", changed(grid(), msg__header__stamp=-1), {}),
            ("integer stamp", 200, "/map/update", changed(grid(), msg__header__stamp=3), {}),
            ("stamp that runs backward", 200, "/map/update", changed(grid(), msg__header__stamp=2), {}),
            ("too few cells", 422, "/map/update", grid(cells=bytes(5)), {}),
            ("cells over 100", 200, "/map/update", grid(cells=bytes([101, 254, 0, 0, 0, 0])), {}),
            ("resolution 0", 200, "/map/update", changed(grid(), msg__info__resolution=0), {}),
            ("quaternion of zeros", 200, "/map/update", changed(grid(), msg__info__origin__orientation=turned), {}),
            ("quaternion of length 2", 200, "/map/update", changed(grid(), msg__info__origin__orientation__w=2), {}),
            ("rows with padding", 200, "/map/update", changed(cloud(), msg__width=1, msg__row_step=16), {}),
            ("points that are no numbers", 200, "/map/update", cloud(data=b"\xff" * 24), {}),
            ("long name", 200, "/map/update", changed(grid(), name="a_very_long_name"), {}),
            ("cloud without z", 422, "/map/update", changed(cloud(), msg__fields=fields()[:2]), {}),
            ("x, y, z of two types", 422, "/map/update", mixed, {}),
            ("x, y, z of float64", 200, "/map/update", double, {}),
            ("part of a point", 200, "/map/update", cloud(data=bytes(25)), {}),
            ("no JSON", 400, "/map/update", b"{", {}),
        ]
        with CommandPost("--as-measured") as post:
            for what, status, path, body, headers in table:
                with self.subTest(what):
                    answer = post.mapping_request("POST", path, body, headers)
                    self.assertEqual((answer.status_code, answer.headers["Content-Type"]),
                                     (status, "application/json"))
                    if status == 200:
                        self.assertEqual(answer.text, "null")
                    else:
                        self.assertIsInstance(answer.json(), str)
            answer = post.map(grid(), Content_Type="text/plain")
            self.assertEqual((answer.status_code, answer.json()), (422, "Unknown Content-Type"))

    def test_forbidden_but_accepted_messages_are_violations(self):
        with CommandPost("--as-measured") as post:
            self.assertEqual(post.map(grid()).status_code, 200)
            self.assertEqual(post.map(changed(grid(), name=DROP)).status_code, 422)
            self.assertEqual(post.record()["violation_count"], 0, "the ICD has nothing against that")
            for body in (changed(grid(), msg__header__frame_id="map"), changed(grid(), msg__header__stamp=0.5),
                         cloud(data=bytes(25))):
                before = post.record()["violation_count"]
                self.assertEqual(post.map(body).status_code, 200)
                self.assertEqual(post.record()["violation_count"] - before, 1)

    def test_unknown_uris_and_methods_are_501_without_a_body(self):
        with CommandPost("--as-measured") as post:
            for method, path in (("POST", "/"), ("POST", "/map/update/"), ("GET", "/map/update"),
                                 ("OPTIONS", "/map/update"), ("POST", "/api/artifact_reports")):
                answer = post.mapping_request(method, path)
                self.assertEqual((answer.status_code, answer.content), (501, b""))

    def test_clouds_share_a_timer_and_are_accepted_early(self):
        with CommandPost("--as-measured", rate=None) as post:
            answers = []

            def send(name):
                answers.append(post.map(cloud(name=name)))
                return answers[-1]

            self.assertEqual(two_at_once(lambda: send("A"), lambda: send("B")), [200, 429])
            self.assertEqual(answers[-1].json(), "Cloud updates too frequent. Reduce to <1Hz.")
            for _ in range(3):
                self.assertEqual(post.map(grid()).status_code, 200)
            time.sleep(1.05)
            self.assertEqual(send("A").status_code, 200)
            counts = {part["robot"]: part["count"] for part in post.record()["accepted"]}
            tries = len(answers) // 2
            self.assertEqual(counts, {"A": tries + 1, "B": tries, "X1": 3})

    def test_rate_of_clouds_counts_from_their_decoding(self):
        large = cloud(data=bytes(24) * 150_000)  # 38 Mbit: 0.8 s on the link
        for counts, status in (((), 429), (("--counts", "starts"), 200)):
            with self.subTest(counts), CommandPost("--as-measured", "--link", "50", *counts, rate=None) as post:
                for _ in range(10):  # a busy machine may be late
                    began = time.monotonic()
                    post.map(large)
                    time.sleep(max(0.0, began + 1.35 - time.monotonic()))
                    answer = post.map(cloud())
                    if answer.status_code == status:
                        break
                    time.sleep(2)
                self.assertEqual(answer.status_code, status)

    def test_it_closes_after_a_4xx_despite_keep_alive(self):
        with CommandPost("--as-measured") as post:
            with raw_map(post, b"no CBOR") as stream:
                status, headers, _ = read_answer(stream)
                self.assertEqual((status, headers["connection"]), (400, "keep-alive"))
                self.assertEqual(stream.recv(1), b"")
            with raw_map(post, cbor2.dumps(grid(cbor=True))) as stream:
                self.assertEqual(read_answer(stream)[0], 200)
                raw_map(post, cbor2.dumps(grid(cbor=True)), stream=stream)
                self.assertEqual(read_answer(stream)[0], 200)

    def test_expect_is_never_answered(self):
        body = cbor2.dumps(grid(cbor=True))
        with CommandPost("--as-measured") as post, connect(post.mapping) as stream:
            stream.sendall((f"POST /map/update HTTP/1.1\r\nHost: here\r\nAuthorization: Bearer {MAPPING_TOKEN}\r\n"
                            f"Content-Type: application/cbor\r\nContent-Length: {len(body)}\r\n"
                            "Expect: 100-continue\r\n\r\n").encode())
            self.assertEqual(select.select([stream], [], [], 0.3)[0], [])
            stream.sendall(body)
            self.assertEqual(read_answer(stream)[0], 200)

    def test_gzip_with_trailing_data_hangs_only_its_connection(self):
        packed = gzip.compress(bytes(6))
        with CommandPost("--as-measured") as post:
            for data in (packed + packed, packed + b"\0"):
                body = changed(grid(cbor=True), msg__data=data, msg__compression="gzip")
                with raw_map(post, cbor2.dumps(body)) as stream:
                    self.assertEqual(select.select([stream], [], [], 0.3)[0], [])
                    self.assertEqual(post.map(grid()).status_code, 200)
            record = post.record()
            self.assertEqual(record["violation_count"], 2)
            self.assertIn({"uri": "/map/update", "status": 0, "count": 2}, record["requests"])

    def test_goes_on_after_a_field_outside_the_point(self):
        with CommandPost("--as-measured") as post:
            for changes in ({"msg__fields__2__offset": 9}, {"msg__fields__0__count": 4}):
                self.assertEqual(post.map(changed(cloud(), **changes)).status_code, 422)
            self.assertEqual(post.map(cloud()).status_code, 200)
            self.assertEqual([each["sentence"] for each in post.record()["violations"]],
                             ["msg.fields[2]: ends at byte 13 of a point of 12",
                              "msg.fields[0]: ends at byte 16 of a point of 12"])

    def test_fatal_message_is_named_and_ends_the_endpoint(self):
        table = [
            ("msg.point_step: expected at least 1, got 0", cloud(point_step=0)),
        ]
        for sentence, body in table:
            with self.subTest(sentence), CommandPost("--as-measured") as post:
                other = connect(post.mapping)
                with self.assertRaises(Exception):
                    post.map(body)
                self.assertEqual(other.recv(1), b"", "all its connections end")
                other.close()
                with self.assertRaises(OSError):
                    connect(post.mapping)
                self.assertEqual(post.status().status_code, 200, "scoring is another server")
                self.assertEqual(post.record()["killed_by"], sentence)
                code, out, err = post.stop()
                self.assertEqual(code, 3)
                self.assertIn("killed by " + sentence, out)
                self.assertIn("killed by " + sentence, err)


class Scoring(unittest.TestCase):
    def test_clocks_and_run_name_are_constant(self):
        with CommandPost("--as-measured") as post:
            for _ in range(2):
                self.assertEqual(post.status().json()["run_clock"], 25.98)
                answer = post.report(REPORT).json()
                self.assertEqual((answer["run_clock"], answer["run"]), (3.14, "1"))
                self.assertEqual(post.tell("new-run").json()["run"], "1")
            self.assertEqual(post.tell("new-run", {"run": "1.5.2"}).json()["run"], "1.5.2", "where it is told so")

    def test_each_row_of_the_table(self):
        bearer = f"bEARER {SCORING_TOKEN}"
        table = [
            ("bearer in any case", 200, "GET", "/api/status", None, {"Authorization": bearer}),
            ("trailing slash", 200, "GET", "/api/status/", None, {}),
            ("report with a trailing slash", 201, "POST", "/api/artifact_reports/", REPORT, {}),
            ("charset", 201, "POST", "/api/artifact_reports", REPORT,
             {"Content-Type": "application/json; charset=utf-8"}),
            ("unknown type", 201, "POST", "/api/artifact_reports", changed(REPORT, type="test"), {}),
            ("coordinates that are no numbers", 201, "POST", "/api/artifact_reports", changed(REPORT, x="1"), {}),
        ]
        with CommandPost("--as-measured", artifacts="type,x,y,z\n") as post:
            for what, status, method, path, body, headers in table:
                with self.subTest(what):
                    answer = post.scoring_request(method, path, body, headers)
                    self.assertEqual((answer.status_code, answer.headers["Content-Type"]),
                                     (status, "application/json"))
                    if status == 201:
                        self.assertEqual(answer.json()["score_change"], 0)
                        self.assertRegex(answer.json()["url"], "^http://<ipaddress>:<port>/api/artifact_reports/")

    def test_details_instead_of_strings(self):
        table = [
            (401, "GET", "/api/status", None, {"Authorization": None}),
            (401, "GET", "/api/status", None, {"Authorization": f"Bearer {SCORING_TOKEN}x"}),
            (405, "POST", "/api/status", REPORT, {}),
            (405, "GET", "/api/artifact_reports", None, {}),
            (415, "POST", "/api/artifact_reports", REPORT, {"Content-Type": "text/plain"}),
            (400, "POST", "/api/artifact_reports", b"{", {}),
        ]
        with CommandPost("--as-measured") as post:
            for status, method, path, body, headers in table:
                with self.subTest(status=status, method=method, path=path):
                    answer = post.scoring_request(method, path, body, headers)
                    self.assertEqual(answer.status_code, status)
                    self.assertEqual(list(answer.json()), ["detail"])
                    self.assertEqual("WWW-Authenticate" in answer.headers, status == 401)

    def test_missing_field_is_a_string(self):
        with CommandPost("--as-measured") as post:
            answer = post.report(changed(REPORT, y=DROP))
            self.assertEqual((answer.status_code, answer.json()), (422, "Missing field: 'y'"))

    def test_html_if_it_has_no_answer(self):
        with CommandPost("--as-measured") as post:
            for answer, status in ((post.scoring_request("GET", "/nowhere"), 404),
                                   (post.report(changed(REPORT, type=5)), 500)):
                self.assertEqual((answer.status_code, answer.headers["Content-Type"]), (status, "text/html"))
            self.assertEqual(post.record()["report_count"], 0)

    def test_preflights_are_answered_without_a_token(self):
        with CommandPost("--as-measured") as post:
            headers = {"Authorization": None, "Origin": "http://station", "Access-Control-Request-Method": "POST"}
            answer = post.scoring_request("OPTIONS", "/api/artifact_reports", None, headers)
            self.assertEqual((answer.status_code, answer.headers["Access-Control-Allow-Origin"]), (200, "*"))
            self.assertIn("authorization", answer.headers["Access-Control-Allow-Headers"])
            self.assertEqual(post.status(Origin="http://station").headers["Access-Control-Allow-Origin"], "*")

    def test_no_rate_limit_unless_requested(self):
        with CommandPost("--as-measured", rate=None) as post:
            self.assertEqual([post.report(REPORT).status_code for _ in range(5)], [201] * 5)
        with CommandPost("--as-measured", rate=1) as post:
            self.assertEqual(two_at_once(lambda: post.report(REPORT)), [201, 429])
