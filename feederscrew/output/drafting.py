"""Technical drawings on A3 sheets: entities of a DXF file with real dimensions, and the same as PDF and SVG.

A sheet is drawn once, as entities of ``ezdxf``. The figure of a sheet is made from these entities. Its
letters stay letters, which ``ezdxf.addons.drawing`` turns into outlines: a search in the PDF finds them.
"""

import io
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.backends.backend_pdf import PdfPages
from matplotlib.backends.backend_svg import FigureCanvasSVG
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from matplotlib.patches import PathPatch
from matplotlib.path import Path
from numpy.typing import ArrayLike

from feederscrew.base import dxf
from feederscrew.base.arrays import Floats
from feederscrew.base.signatures import Keywords
from feederscrew.output import marking, style

A3 = 420.0, 297.0  # [mm]
FRAME = 20.0, 10.0, 410.0, 287.0  # [mm] left, low, right, high: ISO 5457
SHEET_GAP_MM = 30.0  # [mm] between the sheets in the DXF file
INCH_MM = 25.4  # [mm]
CAPITAL = 0.72  # [1] height of a capital over the size of its font
POINT = 72.0 / INCH_MM / CAPITAL  # [pt] of a font whose capitals are one millimetre high
DRAWN_ARC_CHORD_MM = 0.02  # [mm] by which an arc may be seen too flat
NUMBER_HEIGHT_MM, TABLE_LETTER_HEIGHT_MM = 2.5, 2.2  # [mm] height of letters
THICK_LINE_MM, THIN_LINE_MM = 0.5, 0.18  # [mm] width of lines: ISO 128-2
LINE_TYPES = {  # ISO 128-2: name, its description, and its dashes [mm]
    "DASHED": ("dashed", (3.0, 1.0)),
    "CENTER": ("long dashed dotted", (6.0, 1.0, 0.5, 1.0)),
}


@dataclass(frozen=True)
class Pen:
    """Look of the entities of a layer."""

    colour: int = 7  # of AutoCAD's index, in the DXF file: 1 red, 3 green, 5 blue, 7 white or black, 8 grey
    ink: str = style.INK  # on paper
    width: float = THIN_LINE_MM  # [mm]
    dashes: str = ""  # of LINE_TYPES
    face: str = ""  # colour within closed outlines; '' for none


PENS = {
    "EDGE": Pen(),
    "OUTLINE": Pen(width=THICK_LINE_MM),
    "FRAME": Pen(width=THICK_LINE_MM),
    "CENTRE": Pen(8, dashes="CENTER"),
    "HIDDEN": Pen(8, dashes="DASHED"),
    "SECTION": Pen(width=THICK_LINE_MM, face="#dfe6ec"),
    "DIMENSION": Pen(),
    "TEXT": Pen(),
    "NOTE": Pen(1, ink=style.ACCENT),
    "TABLE": Pen(),
    "MARK": Pen(1, ink=marking.MARK_COLOUR),
}


