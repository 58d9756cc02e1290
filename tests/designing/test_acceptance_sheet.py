"""The acceptance sheet as a test plan: samples that show a demand, and judgement by the demand alone."""

import numpy as np
import pytest
from design_counts import queue
from scipy.stats import binom, poisson

from feederscrew.base.errors import FeederError
from feederscrew.designing import acceptance_sheet, evidence
from feederscrew.designing.acceptance_sheet import Judgement, Quantity, SheetLine

HEAD = "quantity,fill,computed,low,high,unit,measured,sample\n"  # without a plan, as older ones were
NO_NUMBERS = "nan", "inf", "-inf", "1_0", "\u0663", "many", "1e999"
LINE = "\x1b[31mjams,low,0,0,1,1,2,100\n"
HOUR = 3600.0


# Tables of single sampling by attributes, for 95 % confidence that at most 2 % are wrong
@pytest.mark.parametrize(("wrong", "sample"), [(0, 149), (1, 236), (2, 313), (3, 386)])
def test_a_share_is_shown_by_the_smallest_sample_of_the_binomial(wrong, sample):
    assert evidence.parts_to_look_at(0.98, wrong) == sample
    assert evidence.share_at_least(sample - wrong, sample) >= 0.98
    assert evidence.share_at_least(sample - wrong - 1, sample - 1) < 0.98
    assert f"{sample} parts with {wrong or 'none'} wrong" in acceptance_sheet.yield_plan(0.98)


@pytest.mark.parametrize("right, total", [(0, 20), (36, 40), (188, 189), (20, 20)])
def test_bounds_of_a_share_are_those_of_clopper_and_pearson(right, total):
    low, high = evidence.share_at_least(right, total), evidence.share_at_most(right, total)
    assert low <= right / total <= high
    assert binom.sf(right - 1, total, low) == pytest.approx(0.05) or right == low == 0.0
    assert binom.cdf(right, total, high) == pytest.approx(0.05) or right == total * high == total
    assert (evidence.share_at_least(0, 0), evidence.share_at_most(0, 0)) == (0.0, 1.0)


def test_jams_are_shown_by_a_run_of_the_rule_of_three():
    assert acceptance_sheet.minutes_to_run(1.0 / HOUR, 0) == 180
    for count in (0, 1, 4):
        rate = evidence.rate_at_most(count, 7.0)
        assert poisson.cdf(count, 7.0 * rate) == pytest.approx(0.05)
        assert evidence.time_to_run(rate, count) == pytest.approx(7.0)
    assert np.isinf(evidence.rate_at_most(0, 0.0))


@pytest.mark.parametrize("demand", [0.0, 1.0, 1.5, 1.0 - 1e-12])
def test_a_share_that_no_sample_shows_is_refused(demand):
    with pytest.raises(ValueError, match="sample"):
        evidence.parts_to_look_at(demand, 0)


@pytest.mark.parametrize(("quantity", "low", "high", "measured", "sample", "judgement"), [
    # 98 % are demanded: 97 of 100 are fewer, 100 of 100 show 97.05 % only
    (Quantity.YIELD, None, None, 97.0, 100, Judgement.FAILS),
    (Quantity.YIELD, None, None, 100.0, 100, Judgement.UNSHOWN),
    (Quantity.YIELD, None, None, 100.0, 149, Judgement.AGREES),
    (Quantity.YIELD, None, None, 100.0 * 148 / 149, 149, Judgement.UNSHOWN),
    (Quantity.YIELD, None, None, 100.0 * 235 / 236, 236, Judgement.AGREES),
    (Quantity.YIELD, None, None, 100.0, None, Judgement.UNSHOWN),
    (Quantity.YIELD, None, None, 97.0, None, Judgement.FAILS),
    (Quantity.YIELD, 90.0, None, 97.0, 100, Judgement.AGREES),
    # nobody has agreed to 432 jams an hour because nobody looked for longer than 25 s
    (Quantity.JAMS, None, None, 400.0, 3600, Judgement.FAILS),
    (Quantity.JAMS, None, None, 400.0, None, Judgement.FAILS),
    (Quantity.JAMS, None, 432.0, 400.0, 60, Judgement.UNSHOWN),
    (Quantity.JAMS, None, None, 0.0, 60, Judgement.UNSHOWN),
    (Quantity.JAMS, None, None, 0.0, 10_800, Judgement.AGREES),
    (Quantity.JAMS, None, None, 0.5, 7_200, Judgement.UNSHOWN),
    (Quantity.JAMS, None, 5.0, 0.5, 7_200, Judgement.AGREES),
    (Quantity.RATE, 30.0, None, 29.0, 600, Judgement.FAILS),
    (Quantity.RATE, 30.0, None, 300.0, None, Judgement.AGREES),
    (Quantity.RATE, 30.0, None, None, None, Judgement.UNMEASURED),
    ("stroke", None, None, 45.0, None, Judgement.FAILS),  # computed: 50
    ("stroke", None, None, 54.9, None, Judgement.AGREES),
    ("stroke", 40.0, None, 45.0, None, Judgement.AGREES),
])  # fmt: skip
def test_a_line_is_judged_by_its_demand(quantity, low, high, measured, sample, judgement):
    line = SheetLine(quantity, "low", "", low, high, 50.01, measured=measured, sample=sample)
    found, why = line.judged
    assert (found, bool(why)) == (judgement, judgement in (Judgement.FAILS, Judgement.UNSHOWN))
    expected = None if judgement is Judgement.UNMEASURED else judgement is Judgement.AGREES
    assert line.agrees is expected


