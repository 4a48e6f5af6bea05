"""The HTML report: its content, its errors, and that nothing in a file becomes markup."""

from __future__ import annotations

import html.parser
import json
import math
import os
import re
import shutil
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from conftest import CaseRunner
from crashsim import __main__ as command_line
from crashsim._report import page, report
from crashsim._report.case import read_case_directory
from crashsim._report.comparison import Entry, comparison_page
from crashsim._report.figures import kept_points
from crashsim._report.markup import Markup, inline_json, plotly_text, tag
from crashsim._report.quantities import OUTCOMES, WORDS, outcome_words, shown, shown_number, words
from report_cases import FE_CAR, PAPER, TWO_SPEEDS, make_batch, model_only, rewrite_json, without_max_crush

pytest.importorskip("plotly", reason="reports need Plotly")

EVIL = "</script><script>alert(1)</script><img src=x onerror=alert(2)>\"'&%{x}"


class Page(html.parser.HTMLParser):
    """What a browser would find in the document."""

    def __init__(self, text: str) -> None:
        super().__init__(convert_charrefs=True)
        self.tags: list[tuple[str, dict[str, str | None]]] = []
        self.figures: dict[str, dict[str, Any]] = {}
        self.text = ""
        self._open: list[str] = []
        self._figure = ""
        self.feed(text)
        self.close()
        assert self._open == [], "elements left open"

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append((tag, dict(attrs)))
        if tag not in ("meta", "input", "br"):
            self._open.append(tag)
        if tag == "figure":
            self._figure = dict(attrs).get("id") or ""

    def handle_endtag(self, tag: str) -> None:
        assert self._open.pop() == tag

    def handle_data(self, data: str) -> None:
        if self._open and self._open[-1] == "script":
            if self.tags[-1][1].get("type") == "application/json":
                self.figures[self._figure.removeprefix("figure-")] = json.loads(data)
        elif not self._open or self._open[-1] != "style":
            self.text += data + "\n"

    def names(self, figure: str) -> list[str]:
        """Names of the curves of a figure."""
        return [trace["name"] for trace in self.figures[figure]["data"]]


@pytest.fixture(autouse=True)
def small_plotly(monkeypatch: pytest.MonkeyPatch) -> None:
    """Plotly's megabytes are tested in a browser."""
    monkeypatch.setattr(page, "plotly_script", lambda: "/* Plotly */")


@pytest.fixture
def copy(case_directory: CaseRunner, tmp_path: Path) -> Path:
    """A case directory to spoil."""
    return shutil.copytree(case_directory(FE_CAR), tmp_path / "case")


def read(path: Path) -> Page:
    return Page(path.read_text(encoding="utf-8"))


# Content


def test_writes_report_html_inside_the_directory(copy: Path) -> None:
    assert report(copy) == copy / "report.html"
    assert sorted(copy.glob("report*")) == [copy / "report.html"]


def test_takes_text_and_another_output(copy: Path, tmp_path: Path) -> None:
    assert report(str(copy), str(tmp_path / "a.html")) == tmp_path / "a.html"
    assert not (copy / "report.html").exists()


def test_replaces_a_report_and_keeps_a_link(copy: Path, tmp_path: Path) -> None:
    (tmp_path / "real.html").write_text("old")
    (tmp_path / "link.html").symlink_to(tmp_path / "real.html")
    report(copy, tmp_path / "link.html")
    assert (tmp_path / "link.html").is_symlink()
    assert (tmp_path / "real.html").read_text().startswith("<!DOCTYPE html>")


def test_same_files_give_the_same_bytes(copy: Path, tmp_path: Path) -> None:
    assert report(copy).read_bytes() == report(copy, tmp_path / "again.html").read_bytes()


def test_figures_of_a_case(copy: Path) -> None:
    found = read(report(copy))
    assert list(found.figures) == [
        *("accel_mps2", "velocity_mps", "displacement_m", "force-crush"),
        *("energy", "spring", "damper", "starts"),
        *("predicted-accel_mps2", "predicted-displacement_m", "predicted-force"),
    ]
    assert found.names("accel_mps2") == ["test", "model"]
    assert found.names("force-crush") == ["test, mass \u00d7 deceleration", "model", "spring", "damper"]
    assert found.names("predicted-force") == ["56.3 km/h, the case", "48 km/h"]
    assert found.names("spring") == ["spring", "at its bound"]


