"""Small pieces of MyST Markdown."""

from collections.abc import Iterable, Sequence


def code(text: str) -> str:
    """Text as code in a table's cell; nothing stays nothing."""
    return "`" + text.replace("|", r"\|") + "`" if text else ""


def plain(text: str) -> str:
    """Text that Markdown leaves as it is."""
    for character in r"\|*_<>[]":
        text = text.replace(character, "\\" + character)
    return text


def fence(language: str, text: str) -> str:
    """A block of code."""
    return f"```{language}\n{text.rstrip()}\n```\n"


def table(header: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """A table; without rows nothing."""
    lines = ["| " + " | ".join(cells) + " |" for cells in rows]
    if not lines:
        return ""
    return "\n".join(["| " + " | ".join(header) + " |", "|---" * len(header) + "|", *lines]) + "\n"
