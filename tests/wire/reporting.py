"""Artifact reports as team software posts them: by clients that wait, and by clients that hang up and try again."""

import concurrent.futures
import json

import requests

import programs
from programs import patient, wait_until

REPORT = {"x": 1011.242, "y": -244.433, "z": -10.011, "type": "Backpack"}

# So that a doubt takes a second, and not ten.
QUICK = {"command_post__timeouts__scoring_answer_ms": 400, "reports__doubt_for_ms": 600, "reports__doubt_asks": 2,
         "reports__answer_within_ms": 8000}


def another(number):
    """A report that is none of the others."""
    return {**REPORT, "x": 10.0 * number}


def submit(stage, report=None, timeout=60, **headers):
    """One try, of `timeout` seconds times ADIT_PATIENCE. `headers` in addition: submit(stage, Adit_Resubmit="yes")."""
    given = {"Authorization": f"Bearer {programs.TEAM_TOKEN}", "Content-Type": "application/json"}
    given |= {name.replace("_", "-"): value for name, value in headers.items()}
    return requests.post(stage.box.url + "/api/artifact_reports", data=json.dumps(report or REPORT), headers=given,
                         timeout=patient(timeout))


def insist(stage, report=None, hang_up_after=0.3, pause=0.01, until=lambda answer: True, within=60):
    """Hangs up and tries again until an answer comes that is good enough."""
    def good_answer():
        answer = submit(stage, report, hang_up_after)
        if not until(answer):
            raise requests.HTTPError(f"answered {answer.status_code}: {answer.text}")
        return [answer]  # one of 400 or more is false

    return wait_until(good_answer, "an answer that is good enough", within, requests.RequestException, pause)[0]


def left_unanswered(stage, report=None, patience=0.5):
    """Posts what gets no answer for now, and hangs up once the box holds it."""
    held = len(stage.box.reports())
    while len(stage.box.reports()) == held:  # a busy box may have read nothing yet
        try:
            answer = submit(stage, report, patience)
        except requests.Timeout:
            continue
        raise AssertionError(f"answered {answer.status_code}: {answer.text}")


def is_taken(stage, report):
    """Posts it until it is answered 201: on a busy machine its client may be told first that it is kept."""
    return insist(stage, report, 30, until=lambda answer: answer.status_code == 201)


def began(stage):
    """The stage, once reports can be sent."""
    wait_until(stage.box.knows_the_run, "the box to know the run")
    return stage


def sendings(stage, report=None):
    """How often it left, whatever became of it."""
    x = (report or REPORT)["x"]
    return sum(request["message"]["x"] == x for request in stage.post.requests("/api/artifact_reports")
               if request["message"])


def at_once(*clients):
    """What each gives, all of them called at the same time."""
    with concurrent.futures.ThreadPoolExecutor(len(clients)) as pool:
        return [future.result() for future in [pool.submit(client) for client in clients]]
