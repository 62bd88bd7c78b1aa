"""Ports for servers that tests start."""

import contextlib
import random
import socket


def free_port():
    """One that nobody listens at. Below those that the kernel gives to whoever asks for any, or it might give this one away
    meanwhile."""
    while True:
        with contextlib.suppress(OSError), contextlib.closing(socket.socket()) as tried:
            tried.bind(("127.0.0.1", random.randrange(11000, 32000)))
            return tried.getsockname()[1]
