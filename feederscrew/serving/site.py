"""The pages and answers of ``feeder serve``: who may ask, what may be sent; one part, one design at a time.

Every request is refused that does not name this machine as its host, has no token of this run, or changes
something and comes from another origin. The name of an uploaded file is shown and never used as a path.
"""

import contextlib
import hmac
import io
import json
import os
import secrets
import shutil
import signal
import subprocess
import threading
import zipfile
from collections import deque
from collections.abc import Callable, Iterable, Iterator, Sequence
from importlib import resources
from pathlib import Path
from typing import Any

from werkzeug.exceptions import HTTPException
from werkzeug.wrappers import Request, Response

from feederscrew.errors import FeederError, printable
from feederscrew.output import aspects as aspects_output
from feederscrew.output.page.as_html import html
from feederscrew.output.page.blocks import Chapter, Page, Table
from feederscrew.output.report import aspect_views
from feederscrew.part import load
from feederscrew.part.density import MATERIALS
from feederscrew.part.formats import CARD_FORMAT, MESH_FORMATS
from feederscrew.studies.aspects import aspects

HOST = "127.0.0.1"
NAMES = (HOST, "localhost")  # of this machine, as a browser may write them
COOKIE = "feeder"
PART_BYTES, VALUES_BYTES = 64 * 2**20, 4096  # that a part file and the values of a design may have
MOST_UPLOADS = 200  # part files of one run
ENDINGS = tuple(
    suffix for name, form in MESH_FORMATS.items() if name != CARD_FORMAT for suffix in form.suffixes
)
UNITS = ("mm", "cm", "m", "um", "in")
MACHINES = {  # what a reader chooses: label, and the options of the design
    "50": ("leaf springs, 50 Hz mains", ("--drive", "leaf-spring", "--set", "machine.mains=50 Hz")),
    "60": ("leaf springs, 60 Hz mains", ("--drive", "leaf-spring", "--set", "machine.mains=60 Hz")),
    "two": ("two-axis drive", ("--drive", "two-axis")),
}
RATES = (0.1, 3000.0)  # [1/min] that may be asked for
NAME_LETTERS = 80  # of a file name that is shown
NO_PART = "there is no part yet - drop a part file on the page"
KINDS = {  # of the files of a result, by their ending; others are saved
    "html": "text/html; charset=utf-8", "png": "image/png", "svg": "image/svg+xml",
    "pdf": "application/pdf", "csv": "text/csv; charset=utf-8", "json": "application/json",
    "yaml": "text/plain; charset=utf-8",
}  # fmt: skip
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
LINES_SHOWN = 400  # of what a design says
STOPPED = 130  # exit status of a design that was stopped, as the command line has it
STOP_WITHIN_S, KILL_WITHIN_S = 20.0, 5.0  # after an interrupt and after a termination


class Refusal(Exception):
    """A request that is not answered: its status and one line that says why and how to mend it."""

    def __init__(self, status: int, line: str) -> None:
        super().__init__(line)
        self.status = status


