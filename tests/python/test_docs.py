"""The documentation site: complete, and its links lead somewhere. script/docs runs its examples.

What needs the program takes that of build/dev or the one that CRASHSIM names; what needs the built site skips without.
"""

import html.parser
import importlib
import os
import re
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType
from urllib.parse import unquote, urlsplit

import pytest

import support

ROOT = Path(__file__).parents[2]
SITE = ROOT / "docs/site"
BUILT = ROOT / "build/docs/html"
PROGRAM = Path(support.find_program() or "crashsim")
NHTSA = ROOT.parent / "shared/data/nhtsa-10146"

PAGES = sorted(SITE.rglob("*.md"))
FENCE = re.compile(r"^```(\S+)[^\n]*\n(.*?)^```$", re.MULTILINE | re.DOTALL)
HELP = """\
Add things up
Usage: crashsim add [OPTIONS] file

Positionals:
  file FILE REQUIRED          what to read

Options:
  --times s                   output times | all [1e-04]
  --very-long-option-of-this-command TEXT
Motion: instead of the file's:
  --speed m/s                 impact speed

Example:
  crashsim add a.csv
  crashsim add b.csv
"""


@pytest.fixture
def pages_of_site(monkeypatch: pytest.MonkeyPatch) -> Iterator[ModuleType]:
    """The module that makes the pages of the command line."""
    monkeypatch.syspath_prepend(str(SITE))
    yield importlib.import_module("_generate.cli_pages")
    for name in [name for name in sys.modules if name.startswith("_generate")]:
        del sys.modules[name]


def program() -> str:
    """The program, or a skip."""
    if not PROGRAM.exists():
        pytest.skip(f"no program {PROGRAM}")
    return str(PROGRAM)


def test_help_is_taken_apart(pages_of_site: ModuleType) -> None:
    read = pages_of_site.parse_help(HELP)
    assert read.about == "Add things up"
    assert read.usage == "crashsim add [OPTIONS] file"
    assert read.sections == {
        "Positionals": [("file FILE REQUIRED", "what to read")],
        "Options": [("--times s", "output times | all [1e-04]"), ("--very-long-option-of-this-command TEXT", "")],
        "Motion: instead of the file's": [("--speed m/s", "impact speed")],
    }
    assert read.example == "crashsim add a.csv\ncrashsim add b.csv\n"
    page = pages_of_site.command_page("add", read)
    assert "| `--times s` | output times \\| all \\[1e-04\\] |" in page
    assert "## Motion\n\nInstead of the file's.\n" in page


def test_every_subcommand_has_a_page(pages_of_site: ModuleType, tmp_path: Path) -> None:
    help_text = subprocess.run([program(), "--help"], capture_output=True, text=True, check=True).stdout
    commands = set(re.findall(r"^  ([a-z][a-z-]+) {2,}[A-Z]", help_text, re.MULTILINE))
    assert {"info", "pulse", "identify", "run"} <= commands
    pages_of_site.write_cli_pages(program(), tmp_path)
    assert {path.stem for path in tmp_path.glob("*.md")} == commands | {"index"}


def test_every_option_is_on_its_page(pages_of_site: ModuleType, tmp_path: Path) -> None:
    pages_of_site.write_cli_pages(program(), tmp_path)
    for page in tmp_path.glob("*.md"):
        if page.stem == "index":
            continue
        shown = subprocess.run([program(), page.stem, "--help"], capture_output=True, text=True, check=True).stdout
        for option in set(re.findall(r"^  (?:-\w,)?(--[\w-]+)", shown, re.MULTILINE)):
            assert option in page.read_text(encoding="utf-8"), f"{page.stem} {option}"


def test_every_header_is_in_the_cpp_reference() -> None:
    text = "\n".join(path.read_text(encoding="utf-8") for path in (SITE / "reference/cpp").glob("*.md"))
    shown = re.findall(r"^```\{doxygengroup\} (\w+)_hpp$", text, re.MULTILINE)
    headers = {path.stem for path in (ROOT / "include/crashsim").glob("*.hpp")} - {"crashsim"}
    assert sorted(shown) == sorted(headers | {"version"})
    assert "crashsim/crashsim.hpp" in text


def test_pages_name_no_absent_file() -> None:
    names = re.compile(r"(?<![\w./-])(?:data|docs|script|tests|include|src|benchmarks)/[\w./{}*$-]*\w")
    for page in PAGES:
        for name in names.findall(page.read_text(encoding="utf-8")):
            if not set("{}*$") & set(name):
                assert (ROOT / name).exists() or name.startswith("docs/site/"), f"{page.relative_to(ROOT)}: {name}"


