"""What is wrong on the command line ends with 2, what is wrong in a file with 1, both together with 1.

Each is one line that says what to do, before anything is printed or written.
"""

import re
import shlex

import click
import pytest
from click.testing import CliRunner
from command_lines import BRACKET, NUT, PARTS

from feederscrew_cli.main import feeder

COUNTS = PARTS.parent / "docs/measured/coin.csv"
PLACES = {"NUT": NUT, "BRACKET": BRACKET, "CARD": PARTS / "magnet.yaml"}
WRONG_CALLS = """
aspect | No such command 'aspect'. Did you mean 'aspects'? (see feeder --help)
--versoin | No such option '--versoin'. Did you mean '--version'? (see feeder --help)
aspects | Missing argument 'PART'. (see feeder aspects --help)
aspects a.stl --format jsn | not one of 'table', 'csv', 'json'. Did you mean 'json'? - write --format json
report NUT --format pdf -o out | Invalid value for '--format': 'pdf' is not one of 'html', 'md'.
aspects '' | Invalid value for 'PART': is empty - give a path (see feeder aspects --help)
batch '' | Invalid value for 'PARTS...': is empty - give a path
aspects a.stl -o '' | Invalid value for '-o' / '--output': is empty - give a path
slide --config '' | Invalid value for '--config': is empty - give a path
aspects NUT --density stel | --density
aspects NUT --columns aspect,barier_mm | there is no column 'barier_mm' - write --columns aspect,barrier_mm
inertia NUT --centre-of-mass 1,2 | --centre-of-mass
inertia NUT --centre-of-mass 90,0,0 | --centre-of-mass
inertia NUT --body 7 | --body
inertia CARD --density brass | --density
rate NUT --aspect A --fill 1.2 | '--fill': '1.2' is out of range - give more than 0 and at most 1
rate NUT --aspect A --fed 9 --launch drop | --fed is for parts on the moving floor
rate NUT --probabilities c.csv --launch drop | --probabilities takes the place of --launch
rate NUT --probabilities c.csv --rule csa | --probabilities takes the place of --rule
bowl --measured 'strok=0.3 mm' | --measured
bowl --measured 'fill=500 %' | --measured fill: 500 % is out of range - give 0 % to 100 %
bowl --measured 'stroke=1 mm, stroke=2 mm' | --measured stroke: is given twice
aspects NUT --surface-exponent -11 | '--surface-exponent': -11.0 is not in the range
tooling NUT --aspect A --heading 31 --rule csa | --heading
trial NUT --aspect Z --rule csa | there is no aspect 'Z' - choose one of
trial NUT --poured | --poured is for a queue - give --queue N as well
trial NUT --poured --fill low | --poured goes with no fill - leave one of them out
trial NUT --with counts.csv | --with is for a queue - give --queue N as well
trial NUT --amplitude '9 m' | --amplitude: drive.amplitude: '9 m' is out of range - give 0 mm to 20 mm
design NUT --target 30/min --up Z --rule csa | --up
design NUT --target 30/min --without slide | --without
design NUT --target 30/min --tolerance 1m | --tolerance: 1000 mm is not less than the part's
design NUT BRACKET --target 40/min --aspect A | --aspect is of one part - design that one alone (see feeder
design NUT BRACKET --target 40/min --up A,B | --up is of one part - design that one alone (see feeder design
design --batch designs.csv | designs.csv:3 has no target
design --batch designs.csv washer_m6.stl --target 45/min | --batch goes with one list
design --batch designs.csv --target 45/min --aspect A | --aspect is of one part
design washer_m6.stl | Missing option '--target'
convey --set drive.frequency | --set
convey --set 'drive.frequncy=50 Hz' | --set
convey --set friction.static=0.1 --set friction.kinetic=0.3 | --set
convey --config good.yaml --set friction.kinetic=0.9 | --set
convey MANY | --set
convey --vary drive.frequncy=5:6:3 | --vary
convey --vary drive.amplitude=0:1:3 --bowl | --bowl cannot be combined with exactly one --vary
config show --set 'drive.frequency=0 Hz' | --set
config init --machine d301 | --machine 'd301': is not known
slide --beta 120 | Invalid value for '--beta': '120' is out of range - give 0 deg to 90 deg (see feeder slide
slide --beta nan | '--beta': 'nan' is not a number - write digits with a decimal point, as in 0.4
reproduce 'no table' | no table
drop NUT --height '1 kg' | --height
drop NUT --height '99 m' | --height: '99 m' is out of range - give 0 mm to 6330 mm for this part
drop NUT --until 90% | --until: '90%' is out of range - give 0.01% to 50%
drop NUT --trace 3 | --trace writes files: give -o DIR as well (see feeder drop --help)
drop NUT --launches l.csv --launch roll | --launch cannot be combined with --launches - leave one of them out
drop NUT --launches l.csv --spin '3 rad/s' | --spin cannot be combined with --launches - leave one of them out
drop NUT --launches l.csv --plate | --launches is for a plane at rest - leave out --launches or --plate
drop NUT --config b.yaml | --config is for a vibrating plate - give --plate as well
drop NUT --plate --until 1% | --until is for a plane at rest - leave out --until or --plate
drop NUT --plate --amplitude 0.4 | --amplitude: drive.amplitude: '0.4' has no unit
batch NUT | Missing option '-o' - say where the results go (see feeder batch --help)
batch NUT -o out --jobs 0 | '0' is not a number of processes - give 1, 2, ...
batch NUT -o out --density stel | --density
batch NUT -o out --set 'drive.frequency=50 mm' | --set
batch NUT -o out --scheduler nonsense | --scheduler
bowl BRACKET --target 60/min --print pla | --print is given without --solid - add --solid
bowl BRACKET --target 60/min --chord '1 mm' | --chord is given without --solid - add --solid
"""
MENDS = """
design NUT --target 60 | --target 60/min
design NUT --target 60mm | --target 60/min
design NUT | --target 60/min
tune NUT --aspect A --target 20 | --target 20/min
aspects NUT --rule closed --density 7850 | --density "7850 kg/m3"
aspects NUT --rule closed --density 7.85 | --density "7.85 g/cm3"
aspects NUT --rule closed --density '7850 g/cm3' | --density "7850 kg/m3"
aspects NUT --rule closed --density brss | --density brass
aspects NUT --rule closed --launch fed | --launch feed
aspects NUT --rule clsed | --rule closed
aspects NUT --rule closed --columns aspect,hieght | --columns aspect,height_mm
aspects NUT --rule closed --drops -1 | --drops 0
aspects NUT --rule closed --surface-exponent 20 | --surface-exponent 10
aspects NUT --rule closed --units inch | --units in
inertia NUT --density alumnium | --density aluminium
rate NUT --aspect A --rule cas | --rule csa
rate NUT --rule csa --set track.radius=150 | --set track.radius="150 mm"
convey --set drive.frequency=50 | --set drive.frequency="50 Hz"
convey --set drive.frequency=50mm | --set drive.frequency="50 Hz"
convey --set drive.freqency=50Hz | --set drive.frequency=50Hz
convey --set drive.frequency | --set drive.frequency="50 Hz"
convey --set drive.frequency= | --set drive.frequency="50 Hz"
convey --set 'friction.static=0,5' | --set friction.static=0.5
convey --set 'drive.frequency=50 hz' | --set drive.frequency="50 Hz"
slide --set drive.amplitude=0.2 | --set drive.amplitude="0.2 mm"
convey --vary drive.freqency=40:60:3 | --vary drive.frequency=40:60:3
floor NUT --aspect A --heading 30mm | --heading "30 deg"
trial NUT --rule csa --parts 2 --amplitude 0.2 | --amplitude "0.2 mm"
trial NUT --rule csa --parts 2 --amplitude '50%,0.2' | --amplitude "50%,0.2 mm"
trial NUT --rule csa --parts x | --parts 10
bowl --measured stroke=0.4 | --measured stroke="0.4 mm"
tooling NUT --rule csa --static --without wipr | --without wiper
tooling NUT --rule csa --static --margin 0.5 | --margin "0.5 mm"
sample cap 16x9 --wall 2 | --wall "2 mm"
"""
RULED = {  # commands that take a rule, and what else they need; one of them ended in a KeyError
    "rate": "", "tooling": "", "trial": "", "report": "--aspect A", "batch": "-o out",
    "design": "--target 30/min", "bowl": "--target 30/min", "tune": "--aspect A --target 30/min",
}  # fmt: skip
OF_AN_ASPECT = (
    "floor", "headings", "track", "tooling --rule csa", "rate --rule csa", "report --rule csa -o out",
    *(f"{name} --rule csa --target 30/min" for name in ("tune", "bowl", "design")),
)  # fmt: skip
OF_A_PART = (  # `feeder bowl --body 7` gave the machine of the defaults as if no part had been named
    "--body 7", "--units cm", "--density brass", "--centre-of-mass 0,0,1", "--allow-open", "--aspect A",
    "--heading 90deg", "--rule csa", "--gap '1 mm'", "--fill 0.5",
)  # fmt: skip
CALLS = [line.split(" | ") for line in WRONG_CALLS.strip().splitlines()]
CLOSD = "--rule: unknown rule 'closd' - write --rule closed"
CALLS += [(f"{name} gone.stl --rule closd {more}", CLOSD) for name, more in RULED.items()]
CALLS += [(f"{call} NUT --aspect Z", "--aspect") for call in OF_AN_ASPECT]
ALONE = "is given without PART - name the part's file"
CALLS += [(f"bowl {option}", f"{option.split()[0]} {ALONE}") for option in OF_A_PART]


