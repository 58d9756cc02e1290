"""The compiled sweep: the same answers as the plain functions, faults named, sources traced."""

import numpy as np
import pytest
from conveying_reference import random_settings

from feederscrew.conveying import answer, steady
from feederscrew.conveying.operating_point import OperatingPoint, plain


@pytest.fixture(scope="module")
def settings():
    box = random_settings(40, np.random.default_rng(8))
    return np.array([plain(*row, restitution) for row in box for restitution in (0.0, 0.4)])


def test_threads_change_nothing(settings):
    many = np.tile(settings, (8, 1))
    np.testing.assert_array_equal(answer.sweep(many, workers=3), answer.sweep(many, workers=1))


def test_every_status():
    rows = [plain(0.5, 0.5, 0.0, 0.3), plain(4.5, 0.5236, 0.0, 0.3, 0.6), plain(2.0, 0.5, 0.35, 0.3)]
    found = answer.sweep(np.array(rows))[:, steady.STATUS]
    assert [steady.STATUSES[int(code)] for code in found] == list(steady.STATUSES)


def test_a_compiled_kernel_is_kept(settings):
    answer.sweep(settings[:1])
    assert answer.sweep_compiled()


def test_faults_of_a_row(settings):
    wrong = settings.copy()
    wrong[3, OperatingPoint._fields.index("kinetic")] = 2.0
    with pytest.raises(ValueError, match="kinetic friction is above static"):
        answer.sweep(wrong)
    with pytest.raises(ValueError, match="shape"):
        answer.sweep(settings[:, :5])
