"""``feeder serve``: what is refused, one job at a time, and the main flow in a browser."""

import contextlib
import errno
import io
import json
import os
import shlex
import signal
import socket
import subprocess
import sys
import threading
import time
import zipfile
from pathlib import Path

import pytest
from command_lines import BRACKET, asked_by
from design_counts import attempt, design_of_nothing
from devtools import Browser

pytest.importorskip("werkzeug", reason="needs werkzeug: pip install 'feederscrew[serve]'")

from werkzeug.test import Client

from feederscrew.designing.next_tries import TryKind
from feederscrew.designing.record import NearestDesign
from feederscrew.jobs.serving import server, uploads
from feederscrew.jobs.serving.orders import PageOrder
from feederscrew.jobs.serving.refusal import in_words_of_the_page
from feederscrew.jobs.serving.server import BoundedServer
from feederscrew.jobs.serving.site import Site
from feederscrew.output import designs
from feederscrew.part import load

HOST = "127.0.0.1:8000"
WEDGE = b"OFF\n4 4 0\n0 0 0\n20 0 0\n0 10 0\n0 0 5\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n"
OWN = {"Host": HOST, "Origin": f"http://{HOST}"}
VALUES = {"material": "steel", "machine": "50", "rate": 60}
WRITES = """
import json, pathlib, sys
rate = float(sys.argv[sys.argv.index("--target") + 1].removesuffix("/min"))
answer = {"status": "holds", "why": "all fills do", "wanted": "A@90", "delivered_per_minute": 70.0}
if rate > 60:
    step = {"label": "try first", "why": "57/min holds", "options": {"--target": "57/min"}, "settings": {}}
    answer = {"status": "falls short", "why": "too slow", "wanted": "A@90", "next": [step]}
folder = pathlib.Path(sys.argv[-1]) / pathlib.Path(sys.argv[2]).stem
folder.mkdir()
(folder / "design.html").write_text("<h1>holds</h1>")
(folder / "design.json").write_text(json.dumps(answer))
(folder / "tooling.step").write_text("ISO")
print("trial 1 of 1:", *sys.argv[1:-1], flush=True)
"""
WAITS = """
import json, os, pathlib, sys, time
stage = {"stage": "trial", "text": "trial 2 of 16", "gone_s": 30.0, "to_go_s": 90.0}
pathlib.Path(os.environ["FEEDER_STAGE_FILE"]).write_text(json.dumps(stage))
try:
    print("begun", flush=True)
    time.sleep(60)
except KeyboardInterrupt:
    print("Stopped.", flush=True)
    sys.exit(130)
"""


@pytest.fixture
def site(tmp_path):
    """A site whose design is a small program."""
    made = Site(tmp_path / "run", (sys.executable, "-c", WRITES))
    made.port = 8000
    yield made
    made.close()


class Page:
    """The page of one tab: its requests have the token in a header."""

    def __init__(self, site):
        self.site, self.client, self.own = site, Client(site), {**OWN, "X-Feeder-Token": site.token}

    def get(self, path, **own):
        return self.client.get(path, headers={**self.own, **own})

    def post(self, path, data=None, query=None, **own):
        return self.client.post(path, data=data, query_string=query, headers={**self.own, **own})

    def send(self, name="wedge.off", data=WEDGE, units="mm"):
        return self.post("/part", data, {"name": name, "units": units})

    def order(self, part, **other):
        return self.post("/design", json.dumps(VALUES | {"part": part} | other))

    def ended(self, design):
        """What is told of a design once it has ended."""
        for _ in range(400):
            told = self.get(f"/design/{design}").get_json()
            if told["state"] not in ("running", "stopping"):
                return told
            time.sleep(0.02)
        raise AssertionError(told)


@pytest.fixture
def page(site):
    return Page(site)