def test_figures_show_units_and_the_peak_of_the_file(copy: Path) -> None:
    figure = read(report(copy)).figures["accel_mps2"]
    case = read_case_directory(copy)
    assert figure["layout"]["yaxis"]["title"]["text"] == "acceleration [g]"
    assert figure["layout"]["xaxis"]["title"]["text"] == "time [ms]"
    assert case.pulse is not None
    peak_g = case.pulse["accel_mps2"].min() / 9.80665
    assert min(figure["data"][0]["y"]) == pytest.approx(peak_g, rel=1e-5)
    assert max(figure["data"][1]["x"]) == pytest.approx(199.9, abs=0.1)


def test_ledger_adds_up_to_the_kinetic_energy(copy: Path) -> None:
    data = read(report(copy)).figures["energy"]["data"]
    total_kj = np.sum([trace["y"] for trace in data], axis=0)
    assert total_kj == pytest.approx(0.5 * 1190.017 * 15.64**2 / 1e3, rel=1e-3)


def test_heave_and_pitch(case_directory: CaseRunner, tmp_path: Path) -> None:
    found = read(report(case_directory(PAPER), tmp_path / "r.html"))
    both = ["crush first, then heave and pitch", "crush, heave and pitch coupled"]
    for figure in ("pitch_rad", "heave_m", "heave_velocity_mps", "pitch_rate_radps"):
        assert found.names(figure) == both
    assert max(found.figures["pitch_rad"]["data"][1]["y"]) == pytest.approx(2.63, abs=0.01)
    assert "time the front wheels leave the ground" in found.text
    assert "Heave and pitch, coupled" in found.text


def test_joint_fit(case_directory: CaseRunner, tmp_path: Path) -> None:
    found = read(report(case_directory(TWO_SPEEDS), tmp_path / "r.html"))
    assert found.names("predicted-force") == ["56.3 km/h, the case", "40 km/h", "48 km/h"]
    assert "the ordinates are not well determined from 2 tests" in found.text


def test_words_of_the_verdict_ratings_and_record(copy: Path) -> None:
    text = read(report(copy)).text
    for expected in (
        "finite-element car, 56 km/h into a rigid wall",
        "Every step of the case completed.",
        "The data do not determine every number: ",
        "spring and damper are not separable from one speed",
        "99 of 100 starts of the identification ended within 0.1 % of the best.",
        "k6: ended at a bound.",
        "maximum crush 0.823 m is outside 0.442 to 0.796 m",
        "occupant load criterion (OLC)",
        "836.3 kN/m",
        "\u22124.73 %",
        "excellent",
        "0.912",
        "3.863 g",
        "crashsim run ",
        "67afa481596df03bef8335f2fb3796464a2f2b3ce78bb61a940e863932ff752b",
        "identify.starts",
        "filter: CFC60 (j211), forward and backward",
    ):
        assert expected in text, expected


def test_every_quantity_of_a_summary_has_words(case_directory: CaseRunner) -> None:
    summary = json.loads((case_directory(PAPER) / "summary.json").read_text())
    parts = [summary, *(value for value in summary.values() if isinstance(value, dict))]
    names = {name for part in parts for name, value in part.items() if not isinstance(value, dict | str)}
    assert names - set(WORDS) == set()


def test_a_failed_case_says_so(case_directory: CaseRunner, tmp_path: Path) -> None:
    found = read(report(case_directory(without_max_crush(tmp_path)), tmp_path / "r.html"))
    assert "The case has no result to rely on: " in found.text
    assert OUTCOMES["no_max_crush"] in found.text


# Parts of a directory


def test_a_model_without_a_test(case_directory: CaseRunner, tmp_path: Path) -> None:
    found = read(report(case_directory(model_only(tmp_path)), tmp_path / "r.html"))
    assert found.names("accel_mps2") == ["model"]
    assert found.names("force-crush") == ["model", "spring", "damper"]
    assert "starts" not in found.figures
    assert "No test stands beside the model" in found.text
    assert "The model was given, not identified." in found.text


