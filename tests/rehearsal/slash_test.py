"""A Command Post that insists on a slash at the end of each path."""

import unittest

from command_post import CommandPost, grid, marker, state

REPORT = {"x": 1.0, "y": 2.0, "z": 3.0, "type": "Drill"}


class Slash(unittest.TestCase):
    def test_without_it_each_uri_is_redirected_unrecorded(self):
        for manner in ((), ("--as-measured",)):
            with self.subTest(manner), CommandPost("--slash", *manner, transcript=True) as post:
                here = f"http://{post.scoring}"
                table = [
                    (301, post.scoring_request, "GET", "/api/status", None, here + "/api/status/"),
                    (301, post.scoring_request, "POST", "/api/artifact_reports", REPORT, here + "/api/artifact_reports/"),
                    (308, post.mapping_request, "POST", "/map/update", grid(), "/map/update/"),
                    (308, post.mapping_request, "POST", "/state/update", state("X1"), "/state/update/"),
                    (308, post.mapping_request, "POST", "/markers/update", marker(), "/markers/update/"),
                ]
                for status, ask, method, path, body, there in table:
                    with self.subTest(path=path):
                        answer = ask(method, path, body, allow_redirects=False)
                        self.assertEqual((answer.status_code, answer.headers["Location"]), (status, there))
                        self.assertIn({"uri": path, "status": status, "count": 1}, post.record()["requests"])
                        good = ask(method, path + "/", body)
                        self.assertIn(good.status_code, (200, 201), good.text)
                record = post.record()
                self.assertEqual((record["report_count"], record["violation_count"]), (1, 0), record["violations"])
                reports = [line for line in post.lines() if "reports" in line["uri"]]
                self.assertEqual([(line["uri"], line["status"], line["message"]) for line in reports],
                                 [("/api/artifact_reports", 301, REPORT), ("/api/artifact_reports/", 201, REPORT)])

    def test_redirected_report_sent_twice_is_recorded_twice(self):
        with CommandPost("--slash") as post:
            for _ in range(2):
                lost = post.scoring_request("POST", "/api/artifact_reports", REPORT, allow_redirects=False)
                self.assertEqual(post.request("", "POST", lost.headers["Location"].removeprefix("http://"), REPORT,
                                              {"Authorization": lost.request.headers["Authorization"],
                                               "Content-Type": "application/json"}).status_code, 201)
            self.assertEqual([report["x"] for report in post.record()["reports"]], [REPORT["x"]] * 2)

    def test_redirected_requests_take_no_fault(self):
        with CommandPost("--slash", "--fault", "reports:500") as post:
            self.assertEqual(post.scoring_request("POST", "/api/artifact_reports", REPORT, allow_redirects=False).status_code, 301)
            self.assertEqual(post.scoring_request("POST", "/api/artifact_reports/", REPORT).status_code, 500)
            self.assertEqual(post.scoring_request("POST", "/api/artifact_reports/", REPORT).status_code, 201)

    def test_other_uris_are_unknown_with_and_without_it(self):
        with CommandPost("--slash") as post:
            for path in ("/api", "/api/", "/api/status//", "/map/update"):
                self.assertEqual(post.scoring_request("GET", path, allow_redirects=False).status_code,
                                 404 if path != "/map/update" else 308, path)
