"""``feeder serve``: what is refused, one job at a time, and the main flow in a browser."""

import errno
import io
import json
import os
import shlex
import shutil
import signal
import socket
import subprocess
import sys
import threading
import time
import zipfile
from pathlib import Path

import pytest
from command_lines import BRACKET

pytest.importorskip("werkzeug", reason="needs werkzeug: pip install 'feederscrew[serve]'")

from werkzeug.test import Client

from feederscrew.jobs.serving import server, uploads
from feederscrew.jobs.serving.refusal import in_words_of_the_page
from feederscrew.jobs.serving.server import BoundedServer
from feederscrew.jobs.serving.site import Site

HOST = "127.0.0.1:8000"
WEDGE = b"OFF\n4 4 0\n0 0 0\n20 0 0\n0 10 0\n0 0 5\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n"
OWN = {"Host": HOST, "Origin": f"http://{HOST}"}
VALUES = {"material": "steel", "machine": "50", "rate": 60}
WRITES = """
import json, pathlib, sys
rate = float(sys.argv[sys.argv.index("--target") + 1].removesuffix("/min"))
answer = {"status": "holds", "why": "all fills do", "wanted": "A@90", "delivered_per_minute": 70.0}
if rate > 60:
    nearest = {"rate_per_minute": 57.9}
    answer = {"status": "falls short", "why": "too slow", "wanted": "A@90", "nearest": nearest}
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
print("begun", flush=True)
try:
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
    (path,) = site.folder.rglob("*.yaml")
    assert f"--config {path.parent.relative_to(site.folder)}" not in told["lines"][0]
    assert "--config" in told["lines"][0] and "--config ../mine.yaml" in told["command"]
    assert told["order"]["bowl"] == bowl["id"] and path.parent.parent == site.folder / "parts"


def test_what_falls_short_has_at_most_three_next_steps_that_are_orders(page):
    """The one that was tried and holds comes first, then what the order ruled out, then other sides."""
    part = page.send().get_json()["id"]
    holds = page.ended(page.order(part).get_json()["id"])
    assert holds["next"] == []
    values = {"rate": 90, "may_use": ["air"], "up": "A", "heading": "best", "outcome": "lying"}
    short = page.ended(page.order(part, **values).get_json()["id"])
    assert (short["status"], short["why"]) == ("falls short", "too slow")
    assert [step["change"] for step in short["next"]] == [
        {"rate": 57.0}, {"may_use": ["air", "camera"]}, {"heading": "any"},
    ]  # fmt: skip
    free = page.ended(page.order(part, rate=90).get_json()["id"])["next"]
    assert [step["change"] for step in free][:2] == [{"rate": 57.0}, {"up": "A", "heading": "any"}]
    for step in (*short["next"], *free):
        order = {**short["order"], **step["change"]}
        again = page.ended(page.order(order.pop("part"), **order).get_json()["id"])
        assert again["order"] == {**short["order"], **step["change"]}


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


FLOW = """<script>
(async () => {
  const until = async (holds) => { while (!holds()) await new Promise((done) => setTimeout(done, 100)); };
  const at = (name) => document.getElementById(name), bytes = await (await fetch("/bracket")).arrayBuffer();
  const files = new DataTransfer(), seen = {};
  files.items.add(new File([bytes], "bracket.stl"));
  at("file").files = files.files;
  at("file").dispatchEvent(new Event("change"));
  const inside = () => at("aspects").contentDocument;
  await until(() => !at("lying").hidden && inside()?.querySelector(".has-views .view .up"));
  const views = inside().querySelectorAll(".view canvas");
  const pixels = () => views[0].getContext("2d").getImageData(0, 0, 680, 544).data;
  const sum = () => pixels().reduce((all, one, k) => (all + one * (k % 97)) % 1e9, 0);
  const before = sum();
  await new Promise((done) => setTimeout(done, 400));
  // every view is whole, and each side can be chosen there or in the list
  const below = [...views].map((view) => view.getBoundingClientRect().bottom);
  const cut = Math.max(...below) > at("aspects").clientHeight;
  Object.assign(seen, { views: views.length, turns: sum() !== before, cut });
  const buttons = [...inside().querySelectorAll(".up")];
  buttons[1].click();
  const pressed = () => buttons.map((one) => one.getAttribute("aria-pressed")).indexOf("true");
  Object.assign(seen, { up: at("up").value, heading: at("heading").value, pressed: pressed() });
  const unnamed = [...document.querySelectorAll("input, select")].filter((one) => !one.labels?.length);
  Object.assign(seen, { unnamed: unnamed.length, wide: document.documentElement.scrollWidth > innerWidth });
  at("rate").value = 90;
  at("order").requestSubmit();
  await until(() => at("next").children.length);
  const colour = () => getComputedStyle(at("state")).color;
  const steps = at("next").children.length;
  Object.assign(seen, { short: at("state").textContent, steps, shortColour: colour() });
  at("next").children[0].click();
  await until(() => at("state").textContent === "holds" && !at("result").hidden);
  const [state, files_shown, fault] = ["state", "files", "fault"].map((name) => at(name).textContent);
  Object.assign(seen, { state, files: files_shown, fault, colour: colour(), rate: at("rate").value });
  seen.list = [...at("designs").children].map((one) => one.textContent);
  seen.cookie = document.cookie;
  await fetch("/seen", { method: "POST", body: JSON.stringify(seen) });
})();
</script></body>"""


@pytest.mark.needs("chromium")
@pytest.mark.parametrize("width", [390, 1280])
def test_the_main_flow_in_a_browser(tmp_path, width):
    """A part is dropped, its views turn and a side is chosen; a design falls short, the next step holds."""
    (tmp_path / "own").mkdir()
    site = Site(tmp_path / "own/run", (sys.executable, "-c", WRITES))
    seen, told = {}, threading.Event()

    def probed(environ, start_response):
        """The site with a script of the test in its page, the part, and where the script tells."""
        if environ["PATH_INFO"] == "/bracket":
            start_response("200 OK", [("Content-Type", "application/octet-stream")])
            return [BRACKET.read_bytes()]
        if environ["PATH_INFO"] == "/seen":
            seen.update(json.loads(environ["wsgi.input"].read(int(environ["CONTENT_LENGTH"]))))
            told.set()
            start_response("204 No Content", [])
            return []

        def begin(status, headers):
            start_response(status, [one for one in headers if one[0] != "Content-Length"])

        whole = b"".join(site(environ, begin))
        return [whole.replace(b"</body>", FLOW.encode()) if environ["PATH_INFO"] == "/" else whole]

    made = BoundedServer(site, 0)
    made.app = probed
    thread = threading.Thread(target=made.serve_forever, args=(0.05,))
    thread.start()
    flags = "--headless --no-sandbox --disable-gpu --use-gl=angle --use-angle=swiftshader"
    flags += f" --enable-unsafe-swiftshader --remote-debugging-port=0 --user-data-dir={tmp_path / 'profile'}"
    command = [shutil.which("chromium"), *flags.split(), f"--window-size={width},900", site.address]
    browser = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    try:
        assert told.wait(120.0)
    finally:
        browser.terminate()
        browser.wait()
        site.close()
        made.shutdown()
        thread.join()
        made.server_close()
    assert (
        seen["views"] >= 5 and seen["turns"] and not seen["cut"] and not seen["wide"] and not seen["unnamed"]
    )
    assert (seen["up"], seen["heading"], seen["pressed"]) == ("B", "any", 1)
    assert (seen["short"], seen["state"], seen["fault"], seen["rate"]) == ("falls short", "holds", "", "57")
    assert (
        1 <= seen["steps"] <= 3 and seen["colour"] != seen["shortColour"] and "design.html" in seen["files"]
    )
    first, second = ("bracket.stl (mm), 57 a minute, B up", "bracket.stl (mm), 90 a minute, B up")
    assert [line.startswith(begin) for line, begin in zip(seen["list"], (first, second))] == [True, True]
    assert seen["cookie"] == ""