@pytest.mark.parametrize(
    ("kept", "figures"),
    [
        (["pulse.csv"], ["accel_mps2", "velocity_mps", "displacement_m", "force-crush"]),
        (["response.csv"], ["accel_mps2", "velocity_mps", "displacement_m", "force-crush", "energy"]),
        (["model.json"], ["spring", "damper", "starts"]),
        (["summary.json"], []),
        (["comparison.json"], []),
        (["case.lock.json"], []),
    ],
)
def test_a_directory_with_one_file(copy: Path, kept: Sequence[str], figures: Sequence[str]) -> None:
    for path in copy.iterdir():
        if path.name not in kept:
            path.unlink()
    assert list(read(report(copy)).figures) == list(figures)


def axes_of(figure: dict[str, Any]) -> tuple[str, str]:
    return (figure["layout"]["xaxis"]["title"]["text"], figure["layout"]["yaxis"]["title"]["text"])


def test_axes_of_spring_and_damper_follow_the_law(copy: Path) -> None:
    model = json.loads((copy / "model.json").read_text())
    del model["identification"]
    model["spring"] = {"knots_m": [0, 0.5], "ordinates_n": [1e5, 2e5]}
    model |= {"law": "crush_damping", "damper": {"knots_m": [0, 0.4], "ordinates_ns_per_m": [2e3, 1e3]}}
    (copy / "model.json").write_text(json.dumps(model))
    figures = read(report(copy)).figures
    assert axes_of(figures["spring"]) == ("crush [mm]", "force f [kN]")
    assert axes_of(figures["damper"]) == ("crush [mm]", "damping c [kN s/m]")
    assert figures["damper"]["data"][0]["x"] == [0, 400]

    del model["damper"]
    model |= {"law": "rate", "rate": {"coefficient": 0.1, "reference_speed_mps": 2.0}}
    (copy / "model.json").write_text(json.dumps(model))
    figures = read(report(copy)).figures
    assert "damper" not in figures
    assert figures["rate"]["data"][0]["y"][-1] == pytest.approx(1 + 0.1 * math.log(11), rel=1e-6)
    model["rate"]["reference_speed_mps"] = None
    (copy / "model.json").write_text(json.dumps(model))
    with pytest.raises(ValueError, match=r"model\.json: has law rate, must have rate\.coefficient and"):
        report(copy)


def test_title_without_a_record_is_the_name_of_the_directory(copy: Path) -> None:
    (copy / "case.lock.json").unlink()
    (copy / "comparison.json").unlink()
    assert "<h1>case</h1>" in report(copy).read_text()


# Errors


def test_missing_directory(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match=r"nowhere: is no directory: name one that `crashsim run"):
        report(tmp_path / "nowhere")


def test_directory_without_a_case(tmp_path: Path) -> None:
    (tmp_path / "empty").mkdir()
    (tmp_path / "notes.txt").write_text("x")
    with pytest.raises(ValueError, match="holds neither a case nor directories of cases: write one with"):
        report(tmp_path)


@pytest.mark.parametrize(
    ("file", "text", "expected"),
    [
        ("summary.json", '{\n"a": ', r"summary\.json:2: is not JSON"),
        ("summary.json", "[1]", r"summary\.json: is not a JSON object"),
        ("summary.json", "[" * 100_000, r"summary\.json(:1)?: is n"),
        ("summary.json", '{"mass_kg": "much"}', r"summary\.json: mass_kg is a text, must be a number"),
        ("summary.json", '{"pulse": 3}', r"summary\.json: pulse is a number, must be an object"),
        ("summary.json", '{"outcome": []}', r"summary\.json: outcome is a list, must be a text"),
        ("comparison.json", '{"x": {"channels": {}}}', r"comparison\.json: x\.channels is an object, must be a list"),
        ("comparison.json", '{"x": {"channels": [1]}}', r"x\.channels\[0\] is a number, must be an object"),
        ("case.lock.json", '{"arguments": [1]}', r"arguments\[0\] is a number, must be a text"),
        ("model.json", "{}", r"model\.json: has no spring"),
        ("model.json", '{"spring": {"knots_m": [0], "ordinates_n": []}}', r"spring has 1 knots and 0 ordinates"),
        ("model.json", '{"spring": {"knots_m": ["a"]}}', r"spring\.knots_m\[0\] is a text, must be a number"),
        ("pulse.csv", "# nothing\n", r"pulse\.csv: has no line of numbers"),
        ("pulse.csv", "a,b\n1,2\n", r"pulse\.csv: has no column time_s \(it has a, b\)"),
        ("pulse.csv", "time_s,accel_mps2\n0,1\n0.1\n", r"pulse\.csv:3: has 1 cells, the line of names has 2"),
        ("pulse.csv", "time_s,accel_mps2\n0,1\n0.1,x\n", r"pulse\.csv:3: 'x' is no number"),
        ("pulse.csv", "time_s,accel_mps2\n0,1\n0,1\n", r"pulse\.csv: time_s does not increase"),
        ("pulse.csv", "time_s,accel_mps2\n0,1\n", r"pulse\.csv: has 1 sample, need at least 2"),
        ("response.csv", "time_s,accel_mps2\n0,1\n1,1\n", r"response\.csv: has no column velocity_mps"),
    ],
)
def test_malformed_file(copy: Path, file: str, text: str, expected: str) -> None:
    (copy / file).write_text(text)
    with pytest.raises(ValueError, match=expected) as error:
        report(copy)
    assert "write the directory anew with `crashsim run CASE -o DIR`" in str(error.value)
    assert not (copy / "report.html").exists()


