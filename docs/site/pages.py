"""What `make site` adds to the pages of docs/: changelog, API pages, formulas, pictures of the gallery.

mkdocs calls these functions by their names: https://www.mkdocs.org/user-guide/plugins/#events
"""

import os
import posixpath
import re
import tempfile
from pathlib import Path

from latex2mathml.converter import convert
from mkdocs.structure.files import File

import feederscrew

ROOT = Path(__file__).resolve().parents[2]
FORMULA = re.compile(r"\$\$(.+?)\$\$", re.DOTALL)
CODE = re.compile(r"```python\n(.*?)```", re.DOTALL)
SAVED = re.compile(r'savefig\("(\w+\.png)"')
LINK = re.compile(r"\]\(([^)\s#]*)(#[^)\s]*)?\)")
RANGE = re.compile(r"\[(\d[^\]\n]*<=x[^\]\n]*)\]")  # of a value, in the reference of commands: no link
FENCE = re.compile(r"(```.*?```)", re.DOTALL)


def on_files(files, config):
    """Add the pages and pictures that are made at the build."""
    made = {
        "changelog.md": (ROOT / "CHANGELOG.md").read_text(),
        "overview.md": (ROOT / "README.md").read_text().replace("](docs/", "]("),
        "api.md": api(),
        **pictures((ROOT / "docs/gallery.md").read_text()),
    }
    for name, content in made.items():
        files.append(File.generated(config, name, content=content))
    return files


def api():
    """Return the page of every public name, from its docstring."""
    functions, records = [], []
    for name in feederscrew.__all__:
        value = getattr(feederscrew, name)
        (records if isinstance(value, type) else functions).append(f"::: {value.__module__}.{name}\n")
    lead = "Every name of `import feederscrew as fs`. How they are used: [feeder as a library](library.md)."
    return "\n".join(
        ["# Python API", "", lead, "", "## Functions", "", *functions, "## Records and errors", "", *records]
    )


def pictures(page):
    """Run the code of the gallery and return its pictures by name; a picture that is not made is a fault."""
    names = {"__name__": "gallery"}
    made = {}
    before = Path.cwd()
    with tempfile.TemporaryDirectory() as folder:
        for part in (ROOT / "parts").glob("*.stl"):
            (Path(folder) / part.name).symlink_to(part)
        os.chdir(folder)
        try:
            for code in CODE.findall(page):
                exec(compile(code, "docs/gallery.md", "exec"), names)
                made |= {f"gallery/{name}": Path(name).read_bytes() for name in SAVED.findall(code)}
        finally:
            os.chdir(before)
    return made


def on_page_markdown(markdown, page, config, files):
    """Return the text of a page with formulas as MathML, and links to other files of the project as names."""
    if page.file.src_uri == "gallery.md":
        markdown = CODE.sub(_with_pictures, markdown)
    pieces = FENCE.split(markdown)
    for k in range(0, len(pieces), 2):
        pieces[k] = RANGE.sub(r"&#91;\1&#93;", pieces[k])
        pieces[k] = FORMULA.sub(_typeset, pieces[k])
        pieces[k] = LINK.sub(lambda link: _link(link, page, files), pieces[k])
    return "".join(pieces)


def _with_pictures(code):
    shown = "".join(f"\n![{name.removesuffix('.png')}](gallery/{name})\n" for name in SAVED.findall(code[1]))
    return code[0] + "\n" + shown


def _typeset(formula):
    return "\n" + convert(" ".join(formula[1].split()), display="block") + "\n"


def _link(link, page, files):
    """A link that leads to a page or a picture of the site, or the name of a file that does not."""
    target, anchor = link[1], link[2] or ""
    if not target or "://" in target:
        return link[0]
    path = posixpath.normpath(posixpath.join(posixpath.dirname(page.file.src_uri), target))
    if path == "../README.md":
        return f"]({posixpath.relpath('overview.md', posixpath.dirname(page.file.src_uri) or '.')}{anchor})"
    if files.get_file_from_path(path):
        return f"]({target}{anchor})"
    return "]"