class Drawing:
    """Sheets of a drawing; places are in millimetres from the lower left corner of the present sheet."""

    def __init__(self, pens: dict[str, Pen] | None = None) -> None:
        self.pens = PENS | (pens or {})
        self.document = dxf.new_document()
        for name, (words, dashes) in LINE_TYPES.items():
            gaps = [size if k % 2 == 0 else -size for k, size in enumerate(dashes)]
            self.document.linetypes.add(name, pattern=[sum(dashes), *gaps], description=words)
        self.document.styles.add("SHEET", font="arial.ttf")
        self.space = self.document.modelspace()
        self.sheets: list[list[tuple[str, str, Any, bool]]] = [[]]  # layer, kind, what is drawn, bold

    @property
    def origin(self) -> Floats:
        """Place (2,) [mm] of the present sheet in the DXF file."""
        return np.array([(len(self.sheets) - 1) * (A3[0] + SHEET_GAP_MM), 0.0])

    def new_sheet(self) -> None:
        """Begin another sheet, to the right of the former ones."""
        self.sheets.append([])

    # entities

    def outline(self, corners: ArrayLike, layer: str, is_closed: bool = True) -> None:
        """Draw a polyline.

        Parameters
        ----------
        corners : (K, 2) array_like [mm]
        layer : str
        is_closed : bool, optional
            Whether it goes back to the first corner.
        """
        places = np.asarray(corners, float) + self.origin
        self.space.add_lwpolyline(places.tolist(), close=is_closed, dxfattribs=self._look(layer))
        points = np.vstack([places, places[:1]]) if is_closed else places
        self.sheets[-1].append((layer, "line", points, False))

    def lines(self, pieces: Iterable[ArrayLike], layer: str = "EDGE") -> None:
        """Draw open lines.

        Parameters
        ----------
        pieces : iterable of (K, 2) float [mm]
        layer : str, optional
        """
        for piece in pieces:
            self.outline(piece, layer, is_closed=False)

    def box(self, left: float, low: float, right: float, high: float, layer: str = "FRAME") -> None:
        """Draw a rectangle.

        Parameters
        ----------
        left, low, right, high : float [mm]
        layer : str, optional
        """
        self.outline([(left, low), (right, low), (right, high), (left, high)], layer)

    def circle(self, middle: ArrayLike, radius: float, layer: str = "EDGE") -> None:
        """Draw a circle.

        Parameters
        ----------
        middle : (2,) float [mm]
        radius : float [mm]
        layer : str, optional
        """
        self._record(self.space.add_circle(self._in_file(middle), radius, dxfattribs=self._look(layer)))

    def hatch(self, rings: Sequence[ArrayLike]) -> None:
        """Draw the cut face of closed outlines, holes among them.

        Parameters
        ----------
        rings : sequence of (K, 2) float [mm]
        """
        hatch = self.space.add_hatch(dxfattribs=self._look("SECTION"))
        hatch.set_pattern_fill("ANSI31", scale=1.0)
        for ring in rings:
            hatch.paths.add_polyline_path([tuple(place) for place in np.asarray(ring, float) + self.origin])
        self._record(hatch)
        for ring in rings:
            self.outline(ring, "SECTION")

    def text(
        self,
        x: float,
        y: float,
        words: str,
        size: float = NUMBER_HEIGHT_MM,
        align: str = "left",
        turn: float = 0.0,
        bold: bool = False,
        layer: str = "TEXT",
    ) -> None:
        """Write one line.

        Parameters
        ----------
        x, y : float [mm]
            Its place.
        words : str
        size : float [mm], optional
            Height of the letters.
        align : str, optional
            'left', 'center' or 'right' of the place.
        turn : float [deg], optional
            Counter-clockwise.
        bold : bool, optional
        layer : str, optional
        """
        entity = self.space.add_text(
            words, height=size, rotation=turn, dxfattribs=self._look(layer) | {"style": "SHEET"}
        )
        entity.dxf.halign = ("left", "center", "right").index(align)
        entity.dxf.insert = entity.dxf.align_point = self._in_file((x, y))
        self._record(entity, bold)

    def table(
        self,
        left: float,
        top: float,
        widths: Sequence[float],
        rows: Sequence[Sequence[str]],
        size: float = TABLE_LETTER_HEIGHT_MM,
        line: float = 4.6,
    ) -> float:
        """Draw a table.

        Parameters
        ----------
        left, top : float [mm]
            Its upper left corner.
        widths : sequence of float [mm]
            Of the columns.
        rows : sequence of sequence of str
            The first is its head.
        size : float [mm], optional
            Height of the letters.
        line : float [mm], optional
            Height of a row.

        Returns
        -------
        float [mm]
            Height of its lower border.
        """
        right, low = left + sum(widths), top - line * len(rows)
        self.lines(([(left, top - line * k), (right, top - line * k)] for k in range(len(rows) + 1)), "TABLE")
        edges = left + np.concatenate([[0.0], np.cumsum(widths)])
        self.lines(([(x, top), (x, low)] for x in edges), "TABLE")
        for k, row in enumerate(rows):
            for x, words in zip(edges, row):
                self.text(float(x) + 1.0, top - line * (k + 1) + 1.2, words, size, bold=k == 0)
        return low

    # dimensions

    def length(
        self,
        start: ArrayLike,
        end: ArrayLike,
        offset: ArrayLike,
        scale: float = 1.0,
        text: str = "<>",
        decimals: int = 2,
    ) -> None:
        """Dimension the distance of two places.

        Parameters
        ----------
        start, end : (2,) float [mm]
        offset : (2,) float [mm]
            By which its line is moved off, square to it.
        scale : float [1], optional
            Of what is drawn: the number is the distance over it.
        text : str, optional
            With '<>' for the number.
        decimals : int, optional
        """
        start, end, offset = (np.asarray(p, float) for p in (start, end, offset))
        x, y = end - start
        if np.abs(offset).max() > 1e-9:  # its line is square to the way it is moved off
            x, y = offset[1], -offset[0]
        turn = (np.degrees(np.arctan2(y, x)) + 89.999) % 180.0 - 89.999
        places = {"base": self._in_file(start + offset), "p1": self._in_file(start), "p2": self._in_file(end)}
        self._measure(self.space.add_linear_dim, scale, decimals, angle=float(turn), text=text, **places)

    def ordinate(
        self, place: ArrayLike, end: ArrayLike, origin: ArrayLike, upright: bool, scale: float = 1.0
    ) -> None:
        """Dimension a place from an origin, along one axis.

        Parameters
        ----------
        place : (2,) float [mm]
        end : (2,) float [mm]
            Where the number stands.
        origin : (2,) float [mm]
        upright : bool
            Along Y; else along X.
        scale : float [1], optional
            Of what is drawn.
        """
        x, y = np.asarray(end, float) - np.asarray(place, float)
        places = {"feature_location": self._in_file(place), "origin": self._in_file(origin)}
        add = self.space.add_ordinate_y_dim if upright else self.space.add_ordinate_x_dim
        self._measure(add, scale, 2, offset=(float(x), float(y)), **places)

    def angle(self, middle: ArrayLike, radius: float, start: float, end: float) -> None:
        """Dimension an angle counter-clockwise about a middle, on an arc.

        Parameters
        ----------
        middle : (2,) float [mm]
        radius : float [mm]
            Of the arc.
        start, end : float [deg]
        """
        ends = {"start_angle": start, "end_angle": end, "radius": 0.8 * radius, "distance": 0.2 * radius}
        self._measure(self.space.add_angular_dim_cra, 1.0, 2, center=self._in_file(middle), text="<>", **ends)

    def round_size(
        self,
        middle: ArrayLike,
        radius: float,
        turn: float,
        scale: float = 1.0,
        diameter: bool = False,
        text: str = "<>",
        decimals: int = 2,
    ) -> None:
        """Dimension a radius, or a diameter, of a circle.

        Parameters
        ----------
        middle : (2,) float [mm]
        radius : float [mm]
        turn : float [deg]
            At which the dimension stands.
        scale : float [1], optional
            Of what is drawn.
        diameter : bool, optional
        text : str, optional
            With '<>' for the number.
        decimals : int, optional
        """
        add = self.space.add_diameter_dim if diameter else self.space.add_radius_dim
        size = {"radius": radius, "angle": turn, "text": text}
        self._measure(add, scale, decimals, center=self._in_file(middle), **size)

    def mark(self, words: str, low: ArrayLike = (0.0, 0.0), size: tuple[float, float] = A3) -> None:
        """Write a mark from corner to corner of the present sheet, on a layer of its own.

        Parameters
        ----------
        words : str
            '' for none.
        low : (2,) float [mm], optional
            Lower left corner.
        size : (float, float) [mm], optional
            Width and height of the sheet.
        """
        if words:
            height, turn = marking.diagonal(size, words)
            middle = np.asarray(low, float) + 0.5 * np.asarray(size)
            x, y, degrees = float(middle[0]), float(middle[1]), np.degrees(turn)
            self.text(x, y, words, CAPITAL * height, "center", degrees, bold=True, layer="MARK")

    # files

    def dxf(self) -> bytes:
        """Return the sheets as the bytes of a DXF file in millimetres, beside each other."""
        return dxf.document_bytes(self.document)

    def pdf(self, title: str) -> bytes:
        """Return the sheets as the pages of a PDF without a date.

        Parameters
        ----------
        title : str

        Returns
        -------
        bytes
        """
        file = io.BytesIO()
        with PdfPages(file, metadata={"Title": title, "CreationDate": None}) as pages:
            for sheet in range(len(self.sheets)):
                pages.savefig(self.figure(sheet))
        return file.getvalue()

    def svg(self, low: ArrayLike, high: ArrayLike) -> str:
        """Return what lies between two corners of the first sheet as an SVG file of true size.

        Parameters
        ----------
        low, high : (2,) float [mm]

        Returns
        -------
        str
        """
        import matplotlib

        file = io.StringIO()
        with matplotlib.rc_context({"svg.fonttype": "none", "svg.hashsalt": "feeder"}):
            figure = self.figure(0, low, high)
            FigureCanvasSVG(figure).print_svg(file, metadata={"Date": None})
        text = file.getvalue()
        return text[text.index("<svg ") :]

    def figure(self, sheet: int = 0, low: ArrayLike = (0.0, 0.0), high: ArrayLike = A3) -> Figure:
        """Return a sheet between two corners as a figure of true size.

        Parameters
        ----------
        sheet : int, optional
        low, high : (2,) float [mm], optional

        Returns
        -------
        matplotlib.figure.Figure
        """
        low, high = np.asarray(low, float), np.asarray(high, float)
        figure = Figure(figsize=tuple((high - low) / INCH_MM), facecolor="white")
        axes = figure.add_axes((0, 0, 1, 1), xlim=(low[0], high[0]), ylim=(low[1], high[1]))
        axes.set_axis_off()
        shift = np.array([sheet * (A3[0] + SHEET_GAP_MM), 0.0])
        lines: dict[str, list[Any]] = {}
        for layer, kind, drawn, bold in self.sheets[sheet]:
            pen = self._pen(layer)
            for shape, value in (
                dxf.primitives(drawn, DRAWN_ARC_CHORD_MM) if kind == "entity" else ((kind, drawn),)
            ):
                if shape == "text":
                    words, place, height, turn, across, up = value
                    x, y = np.asarray(place) - shift
                    axes.text(
                        x,
                        y,
                        words,
                        fontsize=height * POINT,
                        color=pen.ink,
                        rotation=turn,
                        rotation_mode="anchor",
                        ha=across,
                        va=up,
                        parse_math=False,
                        fontweight="bold" if bold else "normal",
                        gid=layer,
                        alpha=marking.STRENGTH if layer == "MARK" else None,
                    )
                elif shape == "area":
                    rings = [Path(np.vstack([ring, ring[:1]]) - shift, closed=True) for ring in value]
                    whole = Path.make_compound_path(*rings)
                    axes.add_patch(PathPatch(whole, facecolor=pen.face or pen.ink, linewidth=0.0, gid=layer))
                elif pen.face and layer != "SECTION":
                    look = self._line_look(layer) | {"facecolor": pen.face, "edgecolor": pen.ink}
                    axes.add_patch(PathPatch(Path(value - shift), zorder=0.9, **look))
                else:
                    lines.setdefault(layer, []).append(value - shift)
        for layer, pieces in lines.items():
            look = self._line_look(layer, "s")
            axes.add_collection(LineCollection(pieces, colors=self._pen(layer).ink, **look))
        return figure

    def texts(self, sheet: int = 0) -> list[str]:
        """Return what is written on a sheet, numbers of dimensions among it.

        Parameters
        ----------
        sheet : int, optional

        Returns
        -------
        list of str
        """
        from matplotlib.text import Text

        return [text.get_text() for text in self.figure(sheet).findobj(Text) if text.get_text()]

    # helpers

    def _in_file(self, place: ArrayLike) -> tuple[float, float]:
        x, y = np.asarray(place, float) + self.origin
        return float(x), float(y)

    def _look(self, layer: str) -> Keywords:
        if layer not in self.document.layers:
            pen = self._pen(layer)
            look = {"color": pen.colour, "linetype": pen.dashes or "CONTINUOUS"}
            self.document.layers.add(layer, **look, lineweight=round(100 * pen.width))
        return {"layer": layer}

    def _record(self, entity: Any, bold: bool = False) -> None:
        self.sheets[-1].append((entity.dxf.layer, "entity", entity, bold))

    def _measure(self, add: Callable[..., Any], scale: float, decimals: int, **sizes: Any) -> None:
        """Add a dimension in the style of a scale, which is made where there is none yet."""
        name = f"SCALE_{scale:g}_{NUMBER_HEIGHT_MM:g}_{decimals}".replace(".", "P")
        if name not in self.document.dimstyles:
            look = {
                "dimtxt": NUMBER_HEIGHT_MM,
                "dimasz": 0.8 * NUMBER_HEIGHT_MM,
                "dimexe": 1.0,
                "dimexo": 0.6,
                "dimgap": 0.6,
                "dimtad": 1,
                "dimtih": 0,
                "dimtoh": 0,
                "dimdec": decimals,
                "dimadec": 1,
                "dimazin": 2,
                "dimzin": 8,
                "dimlfac": 1.0 / scale,
                "dimtxsty": "SHEET",
                "dimdsep": ord("."),
            }
            self.document.dimstyles.new(name, dxfattribs=look)
        dimension = add(**sizes, dimstyle=name, dxfattribs=self._look("DIMENSION"))
        dimension.render()
        self._record(dimension.dimension)

    def _pen(self, layer: str) -> Pen:
        return self.pens.get(layer) or self.pens[layer.removeprefix("BENT_").partition("_")[0]]  # BENT_CUT_2

    def _line_look(self, layer: str, plural: str = "") -> style.Look:
        """The width and dashes of a layer's lines, as matplotlib takes them."""
        pen = self._pen(layer)
        dashes = [size / pen.width for size in LINE_TYPES[pen.dashes][1]] if pen.dashes else ()
        return {
            f"linewidth{plural}": 72.0 / INCH_MM * pen.width,
            f"linestyle{plural}": (0, dashes) if dashes else "-",
            "gid": layer,
        }


def spread(targets: ArrayLike, gap: float) -> Floats:
    """Return places near the wanted ones, in their order, that stand apart.

    Parameters
    ----------
    targets : (N,) float [mm]
    gap : float [mm]
        No two places are nearer.

    Returns
    -------
    (N,) float [mm]
    """
    targets = np.asarray(targets, float)
    order = np.argsort(targets, kind="stable")
    steps = np.arange(len(order)) * gap
    lower = np.maximum.accumulate(targets[order] - steps)
    upper = np.minimum.accumulate((targets[order] - steps)[::-1])[::-1]
    places = np.empty(len(order))
    places[order] = 0.5 * (lower + upper) + steps
    return places


def scale_words(scale: float) -> str:
    """Return a scale as it is written: '1:2.5'.

    Parameters
    ----------
    scale : float
        Length on paper over length of the part.

    Returns
    -------
    str
    """
    return f"1:{1.0 / scale:g}" if scale <= 1.0 else f"{scale:g}:1"