def test_who_may_not_ask_is_refused(site, page):
    stranger = Client(site)
    for path in (
        "/",
        "/state",
        "/aspects/1",
        "/design/1",
        "/design/1/folder.zip",
        "/design/1/files/design.html",
    ):
        assert stranger.get(path, headers=OWN).status_code == 403
        assert stranger.get(f"/token/wrong{path}", headers=OWN).status_code == 403
        stranger.set_cookie("feeder", site.token)  # a cookie is no token: it knows no port
        assert stranger.get(path, headers=OWN).status_code == 403
    assert stranger.get("/?token=wrong", headers=OWN).status_code == 403
    for host in ("evil.example", "evil.example:8000", "127.0.0.1", "127.0.0.1:8001", ""):
        assert page.get("/", Host=host).status_code == 421
    for origin in ("http://evil.example", "null", "https://127.0.0.1:8000", "http://127.0.0.1:8001", ""):
        for path in ("/part", "/part/1", "/design", "/design/1/stop"):
            assert page.post(path, Origin=origin).status_code == 403
    for path in (f"/token/{site.token}/design", f"/design?token={site.token}"):  # a link changes nothing
        assert stranger.post(path, headers=OWN).status_code == 403
    assert page.client.put("/part", headers=page.own).status_code == 404
    for path in (f"/?token={site.token}", f"/token/{site.token}/"):
        answer = stranger.get(path, headers=OWN)
        assert answer.status_code == 200 and "default-src 'none'" in answer.headers["Content-Security-Policy"]
        assert answer.headers["X-Content-Type-Options"] == "nosniff" and "Set-Cookie" not in answer.headers


def test_the_address_of_port_80_answers_as_a_browser_writes_it(site):
    """It leaves the port out: every request was refused."""
    site.port = 80
    for host in ("127.0.0.1", "localhost", "127.0.0.1:80"):
        own = {"Host": host, "Origin": f"http://{host}", "X-Feeder-Token": site.token}
        assert Client(site).get(site.address.removeprefix("http://127.0.0.1"), headers=own).status_code == 200
        assert Client(site).post("/design", data="{}", headers=own).status_code == 409


def test_an_upload_is_bounded_has_the_ending_of_a_part_and_its_name_is_no_path(page, site, monkeypatch):
    """It is shown without control characters; the name of its file is made of letters of it."""
    for name in ("a.exe", "stl", "card.yaml", "a.stl.zip", ""):
        answer = page.send(name)
        assert answer.status_code == 415 and "not a part file" in answer.get_json()["error"]
    answer = page.send("../../x/\x1b[31m<b>evil</b>.off")
    assert answer.status_code == 200 and "\x1b" not in answer.get_json()["name"]
    (file,) = site.folder.rglob("*.off")
    assert file.parent.parent == site.folder / "parts" and set(file.stem).isdisjoint("/\\<>")
    assert "<b>evil" not in page.get(f"/aspects/{answer.get_json()['id']}").get_data(as_text=True)
    for name in ("-o.off", ".hidden.off", "%s.off" % ("ü" * 79)):
        sent = page.send(name).get_json()
        own = site.uploads.find(sent["id"]).path
        assert own.name[0] not in "-." and len(os.fsencode(own.name)) < 160
    monkeypatch.setattr("feederscrew.jobs.serving.site.PART_BYTES", 1000)
    assert page.send(data=b"x" * 1001).status_code == 413
    assert page.send(data=b"").status_code in (400, 411)
    monkeypatch.setattr(uploads, "MOST_UPLOADS", 6)
    assert [page.send(data=b"solid none").status_code for _ in range(3)] == [422, 422, 429]


def test_what_cannot_be_read_or_kept_is_one_line_and_leaves_what_is_there(page, site, monkeypatch):
    """A file that could not be read deleted the part before it, and its finished design."""
    part = page.send().get_json()
    made = page.ended(page.order(part["id"]).get_json()["id"])
    before = page.get("/state").get_json()
    assert before["parts"] == [part] and [one["id"] for one in before["designs"]] == [made["id"]]

    def refused(status, answer):
        line = answer.get_json()["error"]
        assert answer.status_code == status and "\n" not in line and " - " in line
        assert page.get("/state").get_json() == before
        assert len(list((site.folder / "parts").iterdir())) == 1 and str(site.folder) not in line
        return line

    assert refused(422, page.send("damaged.stl", b"solid none")).startswith("damaged.stl: ")
    for values in ("[" * 4000, "[", "{" * 4000, b"\xff", "3"):
        assert "not JSON" in refused(400, page.post("/design", values))
    short = {"environ_overrides": {"CONTENT_LENGTH": "5000"}, "headers": page.own}
    answer = page.client.post("/part?name=wedge.off&units=mm", data=WEDGE[:3], **short)
    assert "only 3 of 5000 bytes came" in refused(400, answer)

    def full(path, *_, **__):
        path.touch()
        raise OSError(errno.ENOSPC, "No space left on device", str(path))

    with monkeypatch.context() as patch:
        patch.setattr(Path, "write_bytes", full)
        assert "No space left on device" in refused(507, page.send("other.off"))
    with monkeypatch.context() as patch:
        patch.setattr(Path, "write_text", full)  # of the views
        refused(507, page.send("other.off"))
    with monkeypatch.context() as patch:
        patch.setattr(subprocess, "Popen", lambda *_, **own: full(own["cwd"] / "x"))
        refused(507, page.order(part["id"]))
    assert [path.name for path in (site.folder / "designs").iterdir()] == [made["id"]]


