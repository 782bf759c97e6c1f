"""The page's three plots as Bokeh figures without data: the page's own script puts the data of a state into them.

Colours are named by the variables of ``page.css``, light and dark: ``Plot.paint`` says what is painted with which.
"""

from dataclasses import dataclass

import numpy as np

from primer.scenes.base_state import T_END


@dataclass(frozen=True)
class Line:
    """A curve or shading: its colour (a variable of the style sheet), its stroke, and how the key labels it."""

    colour: str
    label: str
    dash: str = "solid"
    width: float = 2.2
    shape: str = "line"  # or "dot", "upright", "strip"


@dataclass(frozen=True)
class Plot:
    """A figure of Bokeh, and (id of a model, property, variable of the style sheet) for all that is to be painted."""

    figure: object
    paint: tuple


# None of these is told apart by its colour alone.
LINES = {
    "growth": {
        "equations": Line("--ink", "the equations"),
        "grid": Line("--v", "on the grid", dash="dashed"),
        "end": Line("--v", "shortest wave of the grid", shape="dot"),
        "grows": Line("--ill", "perturbations grow", shape="strip"),
    },
    "dist": {
        "dist": Line("--ink", "Dist"),
        "first": Line("--steady", "first u = 0", dash="dashed", width=1.6, shape="upright"),
        "foretold": Line("--v", "foretold blow-up", dash="dotted", shape="upright"),
        "blow_up": Line("--v", "blow-up", shape="upright"),
    },
    "fields": {
        "u": Line("--u", "u"),
        "v": Line("--v", "v", dash="dashed"),
        "steady": Line("--steady", "u(x, ∞) = a \N{MINUS SIGN} cos x", dash="dotted"),
        "negative": Line("--ill", "u < 0: ill posed", shape="strip"),
    },
}
_AXES = {
    "growth": {"x_range": (0, 128), "y_range": (-2, 6), "axes": ("wavenumber ξ", "growth rate max Re λ")},
    "dist": {"x_range": (0, T_END), "y_range": (1e-5, 1e3), "axes": ("t", "Dist")},
    "fields": {"x_range": (-np.pi, np.pi), "y_range": (-3, 4), "axes": ("x", "u, v")},
}


def plots():
    """Name -> :class:`Plot`; needs Bokeh."""
    return {name: _plot(name, LINES[name], **axes) for name, axes in _AXES.items()}


def _plot(name, lines, x_range, y_range, axes):
    from bokeh.models import BoxAnnotation, FixedTicker
    from bokeh.plotting import figure

    plot = figure(
        x_range=x_range,
        y_range=y_range,
        x_axis_label=axes[0],
        y_axis_label=axes[1],
        y_axis_type="log" if name == "dist" else "linear",
        height=300,
        sizing_mode="stretch_width",
        tools="",
        toolbar_location=None,
        background_fill_alpha=0,
        border_fill_alpha=0,
    )
    paint = [(plot.id, "outline_line_color", "--grid")]
    for axis in plot.axis:
        axis.axis_label_text_font_style = "normal"
        axis.major_label_text_font_size = axis.axis_label_text_font_size = "13px"
        axis.minor_tick_line_color = None
        paint += [(axis.id, f"{part}_text_color", "--ink") for part in ("major_label", "axis_label")]
        paint += [(axis.id, f"{part}_line_color", "--steady") for part in ("axis", "major_tick")]
    paint += [(grid.id, "grid_line_color", "--grid") for grid in plot.grid]
    if name == "fields":
        plot.xaxis.ticker = FixedTicker(ticks=[-np.pi, 0, np.pi])
        plot.xaxis.major_label_overrides = {-np.pi: "\N{MINUS SIGN}π", 0: "0", np.pi: "π"}
    for curve, line in lines.items():
        if curve == "grows":
            box = BoxAnnotation(bottom=0, line_color=None, fill_alpha=1, level="underlay")
            plot.add_layout(box)
            paint.append((box.id, "fill_color", line.colour))
        else:
            paint += _draw(plot, curve, line, y_range)
    return Plot(plot, tuple(paint))


def _draw(plot, name, line, y_range):
    """Add one curve, its source named ``name``; return what is to be painted."""
    from bokeh.models import ColumnDataSource

    if line.shape == "strip":
        source = ColumnDataSource({"left": [], "right": []}, name=name)
        bottom, top = y_range
        drawn = plot.quad("left", "right", top, bottom, source=source, line_color=None, level="underlay")
        return [(drawn.glyph.id, "fill_color", line.colour)]
    stroke = {"line_dash": line.dash, "line_width": line.width}
    if line.shape == "upright":
        source = ColumnDataSource({"x": []}, name=name)
        drawn = plot.segment("x", y_range[0], "x", y_range[1], source=source, **stroke)
        return [(drawn.glyph.id, "line_color", line.colour)]
    source = ColumnDataSource({"x": [], "y": []}, name=name)
    if line.shape == "dot":
        drawn = plot.scatter("x", "y", source=source, size=9, line_color=None)
        return [(drawn.glyph.id, "fill_color", line.colour)]
    drawn = plot.line("x", "y", source=source, line_join="round", **stroke)
    return [(drawn.glyph.id, "line_color", line.colour)]
