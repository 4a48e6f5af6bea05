"""The reference of the command line, from `crashsim --help` and the `--help` of each command."""

import re
import subprocess
from dataclasses import dataclass, field
from pathlib import Path

from _generate.markdown import code, fence, plain, table

ENTRY = re.compile(r"  (\S.*?)(?:\s{2,}(.*))?$")
HEADING = re.compile(r"(\S.*):$")


@dataclass
class Help:
    """What one `--help` says."""

    about: str
    usage: str
    example: str = ""
    remarks: list[str] = field(default_factory=list)
    sections: dict[str, list[tuple[str, str]]] = field(default_factory=dict)
    """Entries of "Options", "Subcommands", ..: what to write, what it means."""


def parse_help(text: str) -> Help:
    """Takes a help text apart."""
    about, usage, *lines = text.splitlines()
    parsed = Help(about, usage.removeprefix("Usage: "))
    section = ""
    for line in lines:
        entry = ENTRY.match(line)
        if heading := HEADING.match(line):
            section = heading[1]
        elif section == "Example" and line:
            parsed.example += line.removeprefix("  ") + "\n"
        elif entry and section:
            parsed.sections.setdefault(section, []).append((entry[1], entry[2] or ""))
        elif line and section:
            parsed.remarks.append(line)
    return parsed


def read_help(program: str, *command: str) -> Help:
    """The help of the program, or of one of its commands."""
    result = subprocess.run([program, *command, "--help"], capture_output=True, text=True, check=True)
    return parse_help(result.stdout)


def command_page(name: str, read: Help) -> str:
    """The page of one command."""
    parts = [f"# crashsim {name}\n", plain(read.about) + ".\n", fence("text", read.usage), *read.remarks]
    parts.append("## Example\n\n" + fence("bash", read.example))
    for section, entries in read.sections.items():
        title, _, remark = section.partition(": ")
        parts.append(f"## {title}\n" + (f"\n{remark[0].upper()}{remark[1:]}.\n" if remark else ""))
        parts.append(table(("write", "meaning"), [(code(what), plain(meaning)) for what, meaning in entries]))
    return "\n".join(parts)


INTRODUCTION = """\
# Command line

`crashsim` is one program with a command for each step. These pages are made from its own `--help`.

- Quantities take a unit: `56km/h`, `35mph`, `1719kg`, `2.58t`, `120ms`. A bare number is SI.
- Results go to the file that `-o` names, `-o -` to standard output. A summary goes to standard error; `--quiet`
  silences it, `--json` prints it as JSON on standard output.
- An output appears whole or not at all. One that exists is replaced with `--force` only.
- `--config FILE.toml` sets any option; the command line wins.

| exit code | meaning |
|---|---|
| 0 | done |
| 2 | you can fix it: usage, file, value |
| 3 | the numbers failed: no maximum crush, no convergence |
| 4 | the machine failed: cannot write, no memory |
| 130 | interrupted |
"""


def write_cli_pages(program: str, folder: Path) -> None:
    """Writes index.md and a page for each command."""
    commands = dict(read_help(program).sections["Subcommands"])
    folder.mkdir(parents=True, exist_ok=True)
    for name in commands:
        (folder / f"{name}.md").write_text(command_page(name, read_help(program, name)), encoding="utf-8")
    rows = [(f"[`{name}`]({name}.md)", plain(about)) for name, about in commands.items()]
    toctree = "```{toctree}\n:hidden:\n\n" + "\n".join(commands) + "\n```\n"
    index = "\n".join([INTRODUCTION, "## Commands\n", table(("command", "what it does"), rows), toctree])
    (folder / "index.md").write_text(index, encoding="utf-8")