def test_a_request_names_its_part_and_a_result_is_of_it(page, site):
    """The nut's tab designed the washer of the other; inches that were chosen later were designed as mm."""
    other_tab = Page(site)
    nut, washer = page.send("nut.off").get_json(), other_tab.send("washer 6.off").get_json()
    in_inches = page.post(f"/part/{nut['id']}", query={"units": "in"}).get_json()
    assert (in_inches["name"], in_inches["units"]) == ("nut.off", "in") and in_inches["id"] != nut["id"]
    assert in_inches["size_mm"] == pytest.approx([25.4 * size for size in nut["size_mm"]])
    assert page.post(f"/part/{nut['id']}", query={"units": "mm"}).get_json() == nut
    for part, tab in ((nut, page), (washer, other_tab), (in_inches, page)):
        told = tab.ended(tab.order(part["id"]).get_json()["id"])
        assert told["part"] == part and told["status"] == "holds"
        assert (
            f"design {part['name']} --target 60/min --density steel --units {part['units']}"
            in told["lines"][0]
        )
        packed = tab.get(f"/design/{told['id']}/folder.zip")
        stem = part["name"].removesuffix(".off")
        assert f'"{stem}.zip"' in packed.headers["Content-Disposition"]
        names = zipfile.ZipFile(io.BytesIO(packed.get_data())).namelist()
        assert names == [f"{stem}/{name}" for name in ("design.html", "design.json", "tooling.step")]
    state = page.get("/state").get_json()
    assert [one["part"]["name"] for one in state["designs"]] == ["nut.off", "washer 6.off", "nut.off"]
    assert state["running"] is None


def test_old_parts_go_once_all_take_too_much_room_but_for_those_of_designs(page, site, monkeypatch):
    first, second = (page.send(f"{name}.off").get_json() for name in "ab")
    page.ended(page.order(first["id"]).get_json()["id"])
    monkeypatch.setattr(uploads, "KEPT_BYTES", len(WEDGE) + 1)
    third = page.send("c.off").get_json()
    assert page.get("/state").get_json()["parts"] == [first, third]
    assert page.order(second["id"]).status_code == page.get(f"/aspects/{second['id']}").status_code == 409


def test_a_design_takes_what_the_page_offers_is_run_and_its_folder_read(page, site):
    part = page.send().get_json()
    assert part["aspects"] == ["A", "B", "C", "D"] and part["size_mm"] == pytest.approx([20.0, 10.0, 5.0])
    wrong = [{"rate": rate} for rate in (0, "60; rm", True, 1e9, None)]
    wrong += [{"material": "--output=/"}, {"machine": ["--drive"]}]
    assert {page.order(part["id"], **other).status_code for other in wrong} == {400} and not site.designs
    assert {page.order(other).status_code for other in ("7", None, ["1"], {})} == {409}
    view = page.get(f"/token/{site.token}/aspects/{part['id']}").get_data(as_text=True)
    assert view.count("<canvas") == len(part["aspects"])
    told = page.ended(page.order(part["id"], machine="two").get_json()["id"])
    assert (told["state"], told["status"], told["why"]) == ("done", "holds", "all fills do")
    assert "--drive two-axis -o" in told["lines"][0] and str(site.folder) not in told["lines"][0]
    assert list(told["files"]) == ["design.html", "design.json", "tooling.step"]
    stranger = Client(site)  # a link has the token in its path
    shown = stranger.get(told["files"]["design.html"], headers={"Host": HOST})
    assert shown.get_data() == b"<h1>holds</h1>" and shown.mimetype == "text/html"
    beside = told["files"]["design.html"].replace("design.html", "tooling.step")
    assert stranger.get(beside, headers={"Host": HOST}).headers["Content-Disposition"] == "attachment"
    for path in ("../part.stl", "%2e%2e/part.stl", "/etc/passwd", ""):
        assert page.get(f"/design/{told['id']}/files/{path}").status_code == 404


