"""``feeder config``: a file that is valid, values with their origins."""

import os
from pathlib import Path

import pytest

from feederscrew.bowl import documentation

FILE, SCHEMA = Path("bowl.yaml"), Path("feeder.schema.json")


def test_init_writes_a_commented_file_that_is_valid_and_never_overwrites_silently(run):
    FILE.write_text("mine")
    SCHEMA.write_text('{"title": "feeder bowl file", "old": true}')
    refused = run("config", "init", "bowl.yaml")
    line = "Error: bowl.yaml: exists already - name another file, or pass --force to replace it\n"
    assert (refused.exit_code, refused.stderr, FILE.read_text()) == (1, line, "mine")
    made = run("config", "init", "bowl.yaml", "--force")
    assert (made.exit_code, made.stdout) == (0, "")
    assert made.stderr == "Wrote bowl.yaml\nWrote feeder.schema.json, which editors read\n"
    assert FILE.read_text() == documentation.template()
    assert FILE.read_text().startswith("# yaml-language-server: $schema=feeder.schema.json\n")
    assert SCHEMA.read_text() == documentation.schema_text() == run("config", "schema").stdout
    assert run("config", "show", "--config", "bowl.yaml").exit_code == 0


def test_show_tells_value_and_origin_of_a_file_or_a_drive_unit_and_refuses_a_stream(run, run_json):
    Path("b.yaml").write_text("drive:\n  frequency: 50 Hz\n")
    lines = run("config", "show", "--config", "b.yaml", "--set", "friction.static=0.3").stdout.splitlines()
    shown = {line.split()[0]: line.split()[1:] for line in lines if line}
    assert shown["drive.frequency"] == ["50", "Hz", "b.yaml:2"]
    assert shown["friction.static"] == ["0.3", "--set"]
    assert shown["friction.wall"] == ["0.3", "as", "friction.kinetic"]
    assert shown["gravity"] == ["9.81", "m/s2", "default"]
    # the file needs no option; of two files none is guessed
    assert run("config", "show", "b.yaml", "--set", "friction.static=0.3").stdout.splitlines() == lines
    twice = run("config", "show", "b.yaml", "--config", "b.yaml")
    assert twice.exit_code == 2 and "leave one of them out" in twice.stderr and not twice.stdout
    # a stream is refused
    os.mkfifo("pipe.yaml")
    for name in ("-", "pipe.yaml"):
        line = "is a stream, and a bowl file is read more than once - save it and name the file"
        for call in (("--config", name), (name,)):
            assert run("config", "show", *call).stderr == f"Error: {name}: {line}\n"
    # a drive unit instead of all defaults
    listed = run("config", "init", "--machine", "list")
    assert listed.exit_code == 0 and len(listed.output.splitlines()) >= 6
    assert run("config", "init", "machine.yaml", "--machine", "d300-60hz").exit_code == 0
    settings = run_json("config", "show", "--config", "machine.yaml")["settings"]
    values = {row["key"]: row["value"] for row in settings}
    assert values["machine.supply"] == "60 Hz half wave" and values["drive.frequency"] == "60 Hz"


@pytest.mark.parametrize("command", ["init", "schema"])
def test_init_and_schema_can_be_quiet_and_escape_what_a_name_holds(run, command):
    assert run("config", command, "red\x1b[31m.yaml").stderr.splitlines()[0] == "Wrote red\\x1b[31m.yaml"
    done = run("config", command, "-q", "--force", "quiet.yaml")
    assert (done.exit_code, done.stdout, done.stderr) == (0, "", "") and Path("quiet.yaml").exists()
