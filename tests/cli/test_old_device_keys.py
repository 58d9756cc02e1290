"""Bowl files of before, by their old names of devices: the same files as with the names of the trade."""

import hashlib
import re

import pytest
from command_lines import BRACKET, called

from feederscrew.bowl.devices.kinds import KINDS

CHAINS = {
    "leans and blades": {
        "V groove": "{angle: 10 deg}", "spacing section": "{climb: 2 deg}", "banked track": "4 deg",
        "pressure break": "29 mm", "height bar": "22 mm", "hold-down": "24 mm", "measured yield": "{A: 0.9}",
    },
    "cuts and a camera": {
        "profile gate": "{of: A@90, play: 0.4 mm}", "narrowed track": "29 mm",
        "cut-out": "[[0 mm, 26 mm], [9 mm, 26 mm], [9 mm, 35 mm], [0 mm, 35 mm]]",
        "vision reject": "{of: A@90, play: 0.5 mm, sees: outline}",
    },
    "a ledge and air": {
        "tipping ledge": "4 mm", "air jet": "{nozzle: 2 mm, pressure: 0.02 bar, height: 25 mm}",
    },
}  # fmt: skip
RENAMED = {kind: own.trade.old_name for kind, own in KINDS.items() if own.trade.old_name}
COMMANDS = {
    "bowl": ("--target", "1/min", "--solid", "--no-pictures"),
    "rate": ("--aspect", "A", "--heading", "90 deg"),
    "trial": ("--aspect", "A@90", "--parts", "1", "--no-pictures"),
    "tooling": ("--aspect", "A", "--heading", "90 deg", "--static", "--no-pictures"),
}
# keys that are no word of any other thing
OLD_KEYS = re.compile(r"\b(height_bar|hold_down|pressure_break|narrowed_track|cut_out|sorter)\b(?!_\d)")


def write_bowl(chain, keys):
    lines = "".join(f"  - {keys.get(kind, kind)}: {value}\n" for kind, value in chain.items())
    return f"track: {{radius: 200 mm, width: 35 mm}}\ndevices:\n{lines}"


def test_the_chains_have_every_device_that_was_renamed():
    assert {kind for chain in CHAINS.values() for kind in chain} == set(RENAMED)


@pytest.mark.parametrize("command", COMMANDS)
@pytest.mark.parametrize("name", CHAINS)
def test_old_keys_write_the_files_of_the_new_names(name, command, tmp_path, monkeypatch):
    files, printed = [], []
    for folder, keys in (("old", RENAMED), ("new", {})):
        (tmp_path / folder).mkdir()
        monkeypatch.chdir(tmp_path / folder)
        (tmp_path / folder / "bowl.yaml").write_text(write_bowl(CHAINS[name], keys))
        words = (command, BRACKET, "--config", "bowl.yaml", "--rule", "csa", *COMMANDS[command])
        printed.append(called(*words, "-o", "results").stdout)
        written = tmp_path / folder / "results" / BRACKET.stem
        own = hashlib.sha256((tmp_path / folder / "bowl.yaml").read_bytes()).hexdigest().encode()
        files.append({path.name: path.read_bytes().replace(own, b"") for path in written.iterdir()})
    assert printed[0] == printed[1]
    assert files[0].keys() == files[1].keys() and len(files[0]) > 2
    assert [file for file in files[0] if files[0][file] != files[1][file]] == []
    for data in (*files[0].values(), printed[0].encode()):
        assert not OLD_KEYS.findall(data.decode("latin-1")), data[:200]
