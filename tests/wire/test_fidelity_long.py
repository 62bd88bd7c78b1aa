"""Fidelity with a Command Post that behaves like the real ones, and with the largest markers."""


import messages
import test_fidelity
from delivered import Delivered
from programs import wait_until


class FidelityAsMeasured(test_fidelity.Fidelity):
    post_options = ("--rate", "0", "--as-measured")


def large_marker(points, colors):
    """In a line of the transcript, long lists are replaced by their lengths."""
    marker = test_fidelity.said(test_fidelity.whole_marker(5)) | {"type": 6, "ns": "voxels"}
    marker["points"] = [{"x": n / 7, "y": -n / 3, "z": 0.3} for n in range(points)]
    marker["colors"] = [{"r": n % 256 / 255, "g": 0.2, "b": 0.3, "a": 1.0} for n in range(colors)]
    return marker


class LargeMarkers(Delivered):
    def test_largest_marker_is_delivered(self):
        marker = large_marker(100_000, 100_000)
        for style in (test_fidelity.CBOR, test_fidelity.CBOR_IN_GZIP):
            with self.subTest(str(style)):
                arrived = self.deliver("/markers/update", {"markers": [marker]}, style)["markers"]
                arrived[0]["header"] = self.without_stamp(arrived[0]["header"])
                arrived[0] = test_fidelity.whole_lifetime(arrived[0])
                many = {"elements": 100_000}
                self.same(arrived, [{**marker, "points": many, "colors": many}])

    def test_large_marker_survives_a_restart(self):
        self.stage.post.will(mapping=["500,for=60"])
        marker = {"markers": [large_marker(60_000, 0)]}
        answer = messages.post(self.session, self.stage.box.url, "/markers/update", marker, test_fidelity.CBOR)
        self.assertEqual((answer.status_code, answer.text), (200, "null"))
        self.stage.box.process.kill()
        self.stage.box.process.wait()
        self.stage.post.control("DELETE /faults")
        self.stage.restart_box()
        taken = wait_until(lambda: [request for request in self.stage.post.requests("/markers/update")
                                    if request["status"] == 200], "the marker to be taken")
        self.assertEqual(taken[-1]["message"]["markers"][-1]["points"], {"elements": 60_000})
