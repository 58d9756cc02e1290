"""``feeder serve``: what is refused, one job at a time, and the main flow in a browser."""

import io
import json
import shutil
import signal
import subprocess
import sys
import threading
import time
import zipfile

import pytest
from command_lines import BRACKET

pytest.importorskip("werkzeug", reason="needs werkzeug: pip install 'feederscrew[serve]'")

from werkzeug.serving import make_server
from werkzeug.test import Client

from feederscrew.serving import site as sites
from feederscrew.serving.site import Site

HOST = "127.0.0.1:8000"
WEDGE = b"OFF\n4 4 0\n0 0 0\n20 0 0\n0 10 0\n0 0 5\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n"
OWN = {"Host": HOST, "Origin": f"http://{HOST}"}
VALUES = {"material": "steel", "machine": "50", "units": "mm", "rate": 60}
WRITES = """
import pathlib, sys
folder = pathlib.Path(sys.argv[-1]) / "part"
folder.mkdir()
(folder / "design.html").write_text("<h1>holds</h1>")
(folder / "tooling.step").write_text("ISO")
print("trial 1 of 1:", *sys.argv[1:-1], flush=True)
"""
WAITS = """
import sys, time
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
    made = Site(tmp_path, (sys.executable, "-c", WRITES))
    made.port = 8000
    yield made
    made.close()


@pytest.fixture
def client(site):
    """A browser that has opened the address once."""
    browser = Client(site)
    answer = browser.get(f"/?token={site.token}", headers=OWN)
    assert answer.status_code == 303 and answer.headers["Location"] == "/"
    cookie = answer.headers["Set-Cookie"]
    assert "HttpOnly" in cookie and "SameSite=Strict" in cookie
    return browser


def send(client, name="wedge.off", data=WEDGE, headers=OWN):
    return client.post("/part", query_string={"name": name, "units": "mm"}, data=data, headers=headers)


def ended(client):
    """The progress of a design once it has ended."""
    for _ in range(200):
        told = client.get("/progress", headers=OWN).get_json()
        if told["state"] not in ("running", "stopping"):
            return told
        time.sleep(0.05)
    raise AssertionError(told)


def test_who_may_not_ask_is_refused(site, client):
    stranger = Client(site)
    for path in ("/", "/aspects", "/progress", "/folder.zip", "/result/design.html"):
        assert stranger.get(path, headers=OWN).status_code == 403
    assert stranger.get("/?token=wrong", headers=OWN).status_code == 403
    for host in ("evil.example", "evil.example:8000", "127.0.0.1", "127.0.0.1:8001", ""):
        assert client.get("/", headers={"Host": host}).status_code == 421
    for origin in ("http://evil.example", "null", "https://127.0.0.1:8000", "http://127.0.0.1:8001"):
        for path in ("/part", "/design", "/stop"):
            assert client.post(path, headers={**OWN, "Origin": origin}).status_code == 403
    assert client.post("/part", headers={"Host": HOST}).status_code == 403  # a browser always says it
    assert client.put("/part", headers=OWN).status_code == 404
    answer = client.get("/", headers=OWN)
    assert answer.status_code == 200 and "default-src 'none'" in answer.headers["Content-Security-Policy"]
    assert answer.headers["X-Content-Type-Options"] == "nosniff"


def test_an_upload_is_bounded_has_the_ending_of_a_part_and_its_name_is_no_path(client, tmp_path, monkeypatch):
    """It is shown without control characters; what is written is called otherwise."""
    for name in ("a.exe", "stl", "card.yaml", "a.stl.zip", ""):
        answer = send(client, name)
        assert answer.status_code == 415 and "not a part file" in answer.get_json()["error"]
    answer = send(client, "../../x/\x1b[31m<b>evil</b>.off", WEDGE)
    assert answer.status_code == 200 and "\x1b" not in answer.get_json()["name"]
    assert [path.name for path in tmp_path.iterdir()] == ["part.off"]
    assert "<b>evil" not in client.get("/aspects", headers=OWN).get_data(as_text=True)
    damaged = send(client, "damaged.stl", b"solid none").get_json()["error"]
    assert damaged.startswith("damaged.stl:") and str(tmp_path) not in damaged
    assert not list(tmp_path.iterdir()) and client.get("/aspects", headers=OWN).status_code == 409
    monkeypatch.setattr(sites, "PART_BYTES", 1000)
    assert send(client, data=b"x" * 1001).status_code == 413
    assert send(client, data=b"").status_code in (400, 411)
    monkeypatch.setattr(sites, "MOST_UPLOADS", 3)
    assert [send(client, data=b"solid none").status_code for _ in range(2)] == [422, 429]


def asked(client, **other):
    """The status of an order of a design."""
    return client.post("/design", data=json.dumps(VALUES | other), headers=OWN).status_code


def test_a_design_takes_what_the_page_offers_is_run_and_its_folder_read(client, site):
    wrong = [{"rate": rate} for rate in (0, "60; rm", True, 1e9, None)]
    wrong += [{"material": "--output=/"}, {"machine": ["--drive"]}, {"units": "ell"}]
    assert client.post("/design", data="[", headers=OWN).status_code == 400
    assert {asked(client, **other) for other in wrong} == {400} and site.job is None
    assert asked(client) == 409  # no part yet
    names = send(client).get_json()["aspects"]
    assert names == ["A", "B", "C", "D"]
    assert client.get("/aspects", headers=OWN).get_data(as_text=True).count("<canvas") == len(names)
    assert asked(client, machine="two") == 200
    told = ended(client)
    assert told["state"] == "done" and told["files"] == ["design.html", "tooling.step"]
    assert "--target 60/min --density steel --units mm --drive two-axis -o" in told["lines"][0]
    assert str(site.folder) not in told["lines"][0]
    page = client.get("/result/design.html", headers=OWN)
    assert page.get_data() == b"<h1>holds</h1>" and page.mimetype == "text/html"
    saved = client.get("/result/tooling.step", headers=OWN)
    assert saved.headers["Content-Disposition"] == "attachment"
    for path in ("/result/../part.stl", "/result/%2e%2e/part.stl", "/result//etc/passwd", "/result/"):
        assert client.get(path, headers=OWN).status_code == 404
    packed = zipfile.ZipFile(io.BytesIO(client.get("/folder.zip", headers=OWN).get_data()))
    assert packed.namelist() == ["design/design.html", "design/tooling.step"]


def test_one_design_at_a_time_and_it_can_be_stopped_and_ends_with_the_server(client, site):
    send(client)
    site.program = (sys.executable, "-c", WAITS)
    assert client.post("/stop", headers=OWN).status_code == 409
    assert asked(client) == 200
    while client.get("/progress", headers=OWN).get_json()["lines"] != ["begun"]:
        time.sleep(0.02)
    assert asked(client) == 409
    assert send(client).status_code == 409  # nor is its part replaced
    assert client.post("/stop", headers=OWN).get_json()["state"] in ("stopping", "stopped")
    progress = ended(client)
    assert progress["state"] == "stopped" and progress["lines"] == ["begun", "Stopped."]
    assert client.get("/folder.zip", headers=OWN).status_code == 404
    assert asked(client) == 200
    site.close()  # the end of the server ends a design
    assert not site.job.is_running


def test_the_command_listens_here_alone_ends_with_its_folder_and_names_its_extra(run, tmp_path, monkeypatch):
    """Ctrl-C: status 130 as of every command, no folder left behind."""
    assert "127.0.0.1" in run("serve", "--help").output
    code = "from feederscrew_cli.main import feeder; feeder(['serve'])"
    own = {"TMPDIR": str(tmp_path), "PATH": "/usr/bin:/bin"}
    call, pipe = [sys.executable, "-c", code], subprocess.PIPE
    process = subprocess.Popen(call, stdout=pipe, stderr=pipe, text=True, env=own)
    address = process.stdout.readline()
    assert address.startswith("http://127.0.0.1:") and "/?token=" in address
    assert len(list(tmp_path.iterdir())) == 1
    process.send_signal(signal.SIGINT)
    _, said = process.communicate(timeout=60)
    assert process.returncode == 130 and said.splitlines()[-1] == "Stopped."
    assert not list(tmp_path.iterdir())
    monkeypatch.setitem(sys.modules, "werkzeug.serving", None)
    result = run("serve")
    assert result.exit_code == 1 and "pip install 'feederscrew[serve]'" in result.output


FLOW = """<script>
(async () => {
  const until = async (holds) => { while (!holds()) await new Promise((done) => setTimeout(done, 200)); };
  const at = (name) => document.getElementById(name), bytes = await (await fetch("/bracket")).arrayBuffer();
  const files = new DataTransfer(), seen = {};
  files.items.add(new File([bytes], "bracket.stl"));
  at("file").files = files.files;
  at("file").dispatchEvent(new Event("change"));
  const inside = () => at("aspects").contentDocument;
  await until(() => !at("lying").hidden && inside().querySelector(".has-views .view canvas"));
  const views = inside().querySelectorAll(".view canvas");
  const pixels = () => views[0].getContext("2d").getImageData(0, 0, 680, 544).data;
  const sum = () => pixels().reduce((all, one, k) => (all + one * (k % 97)) % 1e9, 0);
  const before = sum();
  await new Promise((done) => setTimeout(done, 400));
  Object.assign(seen, { views: views.length, turns: sum() !== before });
  at("start").click();
  await until(() => !at("result").hidden);
  const [state, files_shown, fault] = ["state", "files", "fault"].map((name) => at(name).textContent);
  Object.assign(seen, { state, files: files_shown, fault });
  await fetch("/seen", { method: "POST", body: JSON.stringify(seen) });
})();
</script></body>"""


@pytest.mark.needs("chromium")
def test_the_main_flow_in_a_browser(tmp_path):
    """A part is dropped, its views are drawn and turn by themselves, a design runs, its files are listed."""
    (tmp_path / "own").mkdir()
    site = Site(tmp_path / "own", (sys.executable, "-c", WRITES))
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

    server = make_server("127.0.0.1", 0, probed, threaded=True)
    site.port = server.server_port
    thread = threading.Thread(target=server.serve_forever, args=(0.05,))
    thread.start()
    flags = "--headless --no-sandbox --disable-gpu --use-gl=angle --use-angle=swiftshader"
    flags += f" --enable-unsafe-swiftshader --remote-debugging-port=0 --user-data-dir={tmp_path / 'profile'}"
    command = [shutil.which("chromium"), *flags.split(), site.address]
    browser = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    try:
        assert told.wait(120.0)
    finally:
        browser.terminate()
        browser.wait()
        site.close()
        server.shutdown()
        thread.join()
        server.server_close()
    assert seen["views"] >= 5 and seen["turns"] and seen["fault"] == ""
    assert seen["state"] == "done" and "design.html" in seen["files"]
