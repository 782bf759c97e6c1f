"""What a ``draw_*`` function put on axes, as plain data that a page draws again: nothing is computed a second time."""

from typing import Any

import numpy as np
from matplotlib.collections import PolyCollection, QuadMesh
from matplotlib.colors import to_hex
from matplotlib.lines import Line2D
from matplotlib.patches import Rectangle
from matplotlib.text import Annotation

from primer.view.page.words import plain

_DASHES = {"-": "", "--": "6 4", "-.": "8 3 2 3", ":": "2 3", "None": None, "": None}
_THIN = 8  # of a polar curve, drawn with many points for print, every so many are kept


def recorded(ax):
    """(frame, elements, key) of axes: dicts and lists of plain values and NumPy arrays.

    frame       title, labels, limits, scales and ticks
    elements    in the order they are drawn: lines, areas, cells of a map, texts; each coordinate in "d"ata, or in the
                "f"raction of the axes
    key         rows of the legend: what is said, and how it is drawn
    """
    if ax.name == "polar":
        return _frame(ax), [*map(_disc, (*ax.patches, *ax.lines)), *_texts(ax)], _key(ax)
    drawn = sorted((*ax.collections, *ax.patches, *ax.lines), key=lambda artist: artist.get_zorder())
    elements = [element for artist in drawn if (element := _element(ax, artist)) is not None]
    return _frame(ax), [*elements, *_texts(ax)], _key(ax)


def _frame(ax):
    frame = {"title": plain(ax.get_title() or ax.get_title(loc="left"))}
    if ax.name == "polar":
        ticks = zip(ax.get_yticks(), ax.get_yticklabels(), strict=True)
        rings = [(float(r / ax.get_rmax()), plain(text.get_text())) for r, text in ticks]
        return frame | {"kind": "disc", "rings": rings, "names": ["major", "minor"]}
    if not ax.axison:
        return frame | {"kind": "text"}
    frame["kind"] = "axes"
    for name, axis, limits in (("x", ax.xaxis, ax.get_xlim()), ("y", ax.yaxis, ax.get_ylim())):
        values = [value for value in axis.get_major_locator()() if min(limits) <= value <= max(limits)]
        texts = axis.get_major_formatter().format_ticks(values)
        scale = axis.get_scale()
        frame[name] = {
            "label": plain(axis.get_label_text()),
            "limits": [float(limit) for limit in limits],
            "scale": scale,
            "width": float(axis.get_transform().linear_width) if scale == "asinh" else 1.0,
            "ticks": [(float(value), plain(text)) for value, text in zip(values, texts, strict=True)],
        }
    return frame


def _element(ax, artist):
    for kind, record in _RECORD.items():
        if isinstance(artist, kind) and artist.get_visible():
            return record(ax, artist)
    return None  # a hatch, say


def _line(ax, line):
    x, y = line.get_xydata().T
    return _stroke(line) | {"kind": "line", "in": _units(ax, line), "x": _array(x), "y": _array(y)}


def _cells(ax, mesh):
    colours = [to_hex(colour) if colour[3] > 0 else "" for colour in mesh.to_rgba(mesh.get_array().ravel())]
    corners = mesh.get_coordinates()
    return {"kind": "cells", "x": _array(corners[0, :, 0]), "y": _array(corners[:, 0, 1]), "colours": colours}


def _span(ax, area):
    """What axhspan makes."""
    low, high = area.get_y(), area.get_y() + area.get_height()
    place = {"x": _array([0, 1, 1, 0]), "y": _array([low, low, high, high])}
    return {"kind": "area", "in": "fd", "fill": to_hex(area.get_facecolor())} | place


def _filled(ax, areas):
    if not areas.get_paths() or areas.get_hatch() is not None:
        return None
    x, y = np.concatenate([[*path.vertices, (np.nan, np.nan)] for path in areas.get_paths()]).T
    look = {"kind": "area", "in": _units(ax, areas), "fill": to_hex(areas.get_facecolor()[0])}
    return look | {"x": _array(x), "y": _array(y)}


_RECORD: dict[Any, Any] = {Line2D: _line, QuadMesh: _cells, Rectangle: _span, PolyCollection: _filled}


def _disc(artist):
    """A line or a filled curve over direction, as points of the unit disc."""
    filled = not isinstance(artist, Line2D)
    theta, r = (artist.get_xy() if filled else artist.get_xydata())[::_THIN].T
    r = r / artist.axes.get_rmax()
    place = {"in": "dd", "x": _array(r * np.cos(theta)), "y": _array(r * np.sin(theta))}
    look = {"kind": "area", "fill": to_hex(artist.get_facecolor())} if filled else _stroke(artist) | {"kind": "line"}
    return look | place


def _stroke(line):
    marker = line.get_marker()
    look = {"colour": to_hex(line.get_color()), "dash": _DASHES[line.get_linestyle()], "width": line.get_linewidth()}
    if marker not in ("None", "", None):
        face = line.get_markerfacecolor()
        look |= {"marker": marker, "size": line.get_markersize()}
        look |= {"face": "" if face == "none" else to_hex(face), "edge": to_hex(line.get_markeredgecolor())}
    return look


def _units(ax, artist):
    return "".join("d" if data else "f" for data in artist.get_transform().contains_branch_seperately(ax.transData))


def _texts(ax):
    for text in ax.texts:
        if text.get_text():
            note = isinstance(text, Annotation)
            dx, dy = text.get_position() if note else (0, 0)
            x, y = text.xy if note else text.get_position()
            units = text.xycoords if note else ("data" if text.get_transform() == ax.transData else "axes fraction")
            units = (units, units) if isinstance(units, str) else units
            yield {
                "kind": "text",
                "in": "".join("d" if unit == "data" else "f" for unit in units),
                "at": [float(x), float(y), float(dx), float(dy)],
                "text": plain(text.get_text()),
                "colour": to_hex(text.get_color()),
                "anchor": {"left": "start", "center": "middle", "right": "end"}[text.get_ha()],
                "up": text.get_va() == "top",
                "mono": "monospace" in text.get_family(),
            }


def _key(ax):
    legend = ax.get_legend()
    if legend is None:
        return []
    rows = []
    for handle, text in zip(legend.legend_handles, legend.get_texts(), strict=True):
        look = _stroke(handle) if isinstance(handle, Line2D) else {"fill": to_hex(handle.get_facecolor())}
        rows.append(look | {"text": plain(text.get_text())})
    return rows


def _array(values):
    return np.asarray(values, dtype="<f4")
