"""Equations as MathML, which browsers show by themselves: no script, no network. `\\tag{1}` numbers an equation."""

import re
from html import escape

from docutils import nodes
from latex2mathml.converter import convert
from sphinx.application import Sphinx
from sphinx.writers.html5 import HTML5Translator

BAR = '<mo stretchy="false">&#x0007C;</mo>'
TIGHT_BAR = '<mo stretchy="false" lspace="0" rspace="0">&#x0007C;</mo>'
TAG = re.compile(r"\s*\\tag\{(.*?)\}")


def mathml(latex: str, display: str) -> str:
    """MathML of an equation; bars stand close to what they enclose."""
    text: str = convert(latex, display=display)
    return text.replace(BAR, TIGHT_BAR)


def visit_inline(writer: HTML5Translator, node: nodes.math) -> None:
    """An equation in a line of text."""
    writer.body.append(mathml(node.astext(), "inline"))
    raise nodes.SkipNode


def visit_block(writer: HTML5Translator, node: nodes.math_block) -> None:
    """An equation of its own, its number at the right."""
    latex = node.astext()
    tag = TAG.search(latex)
    anchor = f' id="equation-{escape(tag[1])}"' if tag else ""
    number = f'<a class="equation-number" href="#equation-{escape(tag[1])}">({escape(tag[1])})</a>' if tag else ""
    body = mathml(TAG.sub("", latex), "block")
    writer.body.append(f'<div class="equation"{anchor}><div class="equation-body">{body}</div>{number}</div>\n')
    raise nodes.SkipNode


def setup(app: Sphinx) -> dict[str, bool]:
    """Registers the renderer."""
    app.add_html_math_renderer("mathml", (visit_inline, None), (visit_block, None))
    return {"parallel_read_safe": True, "parallel_write_safe": True}