def test_file_that_is_no_text(copy: Path) -> None:
    (copy / "pulse.csv").write_bytes(b"\xff\xfe\x00")
    with pytest.raises(ValueError, match=r"pulse\.csv: is not text in UTF-8"):
        report(copy)


@pytest.mark.parametrize("cell", ["", "nan", "inf", "-1e999"])
def test_numbers_that_are_none(copy: Path, cell: str) -> None:
    lines = (copy / "response.csv").read_text().splitlines()
    lines[-1] = re.sub(r",[^,]*", f",{cell}", lines[-1], count=1)
    (copy / "response.csv").write_text("\n".join(lines))
    assert read(report(copy)).figures["accel_mps2"]["data"][1]["y"][-1] is None


def test_numbers_that_are_too_large(copy: Path) -> None:
    rewrite_json(copy / "summary.json", t_m_s=10**400, olc_g=1e308)
    model = json.loads((copy / "model.json").read_text())
    model["damper"]["ordinates_ns_per_m"][0] = 10**400
    (copy / "model.json").write_text(json.dumps(model))
    assert read(report(copy)).figures["damper"]["data"][0]["y"][0] is None


@pytest.mark.parametrize(
    ("output", "expected"),
    [
        ("summary.json", "is a file of the case: choose another name"),
        ("prediction_48kmh.csv", "is a file of the case"),
        (".", "is a directory: name the file to write"),
        ("no/where.html", "its directory does not exist: make"),
    ],
)
def test_output_that_is_no_place_for_a_report(copy: Path, output: str, expected: str) -> None:
    before = {path: path.read_bytes() for path in copy.iterdir()}
    with pytest.raises(ValueError, match=expected):
        report(copy, copy / output)
    assert {path: path.read_bytes() for path in copy.iterdir()} == before


