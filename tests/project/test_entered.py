"""The figure that `make test` prints: a function counts once a test has entered it, and behaves as before."""

import inspect

import entered

SOURCE = """
import functools

def plain(a, b=2, *, c=3):
    return a + b + c

@functools.cache
def cached():
    return plain(1)

def steps(count):
    yield from range(count)

def never():
    return (lambda: 1)()

class Thing:
    @property
    def size(self):
        return 4

    @staticmethod
    def other(a):
        return a
"""


def test_a_function_counts_once_it_is_entered(tmp_path, monkeypatch):
    monkeypatch.setattr(entered, "ENTERED", set())
    monkeypatch.setattr(entered, "WAITING", {})
    names = {"__name__": "sample"}
    exec(compile(SOURCE, str(tmp_path / "sample.py"), "exec"), names)
    signature = inspect.signature(names["plain"])
    entered.replace_all(names, str(tmp_path / "sample.py"), entered.ROOT / "sample.py")
    assert inspect.signature(names["plain"]) == signature and not entered.ENTERED
    assert [names["cached"](), names["cached"](), names["plain"](1, c=0)] == [6, 6, 3]
    assert inspect.signature(names["plain"]) == signature
    assert {"sample.py:cached", "sample.py:plain"} == entered.ENTERED
    thing = names["Thing"]()
    assert [thing.size, thing.other(5), *names["steps"](2)] == [4, 5, 0, 1]
    assert {"sample.py:steps", "sample.py:Thing.size", "sample.py:Thing.other"} <= entered.ENTERED
    assert "sample.py:never" not in entered.ENTERED


def test_every_function_of_the_program_is_counted_but_those_that_numba_reads():
    names = entered.everything()
    assert {"feederscrew/units.py:quantity_text", "cli/options.py:part"} & names
    assert not [name for name in names if "/kernel/" in name or name.startswith("feederscrew/conveying/")]
    assert entered.ENTERED & names and set(entered.WAITING) <= names
