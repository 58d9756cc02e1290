"""The pages and answers of ``feeder serve``: who may ask, what may be sent, and what is answered.

Every request is refused that does not name this machine as its host, has no token of this run, or changes
something and comes from another origin. The page has the token in its address and sends it in a header; links
have it in their path, so that a page of results finds the files beside it. A cookie would go to every other
server of this machine: it knows no port.
"""

import contextlib
import hmac
import io
import itertools
import json
import secrets
import threading
import zipfile
from collections.abc import Callable, Iterable, Iterator, Sequence
from importlib import resources
from pathlib import Path
from typing import Any
from urllib.parse import quote
from wsgiref.types import WSGIEnvironment

from werkzeug.exceptions import ClientDisconnected, HTTPException
from werkzeug.wrappers import Request, Response

from feederscrew.base.columns import Document
from feederscrew.base.errors import FeederError, printable
from feederscrew.jobs.serving.designs import MOST_DESIGNS, DesignJob, Guard
from feederscrew.jobs.serving.orders import ANY_HEADING, BEST_HEADING, MACHINES, OUTCOMES, MayUse, PageOrder
from feederscrew.jobs.serving.refusal import Refusal, in_words_of_the_page
from feederscrew.jobs.serving.uploads import BOWL_BYTES, ENDINGS, PART_BYTES, UNITS, Uploads
from feederscrew.part.density import MATERIALS

HOST = "127.0.0.1"
NAMES = (HOST, "localhost")  # of this machine, as a browser may write them
HTTP_PORT = 80  # which no browser names
TOKEN_HEADER = "X-Feeder-Token"
TOKEN_PATH = "/token/"  # begins the path of a link, before the token
VALUES_BYTES = 4096  # that the values of a request may have
WAIT_S = 60.0  # for a request before this one
KINDS = {  # of the files of a result, by their ending; others are saved
    "html": "text/html; charset=utf-8",
    "png": "image/png",
    "svg": "image/svg+xml",
    "pdf": "application/pdf",
    "csv": "text/csv; charset=utf-8",
    "json": "application/json",
    "yaml": "text/plain; charset=utf-8",
}
GUARD = {
    "X-Content-Type-Options": "nosniff",
    "X-Frame-Options": "SAMEORIGIN",
    "Referrer-Policy": "no-referrer",
    "Cache-Control": "no-store",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Content-Security-Policy": "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; "
    "img-src data: 'self'; connect-src 'self'; frame-src 'self'; frame-ancestors 'self'; base-uri 'none'; "
    "form-action 'none'",
}
NO_TOKEN = "no token of this run - open the address that feeder serve printed"
NO_DESIGN = "that design is not here - reload the page"