CHOSEN = (  # values of the page's fields, and the options that they are; {} is the last heading
    ({}, ""),
    ({"up": "B"}, "--up B"),
    ({"up": "B", "heading": "best"}, "--aspect B"),
    ({"up": "B", "heading": None}, "--aspect B --heading {}deg"),
    ({"outcome": "hanging"}, "--outcome hanging"),
    ({"may_use": ["camera"]}, "--without 'air jet'"),
    ({"may_use": []}, "--without 'air jet,vision reject'"),
    ({"diameter": 250}, "--diameter 250mm:250mm"),
)


def test_what_is_chosen_on_the_page_is_an_option_of_the_command_line(page, run):
    part = page.send().get_json()
    heading = part["headings"]["B"][-1]
    for values, options in CHOSEN:
        chosen = {name: heading if value is None else value for name, value in values.items()}
        told = page.ended(page.order(part["id"], **chosen).get_json()["id"])
        own = f"--units mm {options.format(heading)}".strip()
        assert own.replace("'", "") + " --drive leaf-spring --set machine.mains=50 Hz -o" in told["lines"][0]
        assert told["order"] | chosen == told["order"] and own in told["command"]
        # the command takes it: it asks for the part, which is not there
        words = shlex.split(told["command"])[1:]
        assert run(*words).stderr.splitlines()[-1] == "Error: wedge.off: no such file - check the path"


def test_values_that_the_page_does_not_offer_are_refused(page, site):
    part = page.send().get_json()
    wrong = [
        {"up": "Z"},
        {"up": 3},
        {"up": "A", "heading": "1; rm"},
        {"outcome": "standing"},
        {"heading": "90"},
    ]
    wrong += [{"may_use": ["laser"]}, {"may_use": "air"}, {"diameter": 1e9}, {"diameter": "250"}]
    assert {page.order(part["id"], **values).status_code for values in wrong} == {400}
    assert page.order(part["id"], bowl="7").status_code == 409 and not site.designs


def test_the_file_of_a_bowl_at_hand_is_read_and_goes_into_the_design(page, site):
    bad = page.post("/bowl", b"track: {width: 8}\n", {"name": "mine.yaml"})
    assert bad.status_code == 422 and bad.get_json()["error"].startswith("mine.yaml:1:")
    assert page.post("/bowl", b"{", {"name": "mine.txt"}).status_code == 415
    assert not list(site.folder.rglob("*.yaml"))
    bowl = page.post("/bowl", b"track: {width: 8 mm}\n", {"name": "../mine.yaml"}).get_json()
    told = page.ended(page.order(page.send().get_json()["id"], bowl=bowl["id"]).get_json()["id"])
    path, beside = sorted(site.folder.rglob("*.yaml"), key=lambda one: "designs" in one.parts)
    assert beside.read_bytes() == path.read_bytes()
    assert "--config mine.yaml" in told["lines"][0] and "--config ../mine.yaml" in told["command"]
    assert told["order"]["bowl"] == bowl["id"] and path.parent.parent == site.folder / "parts"


def test_what_falls_short_has_next_steps_that_are_designed_at_a_click(page):
    part = page.send().get_json()["id"]
    assert page.ended(page.order(part).get_json()["id"])["next"] == []
    values = {"rate": 90, "may_use": ["air"], "up": "A", "heading": "best", "outcome": "lying"}
    short = page.ended(page.order(part, **values).get_json()["id"])
    assert (short["status"], short["why"]) == ("falls short", "too slow")
    assert short["next"] == ["try first: 57/min holds"]
    for step in (1, -1, True, "0", None):
        assert page.post("/design", json.dumps({"after": short["id"], "step": step})).status_code == 400
    assert page.post("/design", json.dumps({"after": "7", "step": 0})).status_code == 404
    again = page.post("/design", json.dumps({"after": short["id"], "step": 0})).get_json()
    assert page.ended(again["id"])["order"] == {**short["order"], "rate": 57.0}


