"""The HTML report in a real browser, without network."""

from __future__ import annotations

import json
import re
import shutil
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from conftest import CaseRunner
from crashsim._report import report
from report_cases import PAPER, TWO_SPEEDS, make_batch, rewrite_json

selenium = pytest.importorskip("selenium", reason="tests in a browser need selenium")
pytest.importorskip("plotly", reason="reports need Plotly")

from selenium import webdriver  # noqa: E402
from selenium.webdriver.chrome.service import Service  # noqa: E402
from selenium.webdriver.common.by import By  # noqa: E402
from selenium.webdriver.common.keys import Keys  # noqa: E402
from selenium.webdriver.support.ui import WebDriverWait  # noqa: E402

DRIVER = shutil.which("chromedriver")
CHROMIUM = shutil.which("chromium") or shutil.which("google-chrome")
PATIENCE_S = 60
LEGIBLE_CONTRAST = 4.5  # WCAG 2.1, level AA, text
VISIBLE_CONTRAST = 3.0  # WCAG 2.1, level AA, graphics
NARROW_PX = 375

pytestmark = pytest.mark.skipif(DRIVER is None or CHROMIUM is None, reason="needs chromium and chromedriver")


@pytest.fixture(scope="module")
def chromium() -> Iterator[webdriver.Chrome]:
    """A browser that reaches nothing."""
    options = webdriver.ChromeOptions()
    options.binary_location = CHROMIUM or ""
    for argument in (
        *("--headless=new", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage", "--disable-extensions"),
        *("--host-resolver-rules=MAP * ~NOTFOUND", "--window-size=1280,900", "--blink-settings=primaryHoverType=2"),
    ):
        options.add_argument(argument)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
    driver = webdriver.Chrome(options=options, service=Service(DRIVER))
    yield driver
    driver.quit()


@pytest.fixture(scope="module")
def case_report(case_directory: CaseRunner, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Report of the case with everything in it."""
    return report(case_directory(PAPER), tmp_path_factory.mktemp("report") / "case.html")


@pytest.fixture(scope="module")
def batch_report(case_directory: CaseRunner, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Comparison of five cases."""
    return report(make_batch(tmp_path_factory.mktemp("batch"), case_directory))


def log(chromium: Any, kind: str) -> list[dict[str, Any]]:
    """What the browser wrote since the last time."""
    entries: list[dict[str, Any]] = chromium.get_log(kind)
    return entries


def emulate(chromium: webdriver.Chrome, width_px: int = 1280, scheme: str = "light") -> None:
    wishes = {"prefers-color-scheme": scheme, "prefers-reduced-motion": "reduce"}
    features = [{"name": name, "value": value} for name, value in wishes.items()]
    chromium.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": features})
    size = {"width": width_px, "height": 900, "deviceScaleFactor": 1, "mobile": width_px < 500}
    chromium.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", size)


def open_page(chromium: webdriver.Chrome, path: Path, width_px: int = 1280, scheme: str = "light") -> None:
    """Opens a page; every figure is drawn afterwards."""
    emulate(chromium, width_px, scheme)
    for kind in ("browser", "performance"):
        log(chromium, kind)
    chromium.get(path.as_uri())
    script = "return document.documentElement.dataset.drawn === 'true'"
    WebDriverWait(chromium, PATIENCE_S).until(lambda driver: driver.execute_script(script))


def requests(chromium: webdriver.Chrome) -> list[str]:
    """Addresses asked for since the page was opened."""
    messages = [json.loads(entry["message"])["message"] for entry in log(chromium, "performance")]
    sent = [message["params"] for message in messages if message["method"] == "Network.requestWillBeSent"]
    return [str(parameters["request"]["url"]) for parameters in sent]


def curves(chromium: webdriver.Chrome) -> dict[str, list[str]]:
    """Names of the curves that are drawn in each figure."""
    script = """
        return Object.fromEntries([...document.querySelectorAll("main figure[id]")].map((figure) => {
          const plot = figure.querySelector(".plot");
          const drawn = [...figure.querySelectorAll("g.trace")].filter((trace) => trace.querySelector("path"));
          return [figure.id, drawn.map((trace) => trace.__data__[0].trace.name)];
        }))"""
    found: dict[str, list[str]] = chromium.execute_script(script)
    return found


def rgb(color: str) -> tuple[float, float, float]:
    red, green, blue = (float(part) for part in re.findall(r"[\d.]+", color)[:3])
    return red, green, blue


def luminance(color: str) -> float:
    parts = [c / 255 for c in rgb(color)]
    linear = [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in parts]
    return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]


def contrast(one: str, other: str) -> float:
    low, high = sorted((luminance(one), luminance(other)))
    return (high + 0.05) / (low + 0.05)


def test_opens_without_a_complaint_and_without_network(chromium: webdriver.Chrome, case_report: Path) -> None:
    open_page(chromium, case_report)
    assert log(chromium, "browser") == []
    asked = requests(chromium)
    assert asked[0] == case_report.as_uri()
    assert all(url.startswith(("data:", "blob:")) for url in asked[1:]), asked


def test_every_figure_has_its_curves(chromium: webdriver.Chrome, case_report: Path) -> None:
    open_page(chromium, case_report)
    found = curves(chromium)
    assert len(found) == 13
    assert found["figure-accel_mps2"] == ["test", "model"]
    assert found["figure-force-crush"] == ["test, mass \u00d7 deceleration", "model", "spring", "damper"]
    assert found["figure-pitch_rad"] == ["crush first, then heave and pitch", "crush, heave and pitch coupled"]
    assert all(found.values()), found


def test_legend_hides_and_shows_a_curve_by_mouse_and_keyboard(chromium: webdriver.Chrome, case_report: Path) -> None:
    open_page(chromium, case_report)
    button = chromium.find_element(By.CSS_SELECTOR, "#figure-accel_mps2 .legend button:nth-child(2)")
    button.click()
    assert button.get_attribute("aria-pressed") == "false"
    assert curves(chromium)["figure-accel_mps2"] == ["test"]
    assert curves(chromium)["figure-velocity_mps"] == ["test", "model"]
    button.send_keys(Keys.ENTER)
    assert button.get_attribute("aria-pressed") == "true"
    assert curves(chromium)["figure-accel_mps2"] == ["test", "model"]


def test_curves_cannot_be_sent_anywhere(chromium: webdriver.Chrome, case_report: Path) -> None:
    open_page(chromium, case_report)
    script = "return [...document.querySelectorAll('#figure-energy .modebar-btn')].map((b) => b.dataset.title)"
    assert chromium.execute_script(script) == ["Download plot", "Zoom", "Pan", "Reset axes"]


def colors(chromium: webdriver.Chrome) -> dict[str, Any]:
    script = """
        const style = (selector) => getComputedStyle(document.querySelector(selector));
        const figure = "#figure-force-crush ";
        return {
          page: style("body").backgroundColor,
          texts: [style("body").color, style(".subtitle").color, style("figcaption").color, style("main h2").color,
                  style(figure + ".xtick text").fill, style(figure + ".ytitle").fill, style("nav a").color],
          badges: [...document.querySelectorAll(".ratings .badge")].map((badge) => getComputedStyle(badge).color),
          curves: [...document.querySelectorAll(figure + ".js-line")].map((line) => getComputedStyle(line).stroke),
        }"""
    found: dict[str, Any] = chromium.execute_script(script)
    return found


def test_dark_and_light_differ_and_are_legible(chromium: webdriver.Chrome, case_report: Path) -> None:
    shown = {}
    for scheme in ("light", "dark"):
        open_page(chromium, case_report, scheme=scheme)
        shown[scheme] = found = colors(chromium)
        for color in [*found["texts"], *found["badges"]]:
            assert contrast(color, found["page"]) >= LEGIBLE_CONTRAST, (scheme, color)
        assert len(found["curves"]) == 4
        for color in found["curves"]:
            assert contrast(color, found["page"]) >= VISIBLE_CONTRAST, (scheme, color)
    assert luminance(shown["light"]["page"]) > 0.9
    assert luminance(shown["dark"]["page"]) < 0.05
    assert not set(shown["light"]["curves"]) & set(shown["dark"]["curves"])


def test_figures_follow_a_change_of_the_scheme(chromium: webdriver.Chrome, case_report: Path) -> None:
    open_page(chromium, case_report, scheme="light")
    light = colors(chromium)["curves"]
    emulate(chromium, scheme="dark")
    WebDriverWait(chromium, PATIENCE_S).until(lambda driver: colors(driver)["curves"] != light)
    assert not set(colors(chromium)["curves"]) & set(light)


@pytest.mark.parametrize("name", ["case_report", "batch_report"])
def test_narrow_screen_does_not_scroll_sideways(
    chromium: webdriver.Chrome, name: str, request: pytest.FixtureRequest
) -> None:
    open_page(chromium, request.getfixturevalue(name), width_px=NARROW_PX)
    assert chromium.execute_script("return document.documentElement.scrollWidth") == NARROW_PX
    script = """
        return [...document.querySelectorAll("main figure[id]")].flatMap((figure) => {
          const edge = figure.getBoundingClientRect().right;
          return [...figure.querySelectorAll("svg.main-svg")].map((svg) => svg.getBoundingClientRect().right - edge);
        })"""
    assert max(chromium.execute_script(script)) <= 0


def test_prints_in_light_and_draws_again(chromium: webdriver.Chrome, case_report: Path) -> None:
    open_page(chromium, case_report, scheme="dark")
    dark = colors(chromium)["curves"]
    chromium.execute_script("dispatchEvent(new Event('beforeprint'))")
    assert not set(colors(chromium)["curves"]) & set(dark)
    chromium.execute_script("dispatchEvent(new Event('afterprint'))")
    WebDriverWait(chromium, PATIENCE_S).until(lambda driver: colors(driver)["curves"] == dark)
    printed = chromium.execute_cdp_cmd("Page.printToPDF", {"preferCSSPageSize": True})
    assert len(printed["data"]) > 50_000


def order(chromium: webdriver.Chrome, selector: str = "table.sortable tbody tr > th") -> list[str]:
    script = "return [...document.querySelectorAll(arguments[0])].map((cell) => cell.firstChild.textContent)"
    found: list[str] = chromium.execute_script(script, selector)
    return found


def test_table_sorts_by_mouse_and_keyboard(chromium: webdriver.Chrome, batch_report: Path) -> None:
    open_page(chromium, batch_report)
    assert log(chromium, "browser") == []
    heads = chromium.find_elements(By.CSS_SELECTOR, "table.sortable thead th")
    buttons = [head.find_element(By.TAG_NAME, "button") for head in heads]
    assert order(chromium) == ["absent", "case-2", "case-10", "failed", "malformed"]
    buttons[0].click()
    assert heads[0].get_attribute("aria-sort") == "ascending"
    assert order(chromium) == ["absent", "case-2", "case-10", "failed", "malformed"]
    buttons[0].click()
    assert order(chromium) == ["malformed", "failed", "case-10", "case-2", "absent"]
    olc = 8
    buttons[olc].send_keys(Keys.SPACE)
    ascending = [value for value in values(chromium, olc) if value]
    assert [float(value) for value in ascending] == sorted(float(value) for value in ascending)
    assert heads[olc].get_attribute("aria-sort") == "ascending"
    buttons[olc].send_keys(Keys.ENTER)
    descending = values(chromium, olc)
    assert [value for value in descending if value] == ascending[::-1]
    assert descending[-1] == "", "without a number at the end, however it is sorted"
    assert heads[0].get_attribute("aria-sort") == "none"
    assert order(chromium, ".kind-1 li figcaption") == order(chromium)


def values(chromium: webdriver.Chrome, column: int) -> list[str]:
    script = """
        const rows = [...document.querySelectorAll("table.sortable tbody tr")];
        return rows.map((row) => row.cells[arguments[0]].dataset.value)"""
    found: list[str] = chromium.execute_script(script, column)
    return found


def test_small_multiples_of_two_kinds(chromium: webdriver.Chrome, batch_report: Path) -> None:
    open_page(chromium, batch_report)
    kinds = [chromium.find_element(By.CSS_SELECTOR, f".multiples.kind-{i}") for i in (1, 2)]
    assert [kind.is_displayed() for kind in kinds] == [True, False]
    chromium.find_element(By.CSS_SELECTOR, "label[for=kind-2]").click()
    assert [kind.is_displayed() for kind in kinds] == [False, True]
    lines = kinds[1].find_elements(By.TAG_NAME, "polyline")
    assert len(lines) == 5  # test and model of two cases, the model of the failed one
    assert curves(chromium)["figure-all-forces"] == ["case-2", "case-10", "failed"]


def test_markup_in_a_title_does_nothing(chromium: webdriver.Chrome, case_directory: CaseRunner, tmp_path: Path) -> None:
    evil = "<img src=x onerror=\"document.title='gone'\"></script><script>document.title='gone'</script>"
    case = shutil.copytree(case_directory(TWO_SPEEDS), tmp_path / "case")
    rewrite_json(case / "case.lock.json", options={"title": evil})
    shutil.copy(case / "prediction_40kmh.csv", case / "prediction_<img src=x><b>%{x}.csv")
    open_page(chromium, report(case))
    assert chromium.title == evil
    assert chromium.find_element(By.TAG_NAME, "h1").text == evil
    assert chromium.find_elements(By.CSS_SELECTOR, "img, main b") == []
    assert log(chromium, "browser") == []
