"""Steps of a story about updates, by the API: send one, restart, wait for the result."""

import http.client

import programs
from patience import patient


class Updating:
    """Mixin of stage.Story."""

    def stands(self):
        return self.box.ask("GET /adit/update")[1]

    def last(self):
        last = self.stands()["last"]
        return last and (last["stage"], last["version"])

    def send(self, path):
        """Sends it as the page does."""
        connection = http.client.HTTPConnection(self.stage.network.box_address, self.box.port, timeout=patient(300))
        headers = {"Authorization": f"Bearer {programs.TEAM_TOKEN}", "Content-Type": "application/octet-stream"}
        with open(path, "rb") as file:
            connection.request("POST", "/adit/update", file, {**headers, "Content-Length": str(path.stat().st_size)})
            answer = connection.getresponse()
            said = answer.read()
        connection.close()
        self.assertEqual(answer.status, 200, said)

    def restart(self):
        self.assertEqual(self.box.ask("POST /adit/update/restart", body={"anyway": True})[0], 200)

    def settled(self, *wanted, within):
        def is_so():
            try:
                return self.last() == wanted
            except (OSError, ValueError, KeyError):
                return False  # it restarts

        self.box.wait_until(is_so, f"an update that is {wanted}", within)