def words(call):
    """The arguments of a line, with the paths of the parts in it."""
    many = [f"--set=a{k}=1" for k in range(40)]
    typed = shlex.split(call)
    return [word for each in typed for word in (many if each == "MANY" else [PLACES.get(each, each)])]


@pytest.fixture
def files(tmp_path):
    (tmp_path / "good.yaml").write_text("friction:\n  static: 0.5\n")
    (tmp_path / "bad.yaml").write_text("drive:\n  frequncy: 50 Hz\n")
    (tmp_path / "names.yaml").write_text("devices:\n  - profile: {of: Z@0, play: 1 mm}\n")
    (tmp_path / "list.csv").write_text(f"part,aspect\n{NUT},Z\n")
    (tmp_path / "c.csv").write_text("aspect,tray\nA,10\nB,30\n")
    designs = f"part,target,aspect\n{PARTS / 'washer_m6.stl'},30/min,A\n{PARTS / 'dowel_6x20.stl'},,\n"
    (tmp_path / "designs.csv").write_text(designs)
    return tmp_path


@pytest.mark.parametrize(("call", "said"), CALLS)
def test_a_wrong_call_is_one_line_and_status_2(run, files, call, said):
    done = run(*words(call))
    line = done.stderr.splitlines()[-1]
    assert (done.exit_code, done.stdout) == (2, ""), done.stderr
    assert line.startswith("Error: ") and said.replace("feeder ", f"{feeder.name} ") in line
    assert done.stderr.count("Error: ") == (40 if "MANY" in call else 1)
    assert not list(files.glob("out/**/*.csv"))


