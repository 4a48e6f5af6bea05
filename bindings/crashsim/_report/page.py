"""The page: one HTML document that needs nothing else, and lets nothing else in."""

from __future__ import annotations

import base64
import hashlib
from collections.abc import Sequence
from dataclasses import dataclass
from importlib import import_module, resources

from .figures import MOST_POINTS, Curve, Figure, plotly_figure
from .markup import Content, Markup, inline_json, tag

DASH_ARRAYS = {"solid": None, "dash": "7 4", "dashdot": "7 3 1.5 3", "dot": "2 3", "longdash": "11 4"}


@dataclass(frozen=True)
class Section:
    """A part of the page with a heading; the navigation links to it."""

    key: str
    title: str
    content: Sequence[Content]


def plotly_script() -> str:
    """Plotly's JavaScript. ImportError when Plotly is not installed."""
    try:
        offline = import_module("plotly.offline")
    except ImportError as error:
        raise ImportError("reports need Plotly: pip install 'crashsim[report]'") from error
    return str(offline.get_plotlyjs())


def own_file(name: str) -> str:
    """A file of this package."""
    return resources.files(__package__ or __name__).joinpath(name).read_text(encoding="utf-8")


def page(title: str, header: Content, sections: Sequence[Section]) -> str:
    """The document. Its policy forbids the network and every script but its own two, known by their hashes."""
    scripts = [plotly_script(), own_file("page.js")]
    policy = "; ".join(
        [
            "default-src 'none'",
            f"script-src {' '.join(_source(script) for script in scripts)}",
            "style-src 'unsafe-inline'",
            "img-src data: blob:",
            "base-uri 'none'",
            "form-action 'none'",
        ]
    )
    head = [
        tag("meta", charset="utf-8"),
        tag("meta", http_equiv="Content-Security-Policy", content=policy),
        tag("meta", name="viewport", content="width=device-width, initial-scale=1"),
        tag("meta", name="color-scheme", content="light dark"),
        tag("title", title),
        tag("style", Markup(own_file("page.css"))),
    ]
    parts = [section for section in sections if any(section.content)]
    body = [
        tag("a", "Skip to the content", href="#content", class_="skip"),
        tag("header", header),
        _navigation(parts),
        tag("main", tag("noscript", tag("p", "The figures need JavaScript.")), map(_section, parts), id="content"),
        tag("footer", "Written by crashsim. This file needs no network."),
        [tag("script", Markup(script)) for script in scripts],
    ]
    return f'<!DOCTYPE html>\n<html lang="en">\n{tag("head", *head)}\n{tag("body", *body)}\n</html>\n'


def _source(script: str) -> str:
    digest = hashlib.sha256(script.encode()).digest()
    return f"'sha256-{base64.b64encode(digest).decode()}'"


def _navigation(sections: Sequence[Section]) -> Markup:
    links = [tag("li", tag("a", section.title, href=f"#{section.key}")) for section in sections]
    return tag("nav", tag("ol", links), aria_label="Sections")


def _section(section: Section) -> Markup:
    return tag("section", tag("h2", section.title), section.content, id=section.key)


def figure_element(figure: Figure, most_points: int = MOST_POINTS, legend: bool = True) -> Markup:
    """A figure: title, a legend of buttons that show and hide curves, the picture, a caption."""
    buttons = [_legend_button(index, curve) for index, curve in enumerate(figure.curves)] if legend else []
    specification = inline_json(plotly_figure(figure, most_points))
    return tag(
        "figure",
        tag("h3", figure.title),
        tag("div", buttons, class_="legend", role="group", aria_label=f"Curves of {figure.title}") if buttons else None,
        tag("div", class_="plot", role="group", aria_label=_description(figure)),
        tag("figcaption", figure.caption),
        tag("script", specification, type="application/json"),
        id=f"figure-{figure.key}",
    )


def figure_grid(figures: Sequence[Figure | None]) -> Markup | None:
    """Figures side by side where there is room."""
    elements = [figure_element(figure) for figure in figures if figure is not None]
    return tag("div", elements, class_="figures") if elements else None


def _description(figure: Figure) -> str:
    names = ", ".join(curve.name for curve in figure.curves)
    return f"{figure.title}: {figure.y.title} over {figure.x.title}; curves: {names}"


def _legend_button(index: int, curve: Curve) -> Markup:
    text = tag("span", curve.name)
    return tag("button", _swatch(curve), text, type="button", aria_pressed="true", data_curve=index)


def _swatch(curve: Curve) -> Markup:
    line = tag("path", d="M1 6H27", stroke_width=curve.width, stroke_dasharray=DASH_ARRAYS[curve.dash])
    dot = tag("circle", cx=14, cy=6, r=3.5)
    square = tag("rect", x=10.5, y=2.5, width=7, height=7, class_="open")
    marker = square if curve.symbol == "square-open" else dot
    parts = [line if "lines" in curve.mode else None, marker if "markers" in curve.mode else None]
    area = tag("rect", x=1, y=1, width=26, height=10, rx=2)
    content = area if curve.stacked else parts
    return tag("svg", content, viewBox="0 0 28 12", aria_hidden="true", class_=f"swatch color-{curve.color}")
