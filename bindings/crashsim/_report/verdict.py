"""What the case says, in plain words."""

from __future__ import annotations

from .case import CaseDirectory
from .case_tables import grade_badge
from .files import Node
from .markup import Content, Markup, tag
from .quantities import outcome_words, words


def verdict(case: CaseDirectory) -> Markup:
    """Outcome, agreement with the test, what the data determine, and every warning."""
    sentences = [*_outcome(case), *_agreement(case), *_determined(case)]
    warnings = list(dict.fromkeys(_warnings(case)))
    return tag(
        "section",
        tag("h2", "Verdict"),
        tag("ul", [tag("li", sentence) for sentence in sentences]),
        [tag("h3", "To keep in mind"), tag("ul", [tag("li", text) for text in warnings])] if warnings else None,
        id="verdict",
        class_="verdict" + (" failed" if case.outcome not in ("", "completed") else ""),
    )


def _outcome(case: CaseDirectory) -> list[Content]:
    if not case.outcome:
        return ["The directory has no summary: whether the case completed is not known."]
    if case.outcome == "completed":
        return ["Every step of the case completed."]
    return [[tag("strong", "The case has no result to rely on: "), outcome_words(case.outcome), "."]]


def _agreement(case: CaseDirectory) -> list[Content]:
    comparison = case.comparisons.get("to_max_crush")
    if comparison is None:
        return [] if case.pulse else ["No test stands beside the model: nothing tells how well it agrees."]
    grades: list[Content] = []
    for channel in comparison.nodes("channels"):
        rating = channel.node("iso18571") or Node(channel.path, {})
        separator = ", " if grades else " "
        grades += [separator, words(channel.text("name")), " ", grade_badge(rating.text("grade"))]
    return [["Up to maximum crush the model agrees with the test (ISO/TS 18571):", *grades]]


def _determined(case: CaseDirectory) -> list[Content]:
    part = case.part("identification")
    if part is None:
        return ["The model was given, not identified."] if case.model and not case.model.identification else []
    sentences: list[Content] = []
    if text := part.text("verdict"):
        is_determined = part.flag("identifiable")
        lead = "The data determine the model: " if is_determined else "The data do not determine every number: "
        sentences.append([tag("strong", lead), text, "."])
    best, starts = part.number("starts_at_best"), part.number("starts")
    if best is not None and starts:
        sentences.append(f"{best:.0f} of {starts:.0f} starts of the identification ended within 0.1 % of the best.")
    return sentences


def _warnings(case: CaseDirectory) -> list[str]:
    fit = case.model.identification if case.model else None
    at_bound, untouched = (fit.texts("at_bound"), fit.texts("untouched")) if fit else ([], [])
    warnings = [f"{', '.join(at_bound)}: ended at a bound."] if at_bound else []
    warnings += [f"{', '.join(untouched)}: no sample depends on it."] if untouched else []
    for table, comment in ((case.pulse, "warning"), (case.pitch, "note"), (case.coupled, "note")):
        warnings += table.comments.get(comment, []) if table else []
    for name, table in (("pitch", case.pitch), ("coupled", case.coupled), *case.predictions.items()):
        outcome = table.comments.get("outcome", [""])[0] if table else ""
        if outcome not in ("", "completed"):
            warnings.append(f"{name}: {outcome_words(outcome)}.")
    return warnings