class Site:
    """The WSGI application of one run.

    All that is uploaded and computed is below ``folder``; whoever made it removes it. ``program`` runs
    ``feeder``: ``design`` and its arguments follow.
    """

    def __init__(self, folder: Path, program: Sequence[str]) -> None:
        self.folder, self.program = folder, tuple(program)
        self.token, self.port = secrets.token_urlsafe(24), 0
        self.uploads = Uploads(folder / "parts")
        self.designs: dict[str, DesignJob] = {}  # by id, the oldest first
        self.guard: Guard | None = None  # started with the first design
        self._numbers = itertools.count(1)
        self._one_at_a_time = threading.Lock()

    @property
    def hosts(self) -> list[str]:
        """Return the hosts that a browser may name, with the port; http:// and one is an allowed origin."""
        with_port = [f"{name}:{self.port}" for name in NAMES]
        return [*NAMES, *with_port] if self.port == HTTP_PORT else with_port

    @property
    def address(self) -> str:
        """Return the address to open, with the token of this run."""
        return f"http://{self.hosts[0]}/?token={self.token}"

    def __call__(self, environ: WSGIEnvironment, start_response: Callable[..., Any]) -> Iterable[bytes]:
        """Answer one request as WSGI has it."""
        request = Request(environ)
        try:
            response = self.answer(request)
        except Refusal as refusal:
            response = _refused(request, str(refusal), refusal.status)
        except FeederError as fault:
            response = _refused(request, in_words_of_the_page(" ".join(fault.lines)), 422)
        except OSError as fault:  # a full disk
            what = f"cannot be kept ({fault.strerror or 'no answer of the disk'})"
            response = _refused(request, f"the folder of this run: {what} - make room on the disk", 507)
        except MemoryError:
            response = _refused(request, "the memory of this machine: is full - send a smaller file", 507)
        except HTTPException as fault:
            response = _refused(request, f"{fault.name} - reload the page", fault.code or 400)
        for name, value in GUARD.items():
            response.headers[name] = value
        return response(environ, start_response)

    def answer(self, request: Request) -> Response:
        """Return the answer to a request.

        Parameters
        ----------
        request : Request
            Of werkzeug. It needs the token of this run, one of ``hosts``, and to be sent from a page of this
            server.

        Returns
        -------
        Response

        Raises
        ------
        Refusal
            If it may not ask, or cannot be answered.
        FeederError
            If a file is at fault.
        """
        words = self._admit(request).strip("/").split("/")
        match request.method, words:
            case "GET", [""]:
                return self.start_page()
            case "GET", ["state"]:
                return _json(self.state())
            case "POST", ["part"]:  # a new file
                data = _body(request, PART_BYTES, "a part file", "export it with fewer facets")
                name, units = (request.args.get(key, "") for key in ("name", "units"))
                return _json(self.uploads.take(name, units or UNITS[0], data, self._needed()).document)
            case "POST", ["part", key]:  # the same file in another unit
                upload = self.uploads.read_again(key, request.args.get("units", ""), self._needed())
                return _json(upload.document)
            case "POST", ["bowl"]:  # the file of a bowl at hand
                data = _body(request, BOWL_BYTES, "a bowl file", "leave out what is no bowl file")
                return _json(self.uploads.take_bowl(request.args.get("name", ""), data).document)
            case "GET", ["aspects", key]:
                return Response(self.uploads.find(key).view(), mimetype="text/html")
            case "POST", ["design"]:
                return self.start_design(request)
            case "GET", ["design", key]:
                return _json(self.progress(self._design(key)))
            case "POST", ["design", key, "stop"]:  # as Ctrl-C would
                job = self._design(key)
                if not job.is_running:
                    raise Refusal(409, "that design is at its end - start another")
                job.stop()
                return _json(self.progress(job))
            case "GET", ["design", key, "folder.zip"]:
                return self.zipped(self._design(key))
            case "GET", ["design", key, "files", *name] if name:
                return self.file(self._design(key), "/".join(name))
        raise Refusal(404, "there is no such page - open the address that feeder serve printed")

    def _admit(self, request: Request) -> str:
        """Return the path that is asked for, without the token. Raises Refusal where one may not ask."""
        # a page elsewhere may let its own name lead to this machine
        host = request.environ.get("HTTP_HOST", "")
        if host not in self.hosts:
            raise Refusal(421, f"another host is named - open http://{self.hosts[0]}/")
        path, given = request.path, request.headers.get(TOKEN_HEADER, "")
        if request.method == "GET" and path.startswith(TOKEN_PATH):
            given, _, rest = path.removeprefix(TOKEN_PATH).partition("/")
            path = f"/{rest}"
        elif request.method == "GET" and not given:
            given = request.args.get("token", "")
        if not hmac.compare_digest(given.encode(), self.token.encode()):
            raise Refusal(403, NO_TOKEN)
        if request.method == "POST" and request.headers.get("Origin") not in [
            f"http://{h}" for h in self.hosts
        ]:
            raise Refusal(403, "sent from another page - use the page of feeder serve")
        return path

    def start_page(self) -> Response:
        """Return the page of the job."""
        text = resources.files("feederscrew.jobs.serving").joinpath("start.html").read_text(encoding="utf-8")
        values = {
            "token": self.token,
            "endings": [f".{ending}" for ending in ENDINGS],
            "units": UNITS,
            "materials": [material.name for material in MATERIALS],
            "machines": [[name, label] for name, (label, _) in MACHINES.items()],
            "outcomes": list(OUTCOMES.items()),
            "uses": [[use, use.label] for use in MayUse],
            "headings": [
                [ANY_HEADING, "any heading"],
                [BEST_HEADING, "one heading, the best"],
            ],
            "bytes": PART_BYTES,
        }
        filled = text.replace("{{values}}", json.dumps(values).replace("<", "\\u003c"))
        return Response(filled, mimetype="text/html")

    def state(self) -> Document:
        """Return what is here: parts, designs, and the id of the one at work."""
        running = [job.id for job in self.designs.values() if job.is_running]
        return {
            "parts": [upload.document for upload in self.uploads.kept.copy().values()],
            "designs": [job.document() for job in self.designs.copy().values()],
            "running": running[0] if running else None,
        }

    def progress(self, job: DesignJob) -> Document:
        """Return everything that the page shows of a design.

        Parameters
        ----------
        job : DesignJob

        Returns
        -------
        dict of str to object
            As JSON has it: ``DesignJob.progress`` and the links to the files of the result, by their names.
        """
        files = [name for name in job.files() if name]
        links = {name: f"{TOKEN_PATH}{self.token}/design/{job.id}/files/{quote(name)}" for name in files}
        return {**job.progress(), "files": links}

    def start_design(self, request: Request) -> Response:
        """Start a design of a part that is here.

        Parameters
        ----------
        request : Request
            Its body, as JSON: the values of the page's fields, or ``after``, the id of a design, and
            ``step``, the place of one of its steps to try.

        Returns
        -------
        Response
            The progress of the new design, as JSON.

        Raises
        ------
        Refusal
            If a value is not of its list, a rate is out of range, the part is not here, the step is not one
            of its design, or a design is running.
        """
        try:
            values = json.loads(_body(request, VALUES_BYTES, "the request", "use the page of feeder serve"))
        except (ValueError, RecursionError):
            values = None
        if not isinstance(values, dict):
            raise Refusal(400, "the values of the design are not JSON - use the page of feeder serve")
        if "after" in values:
            order = self._design(str(values["after"])).order_after(values.get("step"))
        else:
            bowl = values.get("bowl")
            own_bowl = None if bowl is None else self.uploads.find_bowl(bowl)
            order = PageOrder.of(values, self.uploads.find(values.get("part")), own_bowl)
        with self._alone():
            if any(job.is_running for job in self.designs.values()):
                raise Refusal(409, "a design is running - stop it first")
            number = next(self._numbers)
            if number > MOST_DESIGNS:
                raise Refusal(429, f"{MOST_DESIGNS} designs were made in this run - start feeder serve again")
            if self.guard is None:
                self.guard = Guard(self.folder)
            folder = self.folder / "designs" / str(number)
            job = DesignJob(str(number), self.program, order, folder, self.guard.tell)
            self.designs[job.id] = job
        return _json(self.progress(job))

    def file(self, job: DesignJob, name: str) -> Response:
        """Return one file of a result, looked up by its name among those that are there.

        Parameters
        ----------
        job : DesignJob
        name : str
            Its path below the folder of the part, with '/'.

        Returns
        -------
        Response
            To be saved, unless it is of ``KINDS``, which a browser shows.

        Raises
        ------
        Refusal
            If the result has no such file.
        """
        files = job.files()
        if name not in files:
            raise Refusal(404, "the result has no such file - see the list on the page")
        kind = KINDS.get(name.rpartition(".")[2].lower())
        response = Response(files[name].read_bytes(), content_type=kind or "application/octet-stream")
        if kind is None:
            response.headers["Content-Disposition"] = "attachment"
        return response

    def zipped(self, job: DesignJob) -> Response:
        """Return the whole folder of a result, zipped.

        Parameters
        ----------
        job : DesignJob

        Returns
        -------
        Response
            An archive named after the part.

        Raises
        ------
        Refusal
            If there is no result yet.
        """
        files = job.files()
        if not files:
            raise Refusal(404, "there is no result yet - start a design and wait for its end")
        stem = job.order.upload.path.stem
        packed = io.BytesIO()
        with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as archive:
            for name, path in files.items():
                archive.write(path, f"{stem}/{name}")
        response = Response(packed.getvalue(), mimetype="application/zip")
        named = f'attachment; filename="{stem.encode("ascii", "replace").decode().replace("?", "_")}.zip"'
        response.headers["Content-Disposition"] = f"{named}; filename*=UTF-8''{quote(stem)}.zip"
        return response

    def close(self) -> None:
        """End a design that is running."""
        for job in self.designs.values():
            job.end()
        if self.guard is not None:
            self.guard.close()

    def _design(self, key: str) -> DesignJob:
        job = self.designs.get(key)
        if job is None:
            raise Refusal(404, NO_DESIGN)
        return job

    def _needed(self) -> frozenset[str]:
        """Ids of the parts that designs are of."""
        return frozenset(job.order.upload.id for job in self.designs.copy().values())

    @contextlib.contextmanager
    def _alone(self) -> Iterator[None]:
        if not self._one_at_a_time.acquire(timeout=WAIT_S):
            raise Refusal(409, "another request is at work - wait for its end")
        try:
            yield
        finally:
            self._one_at_a_time.release()


def _json(document: object, status: int = 200) -> Response:
    return Response(json.dumps(document), status=status, mimetype="application/json")


def _refused(request: Request, line: str, status: int) -> Response:
    """A line that says why: as JSON to the script of the page, as text to who opens an address."""
    if request.method == "GET" and "text/html" in request.headers.get("Accept", ""):
        return Response(f"{printable(line)}\n", status=status, mimetype="text/plain")
    return _json({"error": printable(line)}, status)


def _body(request: Request, most: int, what: str, mend: str) -> bytes:
    """The bytes that were sent, as many as were announced, and no more than there may be."""
    length = request.content_length
    if length is None:
        raise Refusal(411, f"{what}: its length is not said - use the page of feeder serve")
    if length > most:
        raise Refusal(413, f"{what}: has more than {most // 2**10} KiB - {mend}")
    data = bytearray()
    with contextlib.suppress(ClientDisconnected, OSError):  # what came counts
        while len(data) < length and (more := request.stream.read(length - len(data))):
            data += more
    if len(data) < length:
        raise Refusal(400, f"{what}: only {len(data)} of {length} bytes came - send it again")
    if not data:
        raise Refusal(400, f"{what}: is empty - send another")
    return bytes(data)