def test_a_step_of_the_page_asks_for_what_the_step_of_the_command_line_asks_for(page, site):
    """One source of steps: each order, and the call that is printed for it, is read as the same request."""
    key = page.send().get_json()["id"]
    part, kinds = load(str(site.uploads.find(key).path)), set()
    heading = site.uploads.find(key).headings["A"][-1]
    orders = [
        {},
        {"up": "A", "heading": heading},
        {"up": "B", "heading": "best", "outcome": "lying"},
        {"may_use": ["air"], "diameter": 250, "outcome": "hanging"},
        {"machine": "any", "up": "C", "may_use": []},
    ]
    for values in orders:
        order = PageOrder.of(VALUES | values, site.uploads.find(key))
        for _ in range(3):  # a step after a step
            former = asked_by(shlex.split(order.command))
            near = NearestDesign(0.25, "a calmer drive", wanted="A@0", request=former)
            own, slow = attempt(f"{order.up or 'A'}@0"), attempt("C@0", 20.5, ())
            studies = [
                design_of_nothing(part, own, request=former, call=order.arguments),
                design_of_nothing(part, slow, own, request=former, call=order.arguments, nearest=near),
                design_of_nothing(part, own, request=former, call=order.arguments, partial=True),
                design_of_nothing(part, own, request=former, call=order.arguments, arrivals=()),
            ]
            steps = [step for study in studies for step in designs.document(study)["next"]]
            for step in steps:
                after = order.after(step["options"], step["settings"])
                assert asked_by(shlex.split(after.command)) == asked_by(step["words"]), step
                kinds.add(step["change"])
                beside = step["change"] == TryKind.MORE_TRIALS
                assert bool(after.values["also"]) == (beside or bool(order.values["also"])), step
            order = order.after(steps[0]["options"], steps[0]["settings"])
    assert len(kinds) >= 8, kinds


def test_a_calmer_drive_is_a_step_of_the_page_too(page, site):
    order = PageOrder.of(VALUES, site.uploads.find(page.send().get_json()["id"]))
    calmer = order.after({}, {"drive.amplitude": "0.12 mm"})
    assert "--set 'drive.amplitude=0.12 mm'" in calmer.command
    assert calmer.values == {**order.values, "also": "drive.amplitude 0.12 mm"}
    more = calmer.after({"--trials": "32"}, {"drive.amplitude": "0.1 mm"})
    assert more.values["also"] == "--trials 32 drive.amplitude 0.1 mm"


def test_one_design_at_a_time_and_it_can_be_stopped_and_ends_with_the_server(page, site):
    part = page.send().get_json()["id"]
    site.program = (sys.executable, "-c", WAITS)
    assert page.post("/design/1/stop").status_code == 404
    design = page.order(part).get_json()["id"]
    while (told := page.get(f"/design/{design}").get_json())["lines"] != ["begun"]:
        time.sleep(0.02)
    assert told["stage"]["text"] == "trial 2 of 16" and told["stage"]["to_go_s"] == 90.0
    assert page.order(part).status_code == 409
    assert page.send("other.off").status_code == 200  # it is no part of the design
    assert Page(site).get("/state").get_json()["running"] == design  # as after a reload
    assert page.post(f"/design/{design}/stop").get_json()["state"] in ("stopping", "stopped")
    told = page.ended(design)
    assert told["state"] == "stopped" and told["lines"] == ["begun", "Stopped."]
    assert page.get(f"/design/{design}/folder.zip").status_code == 404
    again = page.order(part).get_json()["id"]
    site.close()  # the end of the server ends a design
    assert not site.designs[again].is_running


