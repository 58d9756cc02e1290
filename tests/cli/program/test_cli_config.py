"""``feeder config``: a file that is valid, values with their origins."""

import json
import os
from pathlib import Path

import pytest

from feederscrew.bowl import documentation


def test_init_writes_a_commented_file_that_is_valid(run):
    result = run("config", "init", "bowl.yaml")
    assert (result.exit_code, result.stdout) == (0, "")
    assert result.stderr == "Wrote bowl.yaml\nWrote feeder.schema.json, which editors read\n"
    assert Path("feeder.schema.json").read_text() == documentation.schema_text()
    assert Path("bowl.yaml").read_text() == documentation.template()
    assert run("config", "show", "--config", "bowl.yaml").exit_code == 0


def test_init_never_overwrites_silently(run):
    Path("bowl.yaml").write_text("mine")
    result = run("config", "init", "bowl.yaml")
    assert result.exit_code == 1
    assert (
        result.stderr
        == "Error: bowl.yaml: exists already - name another file, or pass --force to replace it\n"
    )
    assert Path("bowl.yaml").read_text() == "mine"
    assert run("config", "init", "bowl.yaml", "--force").exit_code == 0
    assert Path("bowl.yaml").read_text() == documentation.template()


def test_show_tells_value_and_origin(run):
    Path("b.yaml").write_text("drive:\n  frequency: 50 Hz\n")
    lines = run("config", "show", "--config", "b.yaml", "--set", "friction.static=0.3").stdout.splitlines()
    shown = {line.split()[0]: line.split()[1:] for line in lines if line}
    assert shown["drive.frequency"] == ["50", "Hz", "b.yaml:2"]
    assert shown["friction.static"] == ["0.3", "--set"]
    assert shown["friction.wall"] == ["0.3", "as", "friction.kinetic"]
    assert shown["gravity"] == ["9.81", "m/s2", "default"]


def test_a_bowl_file_from_a_stream_is_refused(run):
    told = "is a stream, and a bowl file is read more than once - save it and name the file"
    assert run("config", "show", "--config", "-").stderr == f"Error: -: {told}\n"
    os.mkfifo("pipe.yaml")
    assert run("config", "show", "--config", "pipe.yaml").stderr == f"Error: pipe.yaml: {told}\n"


def test_schema_prints_what_init_leaves_beside_the_file(run):
    printed = run("config", "schema")
    assert (printed.exit_code, printed.stdout) == (0, documentation.schema_text())
    Path("feeder.schema.json").write_text('{"title": "feeder bowl file", "old": true}')
    assert run("config", "init", "bowl.yaml").exit_code == 0
    assert Path("feeder.schema.json").read_text() == printed.stdout
    assert Path("bowl.yaml").read_text().splitlines()[0] == (
        "# yaml-language-server: $schema=feeder.schema.json"
    )


@pytest.mark.parametrize("command", ["init", "schema"])
def test_init_and_schema_can_be_quiet_and_escape_what_a_name_holds(run, command):
    assert run("config", command, "red\x1b[31m.yaml").stderr.splitlines()[0] == "Wrote red\\x1b[31m.yaml"
    done = run("config", command, "-q", "--force", "quiet.yaml")
    assert (done.exit_code, done.stdout, done.stderr) == (0, "", "") and Path("quiet.yaml").exists()


def test_a_drive_unit_instead_of_all_defaults(run, tmp_path):
    listed = run("config", "init", "--machine", "list")
    assert listed.exit_code == 0 and len(listed.output.splitlines()) >= 6
    path = tmp_path / "machine.yaml"
    assert run("config", "init", str(path), "--machine", "d300-60hz").exit_code == 0
    shown = json.loads(run("config", "show", "--config", str(path), "--format", "json").stdout)
    values = {row["key"]: row["value"] for row in shown["settings"]}
    assert values["machine.supply"] == "60 Hz half wave" and values["drive.frequency"] == "60 Hz"
    refused = run("config", "init", "--machine", "d301")
    assert refused.exit_code == 2 and "--machine 'd301': is not known" in refused.stderr