class Site:
    """The WSGI application of one run.

    All that is uploaded and computed is below ``folder``; whoever made it removes it. ``program`` runs
    ``feeder``: ``design`` and its arguments follow.
    """

    def __init__(self, folder: Path, program: Sequence[str]) -> None:
        self.folder, self.program = folder, tuple(program)
        self.token, self.port = secrets.token_urlsafe(24), 0
        self.part: Path | None = None
        self.view = ""
        self.uploads = 0
        self.job: DesignJob | None = None
        self._one_at_a_time = threading.Lock()

    @property
    def address(self) -> str:
        """The address to open, with the token of this run."""
        return f"http://{HOST}:{self.port}/?token={self.token}"

    def __call__(self, environ: dict[str, Any], start_response: Callable[..., Any]) -> Iterable[bytes]:
        """Answer one request as WSGI has it."""
        request = Request(environ)
        try:
            response = self.answer(request)
        except Refusal as refusal:
            response = _json({"error": str(refusal)}, refusal.status)
        except FeederError as fault:
            response = _json({"error": " ".join(fault.lines)}, 422)
        except HTTPException as fault:
            response = _json({"error": f"{fault.name} - reload the page"}, fault.code or 400)
        for name, value in GUARD.items():
            response.headers[name] = value
        return response(environ, start_response)

    def answer(self, request: Request) -> Response:
        """Return the answer to a request.

        Raises Refusal where it may not ask or cannot be answered, FeederError where a file is at fault.
        """
        response = self._admit(request)
        if response is not None:
            return response
        match request.method, request.path:
            case "GET", "/":
                return self.start_page()
            case "POST", "/part":
                return self.take_part(request)
            case "GET", "/aspects":
                if self.part is None:
                    raise Refusal(409, NO_PART)
                return Response(self.view, mimetype="text/html")
            case "POST", "/design":
                return self.start_design(request)
            case "GET", "/progress":  # state and last lines of the design
                if self.job is None:
                    return _json({"state": "none", "lines": [], "files": []})
                names = [name for name in self.job.files() if name]
                lines = [printable(line).replace(str(self.folder), "") for line in self.job.lines]
                return _json({"state": self.job.state, "lines": lines, "files": names})
            case "POST", "/stop":  # as Ctrl-C would
                if self.job is None or not self.job.is_running:
                    raise Refusal(409, "no design is running - start one")
                self.job.stop()
                return _json({"state": self.job.state})
            case "GET", "/folder.zip":
                return self.zipped()
            case "GET", path if path.startswith("/result/"):
                return self.result(path.removeprefix("/result/"))
        raise Refusal(404, "there is no such page - open / instead")

    def _admit(self, request: Request) -> Response | None:
        """Refuse who may not ask; answer the first request of a run, which takes the token as a cookie."""
        # a page elsewhere may let its own name lead to this machine
        host = request.environ.get("HTTP_HOST", "")
        if host not in [f"{name}:{self.port}" for name in NAMES]:
            raise Refusal(421, f"another host is named - open http://{HOST}:{self.port}/")
        if request.method == "GET" and request.path == "/" and "token" in request.args:
            if not hmac.compare_digest(request.args["token"].encode(), self.token.encode()):
                raise Refusal(403, "that is not the token of this run - open the address that was printed")
            # the cookie has the token from now on: it leaves the address
            response = Response(status=303, headers={"Location": "/"})
            response.set_cookie(COOKIE, self.token, httponly=True, samesite="Strict")
            return response
        if not hmac.compare_digest(request.cookies.get(COOKIE, "").encode(), self.token.encode()):
            raise Refusal(403, "no token of this run - open the address that feeder serve printed")
        if request.method == "POST" and request.headers.get("Origin") != f"http://{host}":
            raise Refusal(403, "sent from another page - use the page of feeder serve")
        return None

    def start_page(self) -> Response:
        """Return the page of the job."""
        text = resources.files("feederscrew.serving").joinpath("start.html").read_text(encoding="utf-8")
        values = {
            "endings": [f".{ending}" for ending in ENDINGS],
            "units": UNITS,
            "materials": [material.name for material in MATERIALS],
            "machines": [[name, label] for name, (label, _) in MACHINES.items()],
            "bytes": PART_BYTES,
        }
        filled = text.replace("{{values}}", json.dumps(values).replace("<", "\\u003c"))
        return Response(filled, mimetype="text/html")

    def take_part(self, request: Request) -> Response:
        """Read a part file, find its aspects, and keep both; the name only says how it is read and shown."""
        name = printable(request.args.get("name", ""))[-NAME_LETTERS:]
        stem, _, ending = name.lower().rpartition(".")
        units = request.args.get("units", "mm")
        if not stem or ending not in ENDINGS:
            raise Refusal(415, f"{name}: not a part file - give one that ends in .{', .'.join(ENDINGS)}")
        if units not in UNITS:
            raise Refusal(400, f"units {units} - choose one of {', '.join(UNITS)}")
        data = _body(request, PART_BYTES, "a part file", "export it with fewer facets")
        with self._alone():
            if self.uploads >= MOST_UPLOADS:
                raise Refusal(429, f"{MOST_UPLOADS} files were sent in this run - start feeder serve again")
            self.uploads += 1
            # forget the part before: its file, its view and its design
            if self.job is not None and self.job.is_running:
                raise Refusal(409, "a design is running - stop it first")
            if self.part is not None:
                self.part.unlink(missing_ok=True)
            self.part, self.view, self.job = None, "", None
            shutil.rmtree(self.folder / "results", ignore_errors=True)
            path = self.folder / f"part.{ending}"
            path.write_bytes(data)
            try:
                study = aspects(load(str(path), units=units))
                table = aspects_output.aspects(study).only(("aspect", "lies", "stable", "height_mm"))
                blocks = *aspect_views(study.part, study), Table(table)
                chapter = Chapter(blocks, warnings=tuple(study.aspects.warnings))
                view = html(Page(name, "", (chapter,), "aspects"))
            except FeederError as fault:
                path.unlink()
                raise Refusal(422, " ".join(fault.lines).replace(str(path), name)) from fault
            self.part, self.view = path, view
        return _json({"name": name, "aspects": list(study.aspects.names)})

    def start_design(self, request: Request) -> Response:
        """Start a design of the part that is here.

        Raises Refusal where a value is not of its list or a rate is out of RATES.
        """
        try:
            values = json.loads(_body(request, VALUES_BYTES, "the request", "use the page of feeder serve"))
        except ValueError:
            values = None
        if not isinstance(values, dict):
            raise Refusal(400, "the values of the design are not JSON - use the page of feeder serve")
        material, machine, units = (values.get(name) for name in ("material", "machine", "units"))
        rate = values.get("rate")
        if material not in [density.name for density in MATERIALS]:
            raise Refusal(400, "material is not one of the list - choose one")
        if machine not in list(MACHINES):
            raise Refusal(400, "machine is not one of the list - choose one")
        if units not in UNITS:
            raise Refusal(400, f"units are not of the list - choose one of {', '.join(UNITS)}")
        if isinstance(rate, bool) or not isinstance(rate, (int, float)) or not RATES[0] <= rate <= RATES[1]:
            raise Refusal(400, f"rate is not from {RATES[0]:g} to {RATES[1]:g} parts a minute - give another")
        options = "--target", f"{rate:g}/min", "--density", material, "--units", units
        with self._alone():
            if self.part is None:
                raise Refusal(409, NO_PART)
            if self.job is not None and self.job.is_running:
                raise Refusal(409, "a design is running - stop it first")
            results = self.folder / "results"
            shutil.rmtree(results, ignore_errors=True)
            results.mkdir()
            design = "design", str(self.part), *options, *MACHINES[machine][1], "-o", str(results)
            self.job = DesignJob([*self.program, *design], results)
        return _json({"state": self.job.state})

    def result(self, name: str) -> Response:
        """Return one file of the result, looked up by its name among those that are there."""
        files = self.job.files() if self.job is not None else {}
        if name not in files:
            raise Refusal(404, "the result has no such file - see the list on the page")
        kind = KINDS.get(name.rpartition(".")[2].lower())
        response = Response(files[name].read_bytes(), content_type=kind or "application/octet-stream")
        if kind is None:
            response.headers["Content-Disposition"] = "attachment"
        return response

    def zipped(self) -> Response:
        """Return the whole folder of the result."""
        files = self.job.files() if self.job is not None else {}
        if not files:
            raise Refusal(404, "there is no result yet - start a design and wait for its end")
        packed = io.BytesIO()
        with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as archive:
            for name, path in files.items():
                archive.write(path, f"design/{name}")
        response = Response(packed.getvalue(), mimetype="application/zip")
        response.headers["Content-Disposition"] = 'attachment; filename="design.zip"'
        return response

    def close(self) -> None:
        """End a design that is running."""
        if self.job is not None:
            self.job.end()

    @contextlib.contextmanager
    def _alone(self) -> Iterator[None]:
        if not self._one_at_a_time.acquire(blocking=False):
            raise Refusal(409, "another request is at work - wait for its end")
        try:
            yield
        finally:
            self._one_at_a_time.release()


