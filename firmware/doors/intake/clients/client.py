"""A client that retries until the outcome is known. `bare`: it posts to a Command Post without Adit."""
import json
import time

import requests
from urllib3.exceptions import NewConnectionError

REPORTS = "/api/artifact_reports"
NEVER_LEFT, LOST = -1, 0  # instead of a status


class Refused(Exception):
    """The message was rejected; the same message would be rejected again."""


class Unknown(Exception):
    """The report may have been recorded; a person must decide what to do."""


class Client:
    def __init__(self, url, token, bare=False):
        self.url, self.bare, self.turn = url, bare, 0.0
        self.headers = {"Authorization": f"Bearer {token}", "Content-Type": "application/json"}

    def status(self):
        return self.until_answered("GET", "/api/status")

    def report(self, x, y, z, kind):
        """The Command Post's answer."""
        return self.until_answered("POST", REPORTS, {"x": x, "y": y, "z": z, "type": kind})

    def update(self, what, message):
        """Sends a map, a state or markers: update("map", ...)."""
        return self.until_answered("POST", f"/{what}/update", message)

    def until_answered(self, method, uri, message=None, patience=600):
        """Returns the body of a 2xx. Retries for `patience` seconds if a retry is safe."""
        try:
            content = None if message is None else json.dumps(message, allow_nan=False).encode()
        except ValueError as why:
            raise Refused(str(why)) from why
        end = time.monotonic() + patience
        while time.monotonic() < end:
            status, body, again_after = self._ask(method, uri, content)
            if 200 <= status < 300:
                return body
            if status in (LOST, 408) or status >= 500:  # Adit recognises a retried report
                if self.bare and uri == REPORTS:
                    raise Unknown("no answer: see whether remaining_reports went down before you post it again")
            elif status == 409:
                raise Unknown(body)
            elif status not in (NEVER_LEFT, 429):
                raise Refused(f"{status} {body}")
            time.sleep(int(again_after) if again_after.isdigit() else 1)
        raise Unknown(f"no answer for {patience} s")

    def _ask(self, method, uri, content):
        """Status, body and Retry-After of one request. Waits 3 s for the connection and 30 s for the answer; Adit needs up to 20 s."""
        if self.bare:  # it accepts one request a second
            time.sleep(max(0.0, self.turn - time.monotonic()))
        try:  # on a new connection, because a bare Command Post closes old ones without notice
            with requests.Session() as session:
                session.trust_env = False  # no http_proxy, and no .netrc instead of the token
                answer = session.request(method, self.url + uri, data=content, headers=self.headers, timeout=(3, 30),
                                         allow_redirects=False)
            body = answer.json() if answer.ok else answer.text  # a redirection or a 2xx without JSON comes from another machine
            return answer.status_code, body, answer.headers.get("Retry-After", "1")
        except requests.ConnectTimeout:
            return NEVER_LEFT, "", "1"
        except (requests.RequestException, ValueError) as why:  # ValueError: invalid JSON, in versions of requests before 2.27
            not_connected = why.args and isinstance(getattr(why.args[0], "reason", None), NewConnectionError)
            return NEVER_LEFT if not_connected else LOST, "", "1"
        finally:
            self.turn = time.monotonic() + 1.1
