"""What a release leaves behind in its state and runtime folders when it is stopped: settings, a password, a token, reports
in all ways, a map, a state and markers that wait. Run as a program with ADIT_BIN at that release, it writes the archive
that it is told, for test_upgrade.py."""

import json
import sys
import tarfile
import time

import requests

import maps
import messages
import programs
from messages import Style
from programs import Stage, wait_until
from reporting import REPORT, another, began, submit

PASSWORD = "correct horse battery"
NEAR_METRES = 7.25  # a setting that nobody has by chance
GRID, CLOUD = maps.made_grid(64, 48), maps.made_cloud(300)
TURNED = {"x": 0.0, "y": 0.0, "z": 0.6, "w": 0.8}
STATE = {"poses": [{"name": "r3", "position": {"x": 4.0, "y": 0.0, "z": 0.0}, "orientation": TURNED}]}
MARKERS = {"markers": [{"action": 0, "ns": "a", "id": 1, "type": 2, "text": "kept",
                        "pose": {"position": {"x": 1.0, "y": 2.0, "z": 3.0}, "orientation": TURNED},
                        "scale": {"x": 1, "y": 1, "z": 1}, "color": {"r": 1, "g": 0, "b": 0, "a": 1}}]}


def set_up(box):
    """A password, a token and a setting, as the page saves them."""
    code = box.said().rpartition("code=")[2].split()[0]
    for request, body in (("/adit/password", {"role": "operator", "code": code, "password": PASSWORD}),
                          ("/adit/login", {"password": PASSWORD})):
        answer = requests.post(box.url + request, json=body, timeout=30)
        assert answer.status_code == 200, answer.text
    held = box.ask("GET /adit/settings")[1]
    settings = held["settings"] | {"reports": {"near_metres": NEAR_METRES}}
    for request, body in (("POST /adit/tokens", {"name": "mapping", "token": programs.MAPPING_TOKEN}),
                          ("POST /adit/settings", {"settings": settings, "base": held["tag"]})):
        box.apply(request, body)


def leave(stage):
    set_up(stage.box)
    for report in (REPORT, another(1)):
        assert submit(began(stage), report).status_code == 201
    stage.post.stop()
    session = requests.Session()
    for uri, message in (("/map/update", messages.map_update(GRID, "r1", time.time(), Style("cbor"))),
                         ("/map/update", messages.map_update(CLOUD, "r2", time.time(), Style("cbor"))),
                         ("/state/update", STATE), ("/markers/update", MARKERS)):
        answer = messages.post(session, stage.box.url, uri, message, Style("cbor"))
        assert answer.status_code == 200, answer.text
    try:
        submit(stage, another(2), timeout=1)
    except requests.RequestException:
        pass
    time.sleep(2)
    assert stage.box.stop() == 0


def main(archive):
    with Stage() as stage:
        leave(stage)
        with tarfile.open(archive, "w:xz") as tar:
            tar.add(stage.box.state, arcname=".")
            print("\n".join(tar.getnames()))
        print(json.dumps(stage.box.on_disk("SELECT number, state, status FROM report ORDER BY number")))


if __name__ == "__main__":
    main(sys.argv[1])
