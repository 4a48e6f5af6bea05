"""Manners of pictures: they draw into the given axes and nowhere else, and read well at any width."""

from __future__ import annotations

import doctest
import subprocess
import sys
from collections.abc import Callable
from typing import Any

import matplotlib
import matplotlib.pyplot as plt
import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.text import Text

from crashsim import plots
from plot_samples import MASS_KG, NAN, body, crush, fit, measured, model
from plot_samples import closed_figures as closed_figures

pytestmark = pytest.mark.usefixtures("closed_figures")


def one(draw: Callable[[Any], Axes]) -> Callable[[Any], Any]:
    return lambda axes: draw(None if axes is None else axes[0])


VALUES, ERRORS = np.array([1.0, 2.0, 3.0, 4.0]), np.array([0.05, 0.03, NAN, 0.04])
PARAMETERS = np.array([[1.0, 20.0], [2.0, 10.0], [4.0, 40.0]])

# Each picture once: name -> (number of panels, function of axes or None).
PICTURES: dict[str, tuple[int, Callable[[Any], Any]]] = {
    "pulse": (3, lambda axes: plots.plot_pulse(crush(), axes=axes)),
    "response": (3, lambda axes: plots.plot_response(crush(), axes=axes)),
    "model": (2, lambda axes: plots.plot_model(fit(), axes=axes)),
    "fit": (3, lambda axes: plots.plot_fit(crush(), [crush(), crush(14.0)], axes=axes)),
    "prediction": (1, one(lambda ax: plots.plot_prediction([crush(12.0), crush(9.0)], ax=ax))),
    "spring": (1, one(lambda ax: plots.plot_spring(fit(), ax=ax))),
    "damper": (1, one(lambda ax: plots.plot_damper({"a": model(), "b": model(scale=2.0)}, ax=ax))),
    "force": (1, one(lambda ax: plots.plot_force_crush(crush(), crush(14.0), ax=ax))),
    "energy": (1, one(lambda ax: plots.plot_energy(crush(), MASS_KG, ax=ax))),
    "pitch": (2, lambda axes: plots.plot_pitch([body(), body(t_m_s=0.09)], measured=measured(), axes=axes)),
    "starts": (1, one(lambda ax: plots.plot_starts(fit(), ax=ax))),
    "parameters": (1, one(lambda ax: plots.plot_start_parameters(PARAMETERS, [0.3, 0.1, 0.2], ax=ax))),
    "profile": (1, one(lambda ax: plots.plot_profile_likelihood(VALUES, ERRORS, best=2.0, threshold=0.04, ax=ax))),
    "work": (1, one(lambda ax: plots.plot_work_precision({"a": ([1e-3, 1e-6], [1e-5, 1e-4])}, ax=ax))),
}


@pytest.mark.parametrize("name", PICTURES)
def test_without_axes_a_figure_is_made(name: str) -> None:
    count, draw = PICTURES[name]
    axes = np.ravel(draw(None))
    assert len(axes) == count
    assert plt.get_fignums() == [1]
    assert list(axes[0].figure.axes) == list(axes)
    assert all(ax.get_ylabel() for ax in axes)
    assert axes[-1].get_xlabel() or name == "parameters"
    assert not axes[0].get_title(loc="left")


@pytest.mark.parametrize("name", PICTURES)
def test_given_axes_are_drawn_into_and_nothing_else(name: str) -> None:
    count, draw = PICTURES[name]
    figure, axes = plt.subplots(count + 1, 1)
    before, spare = figure.get_size_inches().tolist(), axes[-1]
    returned = np.ravel(draw(axes[:-1]))
    assert list(returned) == list(axes[:-1])
    assert list(figure.axes) == list(axes)
    assert plt.get_fignums() == [1]
    assert not spare.has_data()
    assert figure.get_size_inches().tolist() == before
    assert returned[0].spines["top"].get_visible()


@pytest.mark.parametrize("name", PICTURES)
def test_settings_of_matplotlib_stay(name: str) -> None:
    before = dict(matplotlib.rcParams)
    PICTURES[name][1](None)
    assert dict(matplotlib.rcParams) == before


@pytest.mark.parametrize("width_inch", [3.35, 6.4, 12.0])
@pytest.mark.parametrize("name", PICTURES)
def test_picture_is_as_wide_as_asked_and_its_legend_covers_no_curve(name: str, width_inch: float) -> None:
    with matplotlib.rc_context({"figure.figsize": (width_inch, 3.0)}):
        axes = np.ravel(PICTURES[name][1](None))
    figure = axes[0].figure
    figure.canvas.draw()
    assert figure.get_figwidth() == width_inch
    assert axes[0].get_legend() is not None
    box, frame = axes[0].get_legend().get_window_extent(), axes[0].get_window_extent()
    assert box.y0 >= frame.y1 - 1
    assert box.x1 <= figure.bbox.x1 + 1
    assert frame.width > 0.6 * figure.bbox.width
    assert axes[-1].xaxis.get_ticklabels()[0].get_fontsize() == axes[-1].xaxis.label.get_fontsize()


@pytest.mark.parametrize("name", [name for name, (count, _) in PICTURES.items() if count > 1])
def test_another_number_of_axes_is_an_error(name: str) -> None:
    count, draw = PICTURES[name]
    _, axes = plt.subplots(count + 1, 1)
    with pytest.raises(ValueError, match=rf"axes: {count + 1} given, must be {count}, one for each panel"):
        draw(axes)


def test_axes_of_a_subfigure_are_drawn_into() -> None:
    figure = plt.figure(layout="constrained")
    grid = figure.add_gridspec(1, 2)
    left, right = figure.add_subfigure(grid[0]), figure.add_subfigure(grid[1])
    plots.plot_energy(crush(), MASS_KG, ax=left.subplots())
    plots.plot_prediction([crush(9.0), crush(12.0)], ax=right.subplots())
    figure.canvas.draw()
    shown = left.axes[0].get_legend()
    assert shown is not None
    assert shown.get_window_extent().x1 <= left.bbox.x1 + 1


def test_figures_without_pyplot_are_drawn_into(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "matplotlib.pyplot", None)
    assert plots.plot_starts(fit(), ax=Figure().subplots()).has_data()


def test_title_stands_above_the_legend() -> None:
    ax = plots.plot_energy(crush(), MASS_KG, title="Energy")
    ax.figure.canvas.draw()
    assert ax.get_title(loc="left") == "Energy"
    (title,) = [text for text in ax.get_children() if isinstance(text, Text) and text.get_text() == "Energy"]
    shown = ax.get_legend()
    assert shown is not None
    assert title.get_window_extent().y0 >= shown.get_window_extent().y1 - 3


@pytest.mark.parametrize("name", plots.__all__)
def test_example_in_the_documentation_runs(name: str) -> None:
    pytest.importorskip("crashsim._core")
    runner = doctest.DocTestRunner(optionflags=doctest.FAIL_FAST)
    (example,) = doctest.DocTestFinder(recurse=False).find(getattr(plots, name), name)
    runner.run(example)
    assert runner.tries > 0
    assert runner.failures == 0
    assert plt.get_fignums() == [1]


def test_without_matplotlib_the_remedy_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "matplotlib.pyplot", None)
    with pytest.raises(ImportError, match=r"pip install 'crashsim\[plots\]'"):
        plots.plot_pulse(crush())


def test_importing_the_pictures_does_not_import_matplotlib() -> None:
    code = "import sys, crashsim.plots; sys.exit('matplotlib' in sys.modules)"
    subprocess.run([sys.executable, "-c", code], check=True)
