"""docs/bowl.md: every example runs and prints what the page says."""

import re
import shlex
from pathlib import Path

import numpy as np
import pytest

ROOT = Path(__file__).parents[2]
BLOCK = re.compile(r"```console\n\$ feeder (.*)\n((?:(?!```).*\n)*)```")
NUMBER = re.compile(r"(?<![\w^])-?\d+(?:\.\d+)?(?!\w)")
NEAR = 0.02  # relative; the rate of a bowl left alone hangs on hops, and on the processor


@pytest.mark.thorough
def test_the_page_is_true(run, monkeypatch):
    examples = BLOCK.findall((ROOT / "docs/bowl.md").read_text())
    assert len(examples) == 2
    monkeypatch.chdir(ROOT)
    for line, shown in examples:
        printed = run(*shlex.split(line)).stdout
        whole = not shown.endswith("...\n")  # one that is cut keeps its first lines
        for was, now in zip(shown.removesuffix("...\n").splitlines(), printed.splitlines(), strict=whole):
            assert " ".join(NUMBER.sub("#", was).split()) == " ".join(NUMBER.sub("#", now).split())
            if "left alone" not in was:
                before, after = (np.array(NUMBER.findall(one), dtype=float) for one in (was, now))
                np.testing.assert_allclose(after, before, rtol=NEAR, atol=1e-9)
