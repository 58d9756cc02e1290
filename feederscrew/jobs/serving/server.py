"""The server of ``feeder serve``: on this machine alone, with a bounded number of connections."""

import contextlib
import errno
import socket
import threading
from collections import OrderedDict
from typing import Any

from werkzeug.serving import ThreadedWSGIServer, WSGIRequestHandler

from feederscrew.base.errors import FeederError
from feederscrew.jobs.serving.site import HOST, Site

IDLE_S = 60.0  # after which a connection that sends nothing is closed
MOST_CONNECTIONS = 48  # at once: a browser opens six for a page


class Handler(WSGIRequestHandler):
    """Answers without a line in the terminal: addresses have the token in them."""

    timeout = IDLE_S

    def log(self, type: str, message: str, *args: object) -> None:
        """Say nothing.

        Parameters
        ----------
        type, message : str
            As werkzeug gives them; not used.
        *args : object
            Not used.
        """

    def run_wsgi(self) -> None:
        """Answer a request that has come; meanwhile its connection is not idle."""
        if isinstance(self.server, BoundedServer):
            self.server.mark(self.connection, is_idle=False)
        super().run_wsgi()
        if isinstance(self.server, BoundedServer):
            self.server.mark(self.connection, is_idle=True)


class BoundedServer(ThreadedWSGIServer):
    """A thread for each connection, of which there are MOST_CONNECTIONS at most.

    One more closes the oldest that has no request at work; where all have one it is closed itself.
    """

    def __init__(self, site: Site, port: int) -> None:
        """Listen on a port of this machine, any that is free where it is 0. Raises FeederError."""
        self._open: OrderedDict[Any, bool] = OrderedDict()  # whether each is idle, the oldest first
        self._turn = threading.Lock()
        with socket.socket(socket.AF_INET, socket.SOCK_STREAM) as own:
            own.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
            try:
                own.bind((HOST, port))
            except OSError as fault:
                raise _port_fault(port, fault) from None
            own.listen(self.request_queue_size)
            super().__init__(HOST, port, site, Handler, fd=own.fileno())
        site.port = self.port = self.server_address[1]

    def process_request(self, request: Any, client_address: Any) -> None:
        """Answer a connection in a thread of its own, if there may be one more.

        Parameters
        ----------
        request : socket
            The connection.
        client_address : tuple
            Where it comes from.
        """
        closed = None
        with self._turn:
            if len(self._open) >= MOST_CONNECTIONS:
                closed = next((other for other, is_idle in self._open.items() if is_idle), request)
                self._open.pop(closed, None)
            if closed is not request:
                self._open[request] = True
        if closed is not None:
            with contextlib.suppress(OSError):
                closed.shutdown(socket.SHUT_RDWR)  # its thread reads an end, and closes it
        if closed is request:
            self.shutdown_request(request)
            return
        super().process_request(request, client_address)

    def mark(self, request: Any, *, is_idle: bool) -> None:
        """Note whether a connection has a request at work.

        Parameters
        ----------
        request : socket
            The connection; one that is closed already is left alone.
        is_idle : bool
        """
        with self._turn:
            if request in self._open:
                self._open[request] = is_idle

    def shutdown_request(self, request: Any) -> None:
        """Close a connection, and forget it.

        Parameters
        ----------
        request : socket
            The connection.
        """
        with self._turn:
            self._open.pop(request, None)
        super().shutdown_request(request)


def _port_fault(port: int, fault: OSError) -> FeederError:
    if fault.errno == errno.EADDRINUSE:
        return FeederError(f"port {port}", "is taken", "give another to --port, or none")
    if fault.errno in (errno.EACCES, errno.EPERM):
        return FeederError(
            f"port {port}", "is not open to this user", "give one above 1023 to --port, or none"
        )
    return FeederError(
        f"port {port}", f"cannot be used ({fault.strerror})", "give another to --port, or none"
    )
