"""The box as its units make it, with TLS at port 443: aditd and stunnel, each with the sockets of systemd (activation.py)."""

import contextlib
import os
import pathlib
import re
import shutil
import socket
import ssl
import subprocess
import unittest

import activation
import programs

SERVICES = pathlib.Path(os.environ["ADIT_SOURCE"]) / "services"
PROGRAM = "/usr/bin/stunnel4"
PORT, PLAIN_PORT = 443, 8443
SEND_BUFFER = 64 * 1024  # SendBuffer= of adit-tls.socket
FILES = 512  # LimitNOFILE= of adit-tls.service


def needs_stunnel():
    if not pathlib.Path(PROGRAM).exists() or not shutil.which("openssl"):
        raise unittest.SkipTest("needs stunnel4 and openssl")


def make_certificate(folder, *names):
    """`names`: as in "IP:10.0.0.1". Writes tls.pem, with the key."""
    subprocess.run(["openssl", "req", "-x509", "-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:P-256", "-nodes", "-days", "3650",
                    "-subj", "/CN=adit.local", "-addext", f"subjectAltName={','.join(('DNS:adit.local', *names))}",
                    "-keyout", folder / "tls.key", "-out", folder / "tls.crt"], check=True, capture_output=True)
    (folder / "tls.pem").write_text((folder / "tls.key").read_text() + (folder / "tls.crt").read_text())
    (folder / "tls.pem").chmod(0o600)


def listening(address, port, interface, **options):
    opened = socket.socket()
    opened.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    opened.setsockopt(socket.SOL_SOCKET, socket.SO_BINDTODEVICE, interface.encode())
    for option, value in options.items():
        opened.setsockopt(socket.SOL_SOCKET, getattr(socket, option), value)
    opened.bind((address, port))
    opened.listen(1024)
    return opened


class SecureBox(programs.Page):
    """Has no process of its own, so that aditd can be restarted: see `manager` and `stunnel`."""

    def __init__(self, network, folder, **overrides):
        self.network, self.folder, self.state = network, folder, folder / "state"
        make_certificate(folder, f"IP:{network.box_address}")
        self.inside = ["ip", "netns", "exec", network.box]
        plain = network.made_in(network.box, lambda: listening("127.0.0.1", PLAIN_PORT, "lo"))
        self.team = network.made_in(network.box, lambda: listening("0.0.0.0", PORT, "team0", SO_SNDBUF=SEND_BUFFER))
        self.manager = activation.ServiceManager(folder, inside=self.inside, tls=[plain])
        self.certificate, self.stunnel = folder / "trusted.crt", None
        try:
            self.manager.ready(self.manager.start(programs.settings(network, overrides)))
            self.serve_tls(folder / "tls.pem")
        except BaseException:
            self.stop()
            raise

    def serve_tls(self, pem):
        """Starts or restarts stunnel with a copy of `pem`, as adit-tls.service does. Clients trust its certificate from now on."""
        self.stop_stunnel()
        held = pem.read_text()
        self.certificate.write_text(held[held.index("-----BEGIN CERTIFICATE"):])
        self.context = ssl.create_default_context(cafile=self.certificate)
        credential = self.folder / "credential.pem"
        credential.write_text(held)
        credential.chmod(0o600)
        configuration = (SERVICES / "adit-tls.conf").read_text()
        (self.folder / "tls.conf").write_text(re.sub("(?m)^cert = .*$", f"cert = {credential}", configuration))
        limited = ["prlimit", f"--nofile={FILES}", PROGRAM, self.folder / "tls.conf"]
        self.stunnel = activation.start_with(limited, [("adit-tls.socket", self.team)], self.folder / "stunnel.log", self.inside)

    def stop_stunnel(self):
        if self.stunnel:
            self.stunnel.kill()
            self.stunnel.wait()

    @property
    def secure_url(self):
        return f"https://{self.network.box_address}"

    def output(self):
        return self.manager.log()

    def connect(self, source="", context=None, timeout=30):
        """A connection after its handshake."""
        plain = self.connect_plain(source, timeout)
        try:
            return (context or self.context).wrap_socket(plain, server_hostname=self.network.box_address,
                                                         suppress_ragged_eofs=False)
        except BaseException:
            plain.close()
            raise

    def connect_plain(self, source="", timeout=30):
        return socket.create_connection((self.network.box_address, PORT), programs.patient(timeout), (source, 0))

    def stop(self, *_):
        self.stop_stunnel()
        self.manager.close()
        self.team.close()


class SecureStage(programs.Stage):
    """As Stage, with a SecureBox."""

    make_box = SecureBox

    def __exit__(self, *exception):
        if self.box is not None:
            self.box.stop()
            self.box = None
        super().__exit__(*exception)


@contextlib.contextmanager
def closing_all():
    """A list of sockets that are closed at the end."""
    held = []
    try:
        yield held
    finally:
        for each in held:
            each.close()