def test_a_design_that_fails_says_why_in_words_of_the_page(page, site):
    fault = "Error: {}: needs a bowl of 1710 mm - raise --diameter, or check --units"
    site.program = (sys.executable, "-c", f"import sys; print({fault!r}.format(sys.argv[2])); sys.exit(1)")
    told = page.ended(page.order(page.send("nut.off").get_json()["id"]).get_json()["id"])
    assert (told["state"], told["status"]) == ("failed", None)
    assert told["fault"] == "nut.off: needs a bowl of 1710 mm - check length unit"


@pytest.mark.parametrize(
    ("line", "mend"),
    [
        ("close it in CAD, or pass `allow_open` to compute from what there is", "close it in CAD"),
        ("if the file is in inches, pass `units` in", "if the file is in inches, choose the length unit in"),
        ("take one with `body` (its number, its name, or largest), unite them in CAD", "unite them in CAD"),
        ("feed it by hand, or raise sizing.greatest_diameter", "feed it by hand"),
        ("pass `allow_open`", "mend the file in CAD, and drop it again"),
        ("lower --target, or give --drive two-axis", "lower parts a minute, or choose the machine two-axis"),
    ],
)
def test_a_mend_names_only_what_the_page_offers(line, mend):
    assert (
        in_words_of_the_page(f"a.stl: is open (`allow_open`) - {line}")
        == f"a.stl: is open (allow open) - {mend}"
    )


ASKS = """
import http.client, json, os, pathlib, sys, time
base, token = sys.argv[1:]
own = {"X-Feeder-Token": token, "Origin": base}
def ask(path, body):
    line = http.client.HTTPConnection(base.removeprefix("http://"))
    line.request("POST" if body else "GET", path, body, own)
    return json.loads(line.getresponse().read())
wedge = b"OFF\\n4 4 0\\n0 0 0\\n20 0 0\\n0 10 0\\n0 0 5\\n3 0 2 1\\n3 0 1 3\\n3 1 2 3\\n3 0 3 2\\n"
part = ask("/part?name=wedge.off&units=mm", wedge)["id"]
values = {"part": part, "material": "steel", "machine": "50", "rate": 60}
design = ask("/design", json.dumps(values))["id"]
while not ask(f"/design/{design}", None)["lines"]:
    time.sleep(0.05)
for status in pathlib.Path("/proc").glob("[0-9]*/cmdline"):
    try:
        if b"begun" in status.read_bytes() and int(status.parent.name) != os.getpid():
            words = status.read_bytes().split(b"\\0")
            if b"design" in words:
                print(status.parent.name)
    except OSError:
        pass
"""
PROGRAM = "from feederscrew_cli.main import feeder; feeder(['serve'])"


def begun(tmp_path, code=PROGRAM):
    """A process that serves, and its address."""
    own = {"TMPDIR": str(tmp_path), "PATH": "/usr/bin:/bin"}
    pipe = subprocess.PIPE
    process = subprocess.Popen([sys.executable, "-c", code], stdout=pipe, stderr=pipe, text=True, env=own)
    return process, process.stdout.readline()


def test_the_command_listens_here_alone_ends_with_its_folder_and_names_its_extra(run, tmp_path, monkeypatch):
    """Ctrl-C: status 130 as of every command, no folder left behind."""
    assert "127.0.0.1" in run("serve", "--help").output
    process, address = begun(tmp_path)
    assert address.startswith("http://127.0.0.1:") and "/?token=" in address
    assert len(list(tmp_path.iterdir())) == 1
    process.send_signal(signal.SIGINT)
    _, said = process.communicate(timeout=60)
    assert process.returncode == 130 and said.splitlines()[-1] == "Stopped."
    assert not list(tmp_path.iterdir())
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        result = run("serve", "--port", taken.getsockname()[1])
    assert result.exit_code == 1 and "is taken - give another to --port, or none" in result.output
    monkeypatch.setitem(sys.modules, "werkzeug.serving", None)
    result = run("serve")
    assert result.exit_code == 1 and "pip install 'feederscrew[serve]'" in result.output


