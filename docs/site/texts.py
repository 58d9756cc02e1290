"""Turn a page of docs/ into one of the site: fences, brackets, formulas, links and files to download.

Nothing here needs mkdocs: the tests read the sources with it.
"""

import posixpath
import re
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
FENCE = re.compile(r"^(```.*?^```[ \t]*$)", re.DOTALL | re.MULTILINE)
OPENING = re.compile(r"^```(\w*)[^\n`]*$", re.MULTILINE)  # with a word that the tests read: `console sampled`
FORMULA = re.compile(r"\$\$(.+?)\$\$", re.DOTALL)
LINK = re.compile(r"(?<!!)\[((?:[^\[\]]|\[[^\[\]]*\])*)\]\(([^)\s#]*)(#[^)\s]*)?\)")  # words, target, anchor
RANGE = re.compile(r"\[(\d[^\]\n]*<=x[^\]\n]*)\]")  # of a value, in the reference of commands: no link
VIEWER = re.compile(r"<!-- viewer: (\S+) -->")
TAKEN = (".csv", ".py", ".step", ".stl", ".yaml")  # files that a reader takes with him
NAMED = re.compile(r"(?<![\w/.])(?:\.\./)?((?:parts|configs|docs|benchmarks)/[\w./-]*\w)")
BARE = re.compile(r'fs\.load\("([\w.]+)"\)')  # a part beside a script
FOLDER = "files"  # of the site, below which they have the paths that they have in the project
LISTED_FILES = 12  # of one page, by name; a folder of more is named with its number
BUILT = "docs/site/"


def plain_fences(markdown):
    """Return a page whose fences open with a language alone: `console sampled` prints as prose otherwise."""
    return FENCE.sub(lambda fence: OPENING.sub(r"```\1", fence[1], count=1), markdown)


def outside_of_fences(markdown, change):
    """Return a page with ``change`` made to all that stands between its fences."""
    pieces = FENCE.split(markdown)
    pieces[::2] = map(change, pieces[::2])
    return "".join(pieces)


def without_ranges(text):
    """Return a text in which the brackets round a range are no link: '[0<=x<=1]'."""
    return RANGE.sub(r"&#91;\1&#93;", text)


def named_files(markdown, place=""):
    """Return the files of the project that a page uses, by their paths: parts, bowl files, counts, scripts.

    They are named in its text or its commands, or are where a link of the page leads. Of a folder that is
    named it is all that a reader can take.

    Parameters
    ----------
    markdown : str
    place : str
        Path of the page below docs/, from which its links lead.
    """
    names = [*NAMED.findall(markdown), *(f"parts/{name}" for name in BARE.findall(markdown))]
    folder = posixpath.dirname(f"docs/{place}")
    names += [
        posixpath.normpath(posixpath.join(folder, link[2])) for link in LINK.finditer(markdown) if link[2]
    ]
    found = {}
    for name in names:
        path = ROOT / name
        if ".." in path.parts or name.startswith(BUILT):
            continue
        if path.is_file() and path.suffix in TAKEN:
            found[name] = path
        elif path.is_dir() and path != ROOT / "docs" and path.parent != ROOT:
            found |= {f"{name}/{each.name}": each for each in sorted(path.iterdir()) if each.suffix in TAKEN}
    return dict(sorted(found.items()))


def files_list(names, place=""):
    """Return the end of a page: the files it uses, to be downloaded; nothing without any."""
    if not names:
        return ""
    start = posixpath.dirname(place) or "."
    links = (f"[`{name}`]({posixpath.relpath(f'{FOLDER}/{name}', start)})" for name in names)
    return "\n\n## Files of this page\n\n" + "\n".join(f"- {link}" for link in links) + "\n"


def link_of(target, place, has_page):
    """Return where a link of a page leads within the site; None where there is no such thing on it.

    ``has_page`` says whether a path is a page or a picture of the site.
    """
    if not target or "://" in target or target.startswith("mailto:"):
        return target
    start = posixpath.dirname(place)
    path = posixpath.normpath(posixpath.join(start, target))
    if path == "../README.md":
        return posixpath.relpath("overview.md", start or ".")
    if path == "../CHANGELOG.md":
        return posixpath.relpath("changelog.md", start or ".")
    if path.endswith(".ipynb") and has_page(path.removesuffix("ipynb") + "md"):  # which has it to be taken
        return target.removesuffix("ipynb") + "md"
    named = posixpath.normpath(posixpath.join("docs", path))
    if Path(named).suffix in TAKEN and not has_page(path):
        is_there = not named.startswith("..") and (ROOT / named).is_file()
        return posixpath.relpath(f"{FOLDER}/{named}", start or ".") if is_there else None
    return target if has_page(path) else None
