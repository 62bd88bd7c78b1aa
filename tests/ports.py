"""Ports for servers that tests start."""

import contextlib
import random
import socket


def free_port():
    """A free port. It is below the ephemeral ports, so the kernel does not give it to others meanwhile."""
    while True:
        with contextlib.suppress(OSError), contextlib.closing(socket.socket()) as tried:
            tried.bind(("127.0.0.1", random.randrange(11000, 32000)))
            return tried.getsockname()[1]