@pytest.mark.skipif(not Path("/proc").exists(), reason="asks /proc for processes")
def test_a_server_that_is_killed_takes_its_design_and_its_folder_with_it(tmp_path):
    """After kill -9 the design went on, and the folder stayed."""
    code = (
        f"import feederscrew_cli.serve as s; s.FEEDER_CALL = ({sys.executable!r}, '-c', {WAITS!r})\n{PROGRAM}"
    )
    process, address = begun(tmp_path, code)
    base, token = address.split("/?token=")
    (folder,) = tmp_path.iterdir()
    call = [sys.executable, "-c", ASKS, base, token.strip()]
    design = int(subprocess.run(call, capture_output=True, text=True, check=True).stdout)
    assert Path(f"/proc/{design}").exists() and folder.exists()
    process.kill()
    process.communicate()
    for _ in range(200):
        if not Path(f"/proc/{design}").exists() and not folder.exists():
            break
        time.sleep(0.05)
    assert not Path(f"/proc/{design}").exists() and not list(tmp_path.iterdir())


def test_idle_connections_are_bounded_and_do_not_shut_the_page_out(site, monkeypatch):
    """1,100 of them were 1,100 threads."""
    monkeypatch.setattr(server, "MOST_CONNECTIONS", 8)
    bounded = BoundedServer(site, 0)
    thread = threading.Thread(target=bounded.serve_forever, args=(0.05,))
    thread.start()
    before = threading.active_count()
    idle = []
    try:
        for _ in range(60):
            idle.append(socket.create_connection(("127.0.0.1", site.port), timeout=5))
        with socket.create_connection(("127.0.0.1", site.port), timeout=5) as asking:
            head = f"GET /state HTTP/1.1\r\nHost: {site.hosts[0]}\r\nX-Feeder-Token: {site.token}\r\n\r\n"
            asking.sendall(head.encode())
            assert asking.recv(100).startswith(b"HTTP/1.1 200")
        for _ in range(200):  # those that were closed end
            if threading.active_count() <= before + 8:
                break
            time.sleep(0.02)
        assert threading.active_count() <= before + 8
    finally:
        for one in idle:
            one.close()
        bounded.shutdown()
        thread.join()
        bounded.server_close()


AT = "document.getElementById('{}')"
INSIDE = AT.format("aspects") + ".contentDocument"
OUTLINED = "getComputedStyle(document.activeElement.closest('.file') ?? document.activeElement).outlineStyle"


@contextlib.contextmanager
def served(folder, program):
    """A site that answers a browser."""
    site = Site(folder / "run", (sys.executable, "-c", program))
    made = BoundedServer(site, 0)
    thread = threading.Thread(target=made.serve_forever, args=(0.05,))
    thread.start()
    try:
        yield site
    finally:
        site.close()
        made.shutdown()
        thread.join()
        made.server_close()


