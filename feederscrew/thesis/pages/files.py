"""The files and documents of ``feeder reproduce``."""

from feederscrew.output import style, tables
from feederscrew.output.page.as_html import html
from feederscrew.output.page.as_markdown import markdown
from feederscrew.thesis.figure_data import FIGURES
from feederscrew.thesis.findings import FINDINGS
from feederscrew.thesis.pages import figures as thesis_plots
from feederscrew.thesis.pages import page as thesis_page
from feederscrew.thesis.reproduction import summary

BY_NUMBER = {figure.number: figure for figure in FIGURES}


def overview(items):
    """One row an item: its cells by verdict.

    Parameters
    ----------
    items : sequence of thesis.reproduction.Item

    Returns
    -------
    Frame
    """
    counts = [summary(item) for item in items]
    columns = {"item": [f"{item.kind} {item.id}" for item in items]}
    columns |= {name: [count[name] for count in counts] for name in counts[0]}
    return tables.frame(columns | {"findings": ["; ".join(item.findings) for item in items]})


def document(items, files):
    """Return the items as one JSON document.

    Parameters
    ----------
    items : sequence of thesis.reproduction.Item
    files : dict of str to sequence of str
        Files written, by the item's stem.

    Returns
    -------
    dict
    """
    listed = [
        {
            "id": item.id,
            "kind": item.kind,
            "caption": item.caption,
            **summary(item),
            "findings": item.findings,
            "files": files.get(item.stem, []),
        }
        for item in items
    ]
    return {"items": listed, "findings": [_told(finding) for finding in FINDINGS]}


def write(folder, items):
    """Return tables, pictures and the page.

    Parameters
    ----------
    folder : ResultFolder
    items : sequence of thesis.reproduction.Item

    Returns
    -------
    dict of str to list of str
        Files by the item's stem.
    """
    files, pictures = {}, {}
    for item in items:
        files[item.stem] = [f"{item.stem}.csv"]
        if item.kind == "figure":
            figure = BY_NUMBER[item.id]
            pictures[f"{item.stem}.png"] = style.png(thesis_plots.drawn(figure))
            files[item.stem] += [f"{item.stem}.png", f"{item.stem}_statements.csv"]
            folder.write(f"{item.stem}.csv", tables.text(thesis_plots.numbers(figure), "csv"))
            folder.write(f"{item.stem}_statements.csv", tables.text(statements(item), "csv"))
        else:
            folder.write(f"{item.stem}.csv", tables.text(cells(item), "csv"))
    for name, content in pictures.items():
        folder.write(name, content)
    page = thesis_page.page(items, pictures)
    folder.write("thesis.md", markdown(page))
    folder.write("thesis.html", html(page))
    folder.write("summary.csv", tables.text(overview(items), "csv"))
    folder.write("findings.csv", tables.text(_findings(), "csv"))
    return files


def cells(item):
    """Return cells of a table: print, ours, deviation, verdict and finding.

    Parameters
    ----------
    item : thesis.reproduction.Item

    Returns
    -------
    Frame
    """
    entries = item.entries
    columns = {name: [getattr(entry, name) for entry in entries] for name in ("row", "column", "published")}
    columns["recomputed"] = [thesis_page.digits(entry, entry.recomputed) for entry in entries]
    columns["deviation"] = [entry.deviation for entry in entries]
    columns["verdict"] = [entry.verdict for entry in entries]
    columns["explaining"] = [thesis_page.digits(entry, entry.explaining) for entry in entries]
    return tables.frame(columns | {"finding": [entry.finding for entry in entries]})


def statements(item):
    """Return what print states on a figure, checked.

    Parameters
    ----------
    item : thesis.reproduction.Item

    Returns
    -------
    Frame
    """
    names = ("statement", "published", "recomputed", "verdict", "finding")
    return tables.frame({name: [getattr(entry, name) for entry in item.entries] for name in names})


def _findings():
    lines = [_told(finding) for finding in FINDINGS]
    return tables.frame({name: [each[name] for each in lines] for name in lines[0]})


def _told(finding):
    return {"id": finding.id, "where": finding.where, "what": finding.what, "shown": finding.shown}
