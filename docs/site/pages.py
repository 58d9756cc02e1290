"""What `make site` adds to the pages of docs/: changelog, API pages, formulas, gallery, notebooks, files.

mkdocs calls these functions by their names: https://www.mkdocs.org/user-guide/plugins/#events
"""

import base64
import os
import re
import sys
import tempfile
from pathlib import Path

import nbclient
import nbformat
from latex2mathml.converter import convert
from mkdocs.structure.files import File, InclusionLevel
from traitlets.config import Config

import feederscrew
from feederscrew.output import record_views

sys.path.insert(0, str(Path(__file__).parent))
import texts

ROOT = texts.ROOT
DOCS = ROOT / "docs"
CODE = re.compile(r"```python\n(.*?)```", re.DOTALL)
SAVED = re.compile(r'savefig\("(\w+)\.png"')
NOTEBOOKS = sorted((DOCS / "notebooks").glob("*.ipynb"))
KERNEL = Config({"KernelManager": {"transport": "ipc"}})  # through a file, not through the network
CELL_SECONDS = 900  # that one cell may take
SHOWN_PARTS = ("parts/hexbolt_m8x25.stl",)  # that a page shows to be turned
TABLE_OF_PANDAS = re.compile(r"<style[^>]*>.*?</style>", re.DOTALL)


def on_files(files, config):
    """Add the pages, pictures and files that are made at the build."""
    made = {
        "changelog.md": (ROOT / "CHANGELOG.md").read_text(),
        "overview.md": (ROOT / "README.md").read_text().replace("](docs/", "]("),
        "api.md": api(),
        **gallery((DOCS / "gallery.md").read_text()),
        **{f"viewer/{Path(name).stem}.html": viewer(name) for name in SHOWN_PARTS},
    }
    for path in NOTEBOOKS:
        made |= notebook(path)
    pages = {f.src_uri: f.content_string for f in files if f.src_uri.endswith(".md")}
    pages |= {name: text for name, text in made.items() if name.endswith(".md")}
    for place, text in pages.items():
        for name, path in texts.named_files(text, place).items():
            made.setdefault(f"{texts.FOLDER}/{name}", path.read_bytes())
    for name, content in made.items():
        files.append(File.generated(config, name, content=content, inclusion=InclusionLevel.INCLUDED))
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


def viewer(name):
    """Return the page on which a part turns, as ``part.show()`` opens it."""
    return record_views.part_page(feederscrew.load(ROOT / name))


def beside_parts(run):
    """Call a function in a folder that holds the parts, as one where a reader has put them."""
    before = Path.cwd()
    with tempfile.TemporaryDirectory() as folder:
        for part in (ROOT / "parts").glob("*.stl"):
            (Path(folder) / part.name).symlink_to(part)
        os.chdir(folder)
        try:
            return run(Path(folder))
        finally:
            os.chdir(before)


def gallery(page):
    """Run each entry of the gallery by itself; return its picture, its script and its notebook by name.

    A picture that is not made is a fault.
    """

    def run(folder):
        made = {}
        for code in CODE.findall(page):
            (name,) = SAVED.findall(code)
            exec(compile(code, f"docs/gallery.md: {name}", "exec"), {"__name__": "gallery"})
            cells = [nbformat.v4.new_code_cell(code.strip(), id=name.replace("_", "-"))]
            made[f"gallery/{name}.png"] = (folder / f"{name}.png").read_bytes()
            made[f"gallery/{name}.py"] = code
            made[f"gallery/{name}.ipynb"] = nbformat.writes(nbformat.v4.new_notebook(cells=cells))
        return made

    return beside_parts(run)


def notebook(path):
    """Run a notebook; return it with its outputs, and a page that shows it."""

    def run(folder):
        book = nbformat.read(path, as_version=4)
        place = {"metadata": {"path": folder}}
        return nbclient.NotebookClient(book, timeout=CELL_SECONDS, resources=place, config=KERNEL).execute()

    book = beside_parts(run)
    place, made = f"notebooks/{path.stem}", {}
    page = []
    for cell in book.cells:
        if cell.cell_type == "markdown":
            page.append(cell.source)
            continue
        page.append(f"```python\n{cell.source}\n```")
        for output in cell.outputs:
            data = output.get("data", {})
            if "image/png" in data:
                picture = f"{place}-{len(made) + 1}.png"
                made[picture] = base64.b64decode(data["image/png"])
                page.append(f"![What the cell draws]({Path(picture).name})")
            elif "text/html" in data:
                html = TABLE_OF_PANDAS.sub("", data["text/html"])
                page.append(f'<div class="output">{" ".join(html.split())}</div>')
            elif text := data.get("text/plain", output.get("text", "")):
                page.append(f"```\n{text.rstrip()}\n```")
    title, *rest = page
    link = f"[Download the notebook]({path.stem}.ipynb), and put the files of this page beside it."
    text = "\n\n".join([title, link, *rest])
    return {f"{place}.md": text + "\n", f"{place}.ipynb": nbformat.writes(book), **made}


def on_page_markdown(markdown, page, config, files):
    """Return the text of a page with formulas as MathML, links that lead somewhere, and its files."""
    place = page.file.src_uri
    used = texts.named_files(markdown, place)
    markdown = texts.plain_fences(markdown)
    if place == "gallery.md":
        markdown = CODE.sub(_with_pictures, markdown)

    def changed(text):
        text = texts.VIEWER.sub(_viewer, texts.without_ranges(text))
        text = texts.FORMULA.sub(_typeset, text)
        return texts.LINK.sub(lambda link: _link(link, place, files), text)

    return texts.outside_of_fences(markdown, changed) + texts.files_list(used, place)


def _viewer(mark):
    name = Path(mark[1]).stem
    title = f"{name} on each of its aspects, to be turned"
    return f'<iframe class="viewer" src="viewer/{name}.html" title="{title}" loading="lazy"></iframe>'


def _with_pictures(code):
    (name,) = SAVED.findall(code[1])
    taken = f"[script](gallery/{name}.py) · [notebook](gallery/{name}.ipynb)"
    return f"![{name.replace('_', ' ')}](gallery/{name}.png)\n\n{taken}\n\n{code[0]}\n"


def _typeset(formula):
    return "\n" + convert(" ".join(formula[1].split()), display="block") + "\n"


def _link(link, place, files):
    """A link that leads to a page, a picture or a file of the site, or the words of one that does not."""
    target = texts.link_of(link[2], place, lambda path: bool(_shown(files, path)))
    return link[1] if target is None else f"[{link[1]}]({target}{link[3] or ''})"


def _shown(files, path):
    file = files.get_file_from_path(path)
    return file if file is not None and file.inclusion.is_included() else None