def _json(document: object, status: int = 200) -> Response:
    return Response(json.dumps(document), status=status, mimetype="application/json")


def _body(request: Request, most: int, what: str, mend: str) -> bytes:
    """The bytes that were sent, read no further than they may be."""
    length = request.content_length
    if length is None:
        raise Refusal(411, f"the length of {what} is not said - use the page of feeder serve")
    if length > most:
        raise Refusal(413, f"{what} has more than {most // 2**10} KiB - {mend}")
    data = request.stream.read(most + 1)
    if not 0 < len(data) <= most:
        raise Refusal(413 if data else 400, f"{what} is empty or too large - {mend}")
    return data


class DesignJob:
    """A command that designs, with what it says and the files it leaves in a folder of results."""

    def __init__(self, command: Sequence[str], results: Path) -> None:
        self.results = results
        self._lines: deque[str] = deque(maxlen=LINES_SHOWN)
        self._stop_asked = False
        self._process = subprocess.Popen(
            list(command),
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            errors="replace",
            cwd=results.parent,
            start_new_session=True,  # Ctrl-C in the terminal of the server reaches the server alone
            env={**os.environ, "NO_COLOR": "1"},
        )
        self._reader = threading.Thread(target=self._read, daemon=True)
        self._reader.start()

    def _read(self) -> None:
        output = self._process.stdout
        if output is not None:
            with output:
                self._lines.extend(line.rstrip() for line in output)

    @property
    def is_running(self) -> bool:
        """Whether it is still at work."""
        return self._process.poll() is None

    @property
    def lines(self) -> list[str]:
        """The last lines that it said."""
        if not self.is_running:
            self._reader.join(timeout=1.0)
        return list(self._lines)

    @property
    def state(self) -> str:
        """'running', 'stopping', 'done', 'stopped' or 'failed'."""
        if self.is_running:
            return "stopping" if self._stop_asked else "running"
        if self._process.returncode == 0:
            return "done"
        return "stopped" if self._stop_asked or self._process.returncode == STOPPED else "failed"

    def files(self) -> dict[str, Path]:
        """Return the files that it left, by their path below the folder of its part; empty while it runs."""
        if self.is_running:
            return {}
        return {
            "/".join(path.relative_to(self.results).parts[1:]): path
            for path in sorted(self.results.rglob("*"))
            if path.is_file() and not path.is_symlink()
        }

    def stop(self) -> None:
        """Ask it to end, as Ctrl-C does."""
        self._stop_asked = True
        self._signal(signal.SIGINT)

    def end(self) -> None:
        """End it and whatever it has started, within some seconds."""
        for ending, seconds in ((signal.SIGTERM, STOP_WITHIN_S), (signal.SIGKILL, KILL_WITHIN_S)):
            if not self.is_running:
                break
            self._stop_asked = True
            self._signal(ending)
            with contextlib.suppress(subprocess.TimeoutExpired):
                self._process.wait(seconds)
        self._reader.join(timeout=1.0)

    def _signal(self, number: int) -> None:
        with contextlib.suppress(ProcessLookupError):
            if self.is_running:
                os.killpg(self._process.pid, number)
