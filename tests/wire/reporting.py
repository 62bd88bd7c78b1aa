"""Artifact reports of team software: clients that wait, and clients that hang up and retry."""

import concurrent.futures
import json

import requests

import programs
from programs import patient, wait_until

REPORT = {"x": 1011.242, "y": -244.433, "z": -10.011, "type": "Backpack"}

# Shortens doubts from ten seconds to one.
QUICK = {"command_post__timeouts__scoring_answer_ms": 400, "reports__doubt_for_ms": 600, "reports__doubt_asks": 2,
         "reports__answer_within_ms": 8000}


def another(number):
    """A report that differs from all others."""
    return {**REPORT, "x": 10.0 * number}


def submit(stage, report=None, timeout=60, **headers):
    """One try, of `timeout` seconds times ADIT_PATIENCE. Additional headers: submit(stage, Adit_Resubmit="yes")."""
    given = {"Authorization": f"Bearer {programs.TEAM_TOKEN}", "Content-Type": "application/json"}
    given |= {name.replace("_", "-"): value for name, value in headers.items()}
    return requests.post(stage.box.url + "/api/artifact_reports", data=json.dumps(report or REPORT), headers=given,
                         timeout=patient(timeout))


def insist(stage, report=None, hang_up_after=0.3, pause=0.01, until=lambda answer: True, within=60):
    """Hangs up and retries until `until` accepts the answer."""
    def good_answer():
        answer = submit(stage, report, hang_up_after)
        if not until(answer):
            raise requests.HTTPError(f"answered {answer.status_code}: {answer.text}")
        return [answer]  # one of 400 or more is false

    return wait_until(good_answer, "an answer that is good enough", within, requests.RequestException, pause)[0]


def left_unanswered(stage, report=None, patience=0.5):
    """Posts a report that gets no answer yet, and hangs up once the box has it."""
    held = len(stage.box.reports())
    while len(stage.box.reports()) == held:  # a busy box may have read nothing yet
        try:
            answer = submit(stage, report, patience)
        except requests.Timeout:
            continue
        raise AssertionError(f"answered {answer.status_code}: {answer.text}")


def is_taken(stage, report):
    """Posts a report until it is answered 201. On a busy machine the first answer may be that it is kept."""
    return insist(stage, report, 30, until=lambda answer: answer.status_code == 201)


def began(stage):
    """The stage, once the box knows the run, so that reports can be sent."""
    wait_until(stage.box.knows_the_run, "the box to know the run")
    return stage


def sendings(stage, report=None):
    """How often the report was sent, whatever the outcome."""
    x = (report or REPORT)["x"]
    return sum(request["message"]["x"] == x for request in stage.post.requests("/api/artifact_reports")
               if request["message"])


def at_once(*clients):
    """Calls all clients at the same time and returns their results."""
    with concurrent.futures.ThreadPoolExecutor(len(clients)) as pool:
        return [future.result() for future in [pool.submit(client) for client in clients]]