def test_every_page_is_reached_from_the_start() -> None:
    index = (SITE / "index.md").read_text(encoding="utf-8")
    for page in PAGES:
        name = page.relative_to(SITE).with_suffix("").as_posix()
        if name != "index" and not (name.startswith("reference/cpp/") and name != "reference/cpp/index"):
            assert f"\n{name}\n" in index, name


def test_gallery_has_every_picture() -> None:
    plots = pytest.importorskip("crashsim.plots")
    gallery = (SITE / "gallery.md").read_text(encoding="utf-8")
    for name in plots.__all__:
        assert f"plots.{name}(" in gallery, name


def test_equations_are_numbered_once_and_in_order() -> None:
    text = (ROOT / "docs/model.md").read_text(encoding="utf-8")
    numbers = [int(number) for number in re.findall(r"\\tag\{(\d+)\}", text)]
    assert numbers == list(range(1, len(numbers) + 1))
    assert len(numbers) == len(re.findall(r"^```math$", text, re.MULTILINE))


def test_nhtsa_commands_of_the_tutorial_work(tmp_path: Path) -> None:
    if not NHTSA.exists():
        pytest.skip(f"no NHTSA test 10146 in {NHTSA}")
    for file in NHTSA.glob("v10146.*"):
        (tmp_path / file.name).symlink_to(file)
    (tmp_path / "crashsim").symlink_to(program())
    text = (SITE / "tutorials/nhtsa.md").read_text(encoding="utf-8")
    scripts = [body for language, body in FENCE.findall(text) if language == "bash" and "v10146" in body]
    assert len(scripts) == 2
    environment = {**os.environ, "PATH": f"{tmp_path}:{os.environ['PATH']}"}
    for script in scripts:
        subprocess.run(["bash", "-euc", script], cwd=tmp_path, env=environment, check=True, capture_output=True)
    assert (tmp_path / "rating.json").exists()


def test_nhtsa_python_of_the_tutorial_works(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    crashsim = pytest.importorskip("crashsim")
    if not NHTSA.exists():
        pytest.skip(f"no NHTSA test 10146 in {NHTSA}")
    for file in NHTSA.glob("v10146.*"):
        (tmp_path / file.name).symlink_to(file)
    monkeypatch.chdir(tmp_path)
    text = (SITE / "tutorials/nhtsa.md").read_text(encoding="utf-8")
    (cell,) = [body for language, body in FENCE.findall(text) if language == "python"]
    scope = {"crashsim": crashsim}
    exec(cell, scope)
    assert scope["pulse"].channels[0].startswith("93 ")
    assert crashsim.identify(scope["pulse"], starts=2).model.mass_kg == scope["pulse"].mass_kg


class LinkCollector(html.parser.HTMLParser):
    """Links and anchors of a page."""

    def __init__(self) -> None:
        super().__init__()
        self.links: list[str] = []
        self.anchors: set[str] = set()

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        """Collects."""
        for name, value in attrs:
            if name == "id" and value:
                self.anchors.add(value)
            elif name in ("href", "src") and value and tag in ("a", "img"):
                self.links.append(value)


def collected(page: Path) -> LinkCollector:
    """Links and anchors of a built page."""
    collector = LinkCollector()
    collector.feed(page.read_text(encoding="utf-8"))
    return collector


def test_links_of_the_built_site_lead_somewhere() -> None:
    if not (BUILT / "index.html").exists():
        pytest.skip("the site is not built: script/docs")
    pages = {page: collected(page) for page in BUILT.rglob("*.html") if "_static" not in page.parts}
    for page, found in pages.items():
        for link in found.links:
            parts = urlsplit(link)
            if parts.scheme or (not parts.path and not parts.fragment):
                continue
            target = (page.parent / unquote(parts.path)).resolve() if parts.path else page
            assert target.exists(), f"{page.relative_to(BUILT)}: {link}"
            if parts.fragment and target in pages:
                assert unquote(parts.fragment) in pages[target].anchors, f"{page.relative_to(BUILT)}: {link}"


def test_built_site_needs_no_network() -> None:
    if not (BUILT / "index.html").exists():
        pytest.skip("the site is not built: script/docs")
    for page in BUILT.rglob("*.html"):
        loaded = re.findall(r"<(?:script|link|img)[^>]*(?:src|href)=\"(https?:)?//", page.read_text(encoding="utf-8"))
        assert not loaded, page.relative_to(BUILT)