BEFORE_WORK = """
aspects NUT --columns WRONG | --columns
rate NUT --aspect Z | --aspect
rate NUT --heading 30 | --heading is given without --aspect
bowl NUT --target 5/min --heading 30 | --heading is given without --aspect
bowl NUT --target 5/min --aspect Z | --aspect
tune NUT --target 5/min --aspect Z | --aspect
trial NUT --aspect Z | --aspect
tooling NUT --aspect A --up Z | --up
tooling NUT --aspect A --heading 31 | --heading
tooling NUT --without slide | --without
design NUT --target 5/min --aspect Z --launch drop | --aspect
"""


@pytest.mark.parametrize("line", BEFORE_WORK.strip().splitlines())
def test_a_wrong_name_or_place_is_refused_before_anything_is_simulated(run, files, monkeypatch, line):
    monkeypatch.setattr("feederscrew.arrivals.simulation_cache.once", None)  # a part that is dropped fails
    call, option = line.split(" | ")
    done = run(*words(call))
    assert done.exit_code == 2 and option in done.stderr, done.stderr
    done = run(*words(call.split(" --")[0]), *["--target", "5/min"] * ("target" in call), "-o", "c.csv")
    assert done.exit_code in (1, 2) and "Error: " in done.stderr, done.stderr


@pytest.mark.parametrize(
    "call",
    [f"compare {COUNTS}", f"design NUT {PARTS}/washer_m6.stl --target 5/min", "design --batch designs.csv"],
)
def test_a_place_for_results_is_refused_before_anything_is_computed(run, files, monkeypatch, call):
    for work in ("feeding.compare.compare_sets", "designing.families.family", "designing.loop.design"):
        monkeypatch.setattr(f"feederscrew.{work}", None)
    done = run(*words(f"{call} -o c.csv"), *["--target", "9/min"] * ("batch" in call))
    assert done.exit_code == 1 and "c.csv: is a file, not a folder" in done.stderr.splitlines()[-1]