def test_a_write_that_fails_leaves_the_old_report(copy: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    report(copy)
    before = {path.name: path.read_bytes() for path in copy.iterdir()}

    def no_space(self: Path, *_: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(Path, "replace", no_space)
    with pytest.raises(OSError, match="No space"):
        report(copy)
    assert {path.name: path.read_bytes() for path in copy.iterdir()} == before


def test_without_plotly(copy: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.undo()
    monkeypatch.setitem(sys.modules, "plotly.offline", None)
    with pytest.raises(ImportError, match=r"pip install 'crashsim\[report\]'"):
        report(copy)


# Nothing in a file becomes markup


def spoil(case: Path) -> None:
    """Puts markup wherever a file holds text."""
    record = json.loads((case / "case.lock.json").read_text())
    record |= {"version": EVIL, "command": EVIL, "arguments": [EVIL], "inputs": [{"path": EVIL, "sha256": EVIL}]}
    record["options"]["title"] = EVIL
    record["options"][EVIL] = {EVIL: [EVIL]}
    (case / "case.lock.json").write_text(json.dumps(record))
    rewrite_json(case / "summary.json", outcome=EVIL, **{EVIL: 1.0})
    identification = {"verdict": EVIL, "starts": 3, "starts_at_best": 1, EVIL: EVIL}
    rewrite_json(case / "summary.json", identification=identification)
    comparison = json.loads((case / "comparison.json").read_text())
    for name in ("to_max_crush", "whole_record"):
        comparison[name]["notes"] = [EVIL]
        for channel in comparison[name]["channels"]:
            channel["name"] += EVIL
            channel["iso18571"] |= {"grade": EVIL, "not_rated": EVIL}
    (case / "comparison.json").write_text(json.dumps(comparison | {EVIL: comparison["to_max_crush"]}))
    comments = "".join(f"# {key} = {EVIL}\n" for key in ("channel", "step", "warning"))
    (case / "pulse.csv").write_text(comments + (case / "pulse.csv").read_text())
    shutil.copy(case / "prediction_48kmh.csv", case / f"prediction_{EVIL.replace('/', '')}.csv")


def test_markup_in_files_is_shown_as_text(copy: Path) -> None:
    clean = read(report(copy, copy / "clean.html"))
    (copy / "clean.html").unlink()
    spoil(copy)
    found = read(report(copy))
    assert {tag for tag, _ in found.tags} == {tag for tag, _ in clean.tags}
    scripts = [attributes for tag, attributes in found.tags if tag == "script"]
    assert sum(not attributes for attributes in scripts) == 2
    handlers = [key for _, attributes in found.tags for key in attributes if key.startswith("on")]
    assert handlers == []
    assert found.text.count(EVIL) > 20


def test_labels_of_plotly_hold_no_markup(copy: Path) -> None:
    spoil(copy)
    found = read(report(copy))
    labels = [name for figure in found.figures for name in found.names(figure)]
    evil = [label for label in labels if "alert" in label]
    assert evil
    assert all("<" not in label and "{" not in label for label in evil)


def test_policy_admits_only_the_two_scripts_of_the_page(copy: Path) -> None:
    found = read(report(copy))
    policy = next(a["content"] or "" for _, a in found.tags if a.get("http-equiv") == "Content-Security-Policy")
    assert policy.count("'sha256-") == 2
    assert "default-src 'none'" in policy
    assert "script-src 'unsafe-inline'" not in policy


def test_no_address_outside_the_page(copy: Path) -> None:
    found = read(report(copy))
    targets = [a.get("href") or a.get("src") or "#" for _, a in found.tags]
    assert all(target.startswith("#") for target in targets)


@pytest.mark.parametrize("text", [EVIL, "<!--", "]]>", "\ud800", "a\x00b\x1b", "\u2028"])
def test_inline_json_cannot_leave_its_script(text: str) -> None:
    written = inline_json({text: text})
    assert not set("<>&") & set(written)
    assert written.isascii()
    assert json.loads(written) == {text: text}


def test_escaping() -> None:
    assert tag("p", '<&>"', title='"') == '<p title="&quot;">&lt;&amp;&gt;&quot;</p>'
    assert tag("p", Markup("<b>"), None, ["x", ["y"]], hidden=True, id=None) == "<p hidden><b>xy</p>"
    assert tag("p", "a\x00\ud800") == "<p>a\ufffd\ufffd</p>"
    assert plotly_text("<b>%{x}&") == "&lt;b&gt;%&#123;x}&amp;"


# Comparison


def test_comparison(case_directory: CaseRunner, tmp_path: Path) -> None:
    folder = make_batch(tmp_path, case_directory)
    report(folder / "case-2")
    found = read(report(folder))
    assert "5 cases: 2 completed, 2 failed, 1 without a result" in found.text
    rows = [attributes for tag, attributes in found.tags if tag == "tr" and "data-case" in attributes]
    assert [row["class"] for row in rows] == ["absent", "completed", "completed", "failed", "failed"]
    names = [a["data-value"] for tag, a in found.tags if tag == "th" and "data-value" in a]
    assert names == ["absent", "case-2", "case-10", "failed", "malformed"]
    assert "summary.json:1: is not JSON" in found.text
    assert OUTCOMES["no_max_crush"] in found.text
    assert found.names("all-forces") == ["case-2", "case-10", "failed"]
    links = {a["href"] for tag, a in found.tags if tag == "a" and "#" not in (a["href"] or "")}
    assert links == {"./case-2/report.html"}


def test_links_are_relative_to_the_output_and_quoted(case_directory: CaseRunner, tmp_path: Path) -> None:
    name = "javascript:a b#c"
    (tmp_path / "out").mkdir()
    shutil.copytree(case_directory(FE_CAR), tmp_path / "batch" / name)
    report(tmp_path / "batch" / name)
    found = read(report(tmp_path / "batch", tmp_path / "out/all.html"))
    assert "./../batch/javascript%3Aa%20b%23c/report.html" in {a.get("href") for _, a in found.tags}


def test_comparison_of_hundreds_of_cases_stays_small(case_directory: CaseRunner, tmp_path: Path) -> None:
    case = read_case_directory(case_directory(FE_CAR))
    entries = [Entry(Path(f"case-{i}"), case) for i in range(400)]
    text = comparison_page(tmp_path, entries, tmp_path / "report.html")
    assert len(text) < 4_000_000
    assert len(Page(text).names("all-forces")) == 400


def test_other_directories_are_no_cases(case_directory: CaseRunner, tmp_path: Path) -> None:
    folder = make_batch(tmp_path / "batch", case_directory)
    (folder / "pictures").mkdir()
    (folder / "pictures/a.png").write_bytes(b"")
    (folder / ".hidden").mkdir()
    text = report(folder).read_text()
    assert "pictures" not in text
    assert ".hidden" not in text


# Numbers


@pytest.mark.parametrize(
    ("value", "expected"),
    [
        (None, "\u2013"),
        (math.nan, "\u2013"),
        (0.0, "0"),
        (-0.0, "0"),
        (9.9999, "10.00"),
        (823.2384, "823.2"),
        (-0.684, "\u22120.6840"),
        (34742.0, "34742"),
        (7.178e-5, "7.178e\u221205"),
        (1.5e9, "1.500e+09"),
        (0.9999999, "1.000"),
    ],
)
def test_shown_number(value: float | None, expected: str) -> None:
    assert shown_number(value) == expected


def test_shown_with_unit_and_words() -> None:
    assert shown("t_m_s", 0.0913) == "91.30 ms"
    assert shown("kw400_n_per_m", 836e3) == "836.0 kN/m"
    assert shown("heave_velocity_min_mps", -1.0) == "\u22121.000 m/s"
    assert shown("restitution", 0.04) == "0.04000"
    assert words("new_thing") == "new thing"
    assert outcome_words("new_thing") == "new thing"


def test_thinning_keeps_the_peaks() -> None:
    y = np.zeros(100_000)
    y[33_333], y[66_666] = 5.0, -7.0
    kept = kept_points(y, 500)
    assert len(kept) <= 502
    assert {0, 33_333, 66_666, 99_999} <= set(kept.tolist())
    assert kept_points(np.full(1000, np.nan), 10).size <= 12


# Command line


def test_command_line(copy: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert command_line.main(["report", str(copy)]) == 0
    assert capsys.readouterr().out == f"{copy / 'report.html'}\n"
    assert command_line.main(["report", str(copy), "-o", str(copy / "b.html")]) == 0
    assert (copy / "b.html").is_file()


def test_exit_codes(copy: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> None:
    assert command_line.main(["report", str(copy / "none")]) == 2
    assert capsys.readouterr().err.startswith(f"error: {copy / 'none'}: is no directory")
    for arguments in ([], ["report"], ["repport", "x"]):
        with pytest.raises(SystemExit) as stop:
            command_line.main(arguments)
        assert stop.value.code == 2

    def fail(error: BaseException) -> Any:
        def raising(*_: object) -> None:
            raise error

        return raising

    for error, code in ((OSError("disk"), 4), (ImportError("plotly"), 2), (KeyboardInterrupt(), 130)):
        monkeypatch.setattr(command_line, "report", fail(error))
        assert command_line.main(["report", str(copy)]) == code


def test_as_a_module(copy: Path) -> None:
    command = [sys.executable, "-m", "crashsim", "report", str(copy)]
    done = subprocess.run(command, capture_output=True, text=True, check=False, env=dict(os.environ))
    assert (done.returncode, done.stderr) == (0, "")
    assert (copy / "report.html").stat().st_size > 1_000_000
