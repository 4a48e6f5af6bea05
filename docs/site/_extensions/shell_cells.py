"""Cells that begin with %%bash are shown as what one types into a terminal."""

from typing import Any

from docutils import nodes
from sphinx.application import Sphinx
from sphinx.transforms import SphinxTransform

MAGIC = "%%bash\n"


class ShellCells(SphinxTransform):
    """Leaves out the magic and colours the rest as bash."""

    default_priority = 400

    def apply(self, **kwargs: Any) -> None:
        """Changes the blocks of one document."""
        for block in self.document.findall(nodes.literal_block):
            if block.astext().startswith(MAGIC):
                text = block.astext().removeprefix(MAGIC)
                block.children = [nodes.Text(text)]
                block.rawsource = text
                block["language"] = "bash"


def setup(app: Sphinx) -> dict[str, bool]:
    """Registers the transform."""
    app.add_transform(ShellCells)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
