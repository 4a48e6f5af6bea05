"""HTML as values: text is escaped unless it is markup already."""

from __future__ import annotations

import html
import json
from collections.abc import Iterable
from typing import Any, TypeAlias

VOID = frozenset({"br", "hr", "img", "input", "link", "meta"})


class Markup(str):
    """Text that is HTML already."""

    __slots__ = ()


Content: TypeAlias = "str | Iterable[Content] | None"
Attribute: TypeAlias = "str | float | bool | None"


def escape(text: str) -> Markup:
    """`text` as it stands, shown literally. Markup is returned unchanged."""
    return text if isinstance(text, Markup) else Markup(html.escape(_printable(text)))


def _printable(text: str) -> str:
    """Without the characters that HTML has no place for: controls and halves of surrogate pairs."""
    return "".join(c if c in "\t\n" or (c >= " " and not "\ud800" <= c <= "\udfff") else "\ufffd" for c in text)


def join(content: Content) -> Markup:
    """One piece of HTML from pieces, nested in any way."""
    if content is None:
        return Markup("")
    if isinstance(content, str):
        return escape(content)
    return Markup("".join(join(part) for part in content))


def tag(name: str, /, *content: Content, **attributes: Attribute) -> Markup:
    """Element `name`. Attributes: `class_` is class, `aria_label` aria-label; True stands alone, None is left out."""
    written = "".join(_attribute(key.rstrip("_").replace("_", "-"), value) for key, value in attributes.items())
    if name in VOID:
        return Markup(f"<{name}{written}>")
    return Markup(f"<{name}{written}>{join(content)}</{name}>")


def _attribute(key: str, value: Attribute) -> str:
    if value is None or value is False:
        return ""
    if value is True:
        return f" {key}"
    return f' {key}="{escape(str(value))}"'


def inline_json(value: Any) -> Markup:
    """JSON that may stand inside a script element: nothing in it can end the element or open another."""
    text = json.dumps(value, ensure_ascii=True, allow_nan=False, separators=(",", ":"))
    return Markup(text.replace("&", "\\u0026").replace("<", "\\u003c").replace(">", "\\u003e"))


def plotly_text(text: str) -> str:
    """Text for a label of Plotly, which takes tags, entities and %{..} of its own: shown literally."""
    return html.escape(_printable(text), quote=False).replace("{", "&#123;")