WRONG_FILES = """
convey --config bad.yaml | bad.yaml:2:3:
convey --config bad.yaml --set 'drive.frequncy=50 Hz' | bad.yaml:2:3:
convey --config gone.yaml | gone.yaml:
report BRACKET --config none.yaml -o out | none.yaml:
aspects gone.stl | gone.stl:
aspects NUT --names gone.yaml | gone.yaml:
drop NUT --launches gone.csv | gone.csv:
drop CARD | magnet.yaml:
compare NUT --with gone.csv | gone.csv:
rate NUT --aspect A --rule csa --config names.yaml | names.yaml:2:
batch list.csv --rule csa --no-pictures --jobs 1 -o batch | list.csv:2:
rate NUT --aspect A --set 'track.climb=40 deg' | track.climb: is steeper than friction holds:
convey --set 'drive.amplitude=0 mm' | drive.amplitude: is 0 mm, so nothing moves - give more
convey --set 'drive.phase=20 deg' --bowl | drive.phase: is not 0 deg, an elliptical drive is not
"""  # with a wrong --set as well: first mend the file


@pytest.mark.parametrize("line", WRONG_FILES.strip().splitlines())
def test_what_is_wrong_in_a_file_or_cannot_be_is_status_1(run, files, line):
    call, said = line.split(" | ")
    done = run(*words(call))
    line = next(line for line in done.stderr.splitlines() if line.startswith("Error: "))
    assert done.exit_code == 1 and said in line and " - " in line and "Traceback" not in done.stderr
    assert not (files / "out").exists()


def test_a_part_of_many_that_fails_is_named_with_q_as_well(run, files):
    done = run("batch", "list.csv", "--rule", "csa", "--no-pictures", "--jobs", "1", "-q", "-o", "batch")
    assert done.exit_code == 1 and done.stderr.startswith("Error: list.csv:2:")


@pytest.mark.parametrize("name", list(feeder.commands))
def test_a_number_is_of_plain_digits(name):
    numbers = (click.types.IntParamType, click.types.FloatParamType)
    for option in (each.opts[-1] for each in feeder.commands[name].params if isinstance(each.type, numbers)):
        for text in ("1_0", "\u0661\u0662", "nan"):
            done = CliRunner().invoke(feeder, [name, "gone.stl", option, text])
            assert done.exit_code == 2 and option in done.stderr and "Traceback" not in done.stderr, option


def mended(call, stderr):
    """The words of a call with the option that its fault prints in place of the wrong one; that option."""
    line = stderr.splitlines()[-1]
    option = re.sub(r" \(see feeder .*\)$", "", line.rpartition(" - ")[2]).partition(" ")[2]
    name, *value = shlex.split(option)
    typed = [str(word) for word in words(call)]
    place = typed.index(name) if name in typed else len(typed)
    return [*typed[:place], name, *value, *typed[place + 2 :]], option


@pytest.mark.parametrize("line", MENDS.strip().splitlines())
def test_the_mend_that_a_fault_prints_can_be_typed(run, tmp_path, line):
    """They named a value without its option, or with a blank that the next fault refused: '60 /min'."""
    call, expected = line.split(" | ")
    wrong = run(*words(call))
    assert wrong.exit_code == 2 and wrong.stdout == "" and wrong.stderr.count("Error: ") == 1
    again, option = mended(call, wrong.stderr)
    assert option == expected
    if call.startswith(("design", "tune", "tooling")):  # ten seconds and more: is the call taken?
        name, *rest = again
        assert feeder.commands[name].make_context(name, rest, parent=click.Context(feeder)).params
        return
    right = run(*again)
    assert right.exit_code == 0, right.output
