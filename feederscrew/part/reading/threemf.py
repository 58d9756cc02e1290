"""3MF files: how many bodies their nested components stand for, counted before any is placed."""

import io
import zipfile
from collections import Counter, defaultdict

MOST, DEEPEST = 5_000, 50  # instances; components within components
TAGS = ("{*}object", "{*}build")


def refuse_bombs(data):
    """Refuse a file of few bytes that stands for more bodies than can be placed.

    Parameters
    ----------
    data : bytes
        The 3MF archive.

    Raises
    ------
    ValueError
        If there are too many instances, components too deep, or one that holds itself.
    """
    parts, wanted = _components(data)
    total, level = 0, wanted
    for _ in range(DEEPEST):
        total += sum(level.values())
        if total > MOST:
            raise ValueError(f"its components stand for more than {MOST} bodies")
        if not level:
            return
        deeper: Counter[str] = Counter()
        for name, count in level.items():
            for inner, times in parts[name].items():
                deeper[inner] += count * times
        level = deeper
    raise ValueError(f"components within components more than {DEEPEST} deep")


def _components(data):
    """How often each object names each other one, and how often the build names each."""
    from lxml import etree

    parts: defaultdict[str, Counter[str]] = defaultdict(Counter)
    wanted: Counter[str] = Counter()
    with zipfile.ZipFile(io.BytesIO(data)) as archive:
        name = next(name for name in archive.namelist() if "3d/3dmodel.model" in name.lower())
        with archive.open(name) as model:
            for _, node in etree.iterparse(model, tag=TAGS, resolve_entities=False, no_network=True):
                if node.tag.endswith("object"):
                    parts[node.attrib["id"]].update(c.attrib["objectid"] for c in node.iter("{*}component"))
                else:
                    wanted.update(item.attrib["objectid"] for item in node.iter("{*}item"))
                node.clear()
    return parts, wanted