@pytest.mark.parametrize(("share", "step", "sample", "good"), [
    (97.0, 0.5, 100, 97), (99.3, 0.05, 149, 148), (99.0, 0.5, 149, 147), (99.0, 0.5, 50, None),
    (100.0, 0.5, 7, 7), (0.0, 0.5, 300, 0), (97.35, 0.005, 38, None),
])  # fmt: skip
def test_a_yield_is_a_whole_number_of_good_parts_the_fewest_that_round_to_it(share, step, sample, good):
    line = SheetLine(Quantity.YIELD, "", "%", None, None, None, measured=share, sample=sample)
    assert SheetLine(**vars(line) | {"measured_step": step}).good == good


def test_the_sheet_has_the_demand_the_plan_and_what_the_computation_expects():
    rate, good, jams = acceptance_sheet.lines_of_fill(queue(188, 189, seconds=220.0, counted=220.0), 0.5)
    assert (rate.low, rate.high, rate.computed) == (30.0, None, pytest.approx(188.0 * 60.0 / 220.0))
    assert rate.computed_low < rate.computed < rate.computed_high
    assert (good.low, good.computed) == (98.0, pytest.approx(99.47, abs=0.01))
    assert good.computed_low == pytest.approx(100.0 * evidence.share_at_least(188, 189))
    assert good.sample == 386  # with 0 wrong it would fail in 54 of 100 acceptances
    assert (jams.high, jams.computed, jams.sample) == (1.0, 0.0, 10_800.0)
    assert jams.computed_high == pytest.approx(3.0 * HOUR / 220.0, rel=2e-3)  # is no demand
    *_, jams = acceptance_sheet.lines_of_fill(queue(40, seconds=60.0), 0.5, agreed_jams=4.0 / HOUR)
    assert (jams.high, jams.sample) == (4.0, 45 * 60.0)


YIELD_ROW, RATE_ROW = '"yield, good of what leaves",low,', "good parts at the discharge,low,"


@pytest.mark.parametrize(("row", "column"), [
    ("jams,low,0,0,5,1/h,-5,60", "measured"),
    ("jams,low,-1,0,5,1/h,2,60", "computed"),
    ("jams,low,0,0,5,1/h,2,0", "sample"),
    ("jams,low,0,0,5,1/h,2,1e-300", "sample"),
    ("jams,low,0,0,0,1/h,2,60", "high"),
    ("jams,low,0,6,5,1/h,2,60", "low"),
    ("jams,low,0,0,5,1/min,2,60", "unit"),
    (f"{YIELD_ROW}100,96,,%,97,1e-300", "sample"),
    (f"{YIELD_ROW}100,96,,%,97,-100", "sample"),
    (f"{YIELD_ROW}100,96,,%,97,99.5", "sample"),
    (f"{YIELD_ROW}100,96,,%,97,1e300", "sample"),
    (f"{YIELD_ROW}150,96,,%,97,100", "computed"),
    (f"{YIELD_ROW}100,96,,%,101,100", "measured"),
    (f"{YIELD_ROW}100,96,,%,97,50", "measured"),  # 48.5 parts
    (f"{YIELD_ROW}100,100,,%,97,100", "low"),
    (f"{YIELD_ROW}100,104,,%,97,100", "low"),
    (f"{RATE_ROW}53,200,50,1/min,52,", "low"),
    (f"{RATE_ROW}53,-50,,1/min,52,", "low"),
    (f"{RATE_ROW}53,30,,1/s,52,", "unit"),
    (f"{RATE_ROW},,,1/min,52,", "computed"),
    ('stroke,,0.3,,,mm,"0,299",', "measured"),  # 0.299, or 299
    (",,0.3,,,mm,0.3,", "quantity"),
    *((f"jams,low,0,0,1,1/h,{number},100", "measured") for number in NO_NUMBERS),
    *((f"{RATE_ROW}{number},30,,1/min,52,", "computed") for number in NO_NUMBERS),
])  # fmt: skip
def test_a_cell_that_cannot_be_true_is_refused_by_line_and_column(tmp_path, row, column):
    path = tmp_path / "sheet.csv"
    path.write_text(f"{HEAD}stroke,,0.3,,,mm,0.3,\n{row}\n")
    assert acceptance_sheet.is_sheet(path)
    with pytest.raises(FeederError, match=rf"sheet\.csv:3: column '{column}': .* - "):
        acceptance_sheet.sheet(path)


@pytest.mark.parametrize(("content", "fault"), [
    (f"{HEAD}stroke,,0,3,,,mm,0.3,\n".encode(), r"sheet\.csv:2: has more cells than columns"),
    (f"{HEAD}stroke,,x,,,mm,0.3,\nstroke,,0.3,,,mm,y,\n".encode(), r"(?s)2: .*'computed'.*3: .*'measured'"),
    ((HEAD + 20_000 * LINE).encode(), "kB"),
    (b"\xff\xfe" + HEAD.encode(), "UTF-8"),
])  # fmt: skip
def test_a_sheet_is_read_within_bounds_and_tells_all_its_faults(tmp_path, content, fault):
    path = tmp_path / "sheet.csv"
    path.write_text(HEAD + LINE)
    (found,) = acceptance_sheet.sheet(path)
    assert found.quantity.isprintable() and found.measured == 2.0
    path.write_bytes(content)
    with pytest.raises(FeederError, match=fault):
        acceptance_sheet.sheet(path)
