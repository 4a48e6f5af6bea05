"""The reference of the Python package: every public name, by topic."""

from collections.abc import Iterable
from pathlib import Path

import crashsim
from _generate.markdown import code, table
from crashsim import plots

TOPICS = {
    "Traces": ("read_traces inspect_traces write_iso_mme check_redundant TraceSet Trace TraceFileInfo ChannelInfo"),
    "Signals": ("cfc_filter integrate differentiate find_time_zero quantity TimeSeries STANDARD_GRAVITY_MPS2"),
    "Pulses": "read_pulse make_pulse write_pulse Pulse",
    "Load-cell walls": (
        "read_wall assemble_wall wall_channels wall_numbers check_momentum write_wall "
        "LoadCellWall WallStrip WallNumbers"
    ),
    "Sensor corrections": (
        "correct_sensors read_sensor_correction write_sensor_correction SensorCorrection ChannelCorrection "
        "CorrectionCondition"
    ),
    "Crush": (
        "simulate simulate_many read_model write_model write_response export_model uniform_knots CrushModel "
        "PiecewiseLinear Unloading CrushResponse SolverStatistics CrushModels CrushResponses"
    ),
    "Identification": (
        "identify equation_error fit_error Identification Verdict FitError OrdinateReport TestReport "
        "ParameterReport StartReport"
    ),
    "Choice of a model": "select_model Selection SelectionRow LeftOutTest",
    "Uncertainty and prediction": (
        "uncertainty predict read_prediction_basis Uncertainty OrdinateUncertainty FisherDirection Band "
        "PredictionBasis SpeedPrediction PredictedSpeed PredictedCurve"
    ),
    "Heave and pitch": (
        "simulate_pitch identify_pitch read_vehicle write_vehicle write_pitch "
        "read_forcing forcing_of HeavePitchModel Mode "
        "PitchForcing MeasuredForcing PitchResponse PitchTarget PitchFitError "
        "PitchIdentification"
    ),
    "The barrier's vertical force": (
        "vertical_force identify_vertical read_vertical_target VerticalForceLaw "
        "VerticalForceTarget MeasuredVertical VerticalIdentification"
    ),
    "Crush, heave and pitch together": "simulate_coupled write_coupled CoupledModel GroundContact CoupledResponse",
    "Judgement": (
        "metrics rate grade errors compare write_comparison occupant_load_criterion sliding_mean_peak "
        "vehicle_pulse_index acceleration_severity_index kw400 ahof400 crash3_stiffness "
        "energy_equivalent_speed compare_metrics motion_balance check_balance check_fleet Metrics Olc Crash3 Rating "
        "ErrorSummary ChannelComparison Comparison NamedComparison MetricComparison MotionBalance"
    ),
    "Measured motion of the body": "read_motion body_motion BodyStation BodyMotion MeasuredMotion",
    "Studies": "run_case read_case find_record summarize report Case CaseResult Prediction",
    "Sweeps and Monte Carlo": (
        "plan_samples run_samples join_samples SampleTable SamplePlan SampleSummary SampleOutput SampleEffect "
        "SobolIndex SampleStatistics SampleInput SampleDesign Distribution"
    ),
    "Many cases": (
        "run_batch plan_batch merge_batches run_batch_case is_batch_case_done batch_row_from_json "
        "BatchReport BatchRow BatchCase BatchFolder StageTimes RayExecutor"
    ),
    "Design": (
        "design run_design design_responses quantity_of DesignVariable DesignLimit "
        "DesignResult DesignCaseResult DesignResponses DesignSensitivity TradeOffPoint"
    ),
    "Errors": "InvalidInput NumericalFailure SystemFailure Interrupted",
}
"""Names in the order in which they are shown."""
ELSEWHERE = {"__version__", "plots"}

INTRODUCTION = """\
# Python package

`import crashsim`. NumPy arrays go in and come out. Everything is in SI units, and the name of a quantity ends in its
unit. Where a number is an option, text with a unit is taken as well: `impact_speed_mps="56 km/h"`. Results are
read-only values with the names that the C++ structs have.
"""

MODULE = "```{eval-rst}\n.. currentmodule:: crashsim\n```\n"
PLOTS = "# Plots\n\n```{eval-rst}\n.. automodule:: crashsim.plots\n   :members:\n   :imported-members:\n```\n"


def entry(name: str) -> str:
    """What autodoc is told of one name."""
    value = getattr(crashsim, name)
    if not isinstance(value, type):
        return f"```{{eval-rst}}\n.. {'autofunction' if callable(value) else 'autodata'}:: {name}\n```\n"
    members = "" if issubclass(value, BaseException) else "   :members:\n   :special-members: __call__\n"
    return f"```{{eval-rst}}\n.. autoclass:: {name}\n{members}```\n"


def topic_page(title: str, names: Iterable[str]) -> str:
    """A page with some names."""
    return f"# {title}\n\n{MODULE}\n" + "\n".join(entry(name) for name in names)


def write_python_pages(folder: Path) -> None:
    """Writes index.md and a page for each topic; a public name that no topic has comes last."""
    public = [name for name in crashsim.__all__ if name not in ELSEWHERE]
    topics = {title: [name for name in names.split() if name in public] for title, names in TOPICS.items()}
    topics["More"] = [name for name in public if name not in " ".join(TOPICS.values()).split()]
    pages = {
        title.lower().replace(" ", "-").replace("'", "").replace(",", ""): title for title in topics if topics[title]
    }
    folder.mkdir(parents=True, exist_ok=True)
    for page, title in pages.items():
        (folder / f"{page}.md").write_text(topic_page(title, topics[title]), encoding="utf-8")
    (folder / "plots.md").write_text(PLOTS, encoding="utf-8")
    rows = [(f"[{title}]({page}.md)", ", ".join(map(code, topics[title]))) for page, title in pages.items()]
    rows.append(("[Plots](plots.md)", ", ".join(map(code, plots.__all__))))
    toctree = "```{toctree}\n:hidden:\n\n" + "\n".join([*pages, "plots"]) + "\n```\n"
    (folder / "index.md").write_text(
        "\n".join([INTRODUCTION, table(("topic", "names"), rows), toctree]), encoding="utf-8"
    )