@pytest.mark.needs("chromium")
@pytest.mark.parametrize(("width", "dark"), [(390, True), (1280, False)])
def test_the_main_flow_with_the_keyboard_alone(tmp_path, width, dark):
    """A part and a side are chosen; a design falls short, a step to try holds: no mouse, all is legible.

    At the end in the other colours too.
    """
    (tmp_path / "own").mkdir()
    with served(tmp_path / "own", WRITES) as site, Browser(tmp_path / "profile", width, dark=dark) as page:

        def at(name, rest=""):
            return page.evaluate(AT.format(name) + rest)

        def reach(script):
            page.tab_to(script)
            assert page.evaluate(OUTLINED) == "solid", f"{script}: the focus is not seen"

        page.open(site.address)
        reach(AT.format("file"))
        page.choose_by_key(BRACKET)
        page.until(f"{INSIDE}?.querySelector('.has-views .view .up')")
        page.until(f"{INSIDE}.querySelectorAll('.view .up').length >= 5")
        views = page.evaluate(
            f"[...{INSIDE}.querySelectorAll('.view canvas')].map((one) => one.getBoundingClientRect().bottom)"
        )
        assert len(views) >= 5 and max(views) < at("aspects", ".clientHeight"), "the fifth view is cut off"
        # this side up: within the frame of the views
        second = f"{INSIDE}.querySelectorAll('.view .up')[1]"
        for _ in range(60):
            if page.evaluate(f"{INSIDE}.activeElement === {second}"):
                break
            page.press("Tab")
        page.press("Enter")
        assert (at("up", ".value"), at("heading", ".value")) == ("B", "any")
        assert page.evaluate(f"{second}.getAttribute('aria-pressed')") == "true"
        reach(AT.format("rate"))
        page.type("90")
        reach(AT.format("outcome"))
        page.press("ArrowDown")
        reach("document.querySelector('#uses input')")
        page.press(" ")
        fields = "[...document.querySelectorAll('input:not(:disabled), select')]"
        unnamed = page.evaluate(f"{fields}.filter((one) => !one.labels?.length).map((one) => one.id)")
        assert unnamed == [], "a field has no label"
        reach(AT.format("start"))
        page.press("Enter")
        page.until(AT.format("next") + ".firstElementChild?.disabled === false")
        assert (at("state", ".textContent"), at("next", ".textContent")) == (
            "falls short",
            "try first: 57/min holds",
        )
        short = page.evaluate(f"getComputedStyle({AT.format('state')}).color")
        reach(AT.format("next") + ".firstElementChild")
        page.press("Enter")
        page.until(f"{AT.format('state')}.textContent === 'holds' && !{AT.format('result')}.hidden")
        assert page.evaluate(f"getComputedStyle({AT.format('state')}).color") != short
        kept = (at("rate", ".value"), at("outcome", ".value"), at("fault", ".textContent"))
        assert kept == ("57", "lying", "")
        assert "--without 'air jet'" in at("command", ".textContent")
        assert "design.html" in at("files", ".textContent")
        # the results of this run, each with its part
        listed = page.evaluate(f"[...{AT.format('designs')}.children].map((one) => one.textContent)")
        assert [line.partition(" a minute, B up")[0] for line in listed] == [
            "bracket (mm), 57".replace("bracket", BRACKET.name), f"{BRACKET.name} (mm), 90",
        ]  # fmt: skip
        reach(AT.format("designs") + ".children[1].firstElementChild")
        page.press("Enter")
        page.until(f"{AT.format('state')}.textContent === 'falls short'")
        assert page.evaluate("document.documentElement.scrollWidth <= innerWidth"), "it goes off the screen"
        for is_dark in (dark, not dark):
            page.colours(dark=is_dark)
            ratio, words = page.least_contrast("aspects")
            assert ratio >= 4.5, f"{words}: contrast {ratio:.2f}"
        assert page.evaluate("document.cookie") == ""


@pytest.mark.needs("chromium")
def test_the_bar_shows_stage_and_time_and_a_click_turns_and_chooses(tmp_path):
    """While a design runs: a bar with its stage, the time gone and to go, and a button that stops it."""
    (tmp_path / "own").mkdir()
    with served(tmp_path / "own", WAITS) as site, Browser(tmp_path / "profile") as page:
        page.open(site.address)
        page.tab_to(AT.format("file"))
        page.choose_by_key(BRACKET)
        page.until(f"{INSIDE}?.querySelector('.has-views .view .up')")
        seen = f"{INSIDE}.querySelector('.view canvas').toDataURL()"
        before = page.evaluate(seen)
        page.until(f"{seen} !== {json.dumps(before)}")  # the views turn once by themselves
        frame = page.evaluate(f"(({{ x, y }}) => [x, y])({AT.format('aspects')}.getBoundingClientRect())")
        third = page.evaluate(
            f"(({{ x, y, width, height }}) => [x + width / 2, y + height / 2])"
            f"({INSIDE}.querySelectorAll('.view canvas')[2].getBoundingClientRect())"
        )
        place = [a + b for a, b in zip(frame, third)]
        page.click(*place, moved=40)
        assert page.evaluate(AT.format("up") + ".value") == "", "a drag turns the view, and chooses nothing"
        page.click(*place)
        assert page.evaluate(AT.format("up") + ".value") == "C"
        page.evaluate(AT.format("order") + ".requestSubmit()")
        page.until(f"!{AT.format('bar')}.hidden && {AT.format('bar')}.value === 0.25")
        stage = page.evaluate(AT.format("stage") + ".textContent")
        assert stage == "trial 2 of 16, 30 s gone, about 90 s to go if it holds"
        page.press("Enter")  # Stop has the focus
        page.until(f"{AT.format('state')}.textContent === 'stopped' && {AT.format('bar')}.hidden")
