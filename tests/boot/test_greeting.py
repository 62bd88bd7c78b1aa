"""A box that was never set up shows on its console where its page is and the code of the first password, which the card brought."""

import dataclasses

import boards
import cables
from stage import Stage, Story, load_tests, setUpModule  # unittest looks for them here

CODE, PASSWORD = "87654321", "correct horse battery"


class Greeting(Story):
    @classmethod
    def setUpClass(cls):
        no_shell = dataclasses.replace(boards.QEMU_VIRT, words="")
        stage = cls.tell(Stage(set_up=False, post_options=None, board=no_shell))
        stage.disk.make_folder("adit/secrets")
        stage.disk.put("adit/secrets/label.code", CODE + "\n")
        stage.box.power_on()

    def test_console_shows_the_address_of_the_page_and_the_code(self):
        shown = self.box.console.wait_for(rb"no password is set yet.*?asks for: (\d+)\s", 400)  # to its last digit
        self.assertIn(f"http://{cables.FACTORY_ADDRESS}".encode(), shown[0])
        self.assertEqual(shown[1].decode(), CODE)

    def test_code_sets_the_first_password(self):
        asked = lambda body: self.box.insist("POST /adit/password", {"Content-Type": "application/json"}, body, token=None, timeout=20)
        self.assertEqual(asked({"role": "operator", "code": "12345678", "password": PASSWORD})[0], 403)
        self.assertEqual(asked({"role": "operator", "code": CODE, "password": PASSWORD})[0], 200)


