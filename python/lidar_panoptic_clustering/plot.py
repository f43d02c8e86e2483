"""Charts of a benchmark's report: ``python3 -m lidar_panoptic_clustering plot report.json``.

The report is what ``--report`` of panoptic_benchmark, and of the command ``benchmark`` of this package, writes.
Needs matplotlib (run with 3.6), and nothing of the compiled part of this package.
"""

import json
import math
import os
from typing import Any, Callable, Dict, List, Sequence, Tuple

from ._page import Page, color_of, marker_of

Report = Dict[str, Any]

FORMATS = ("png", "svg")
SCAN_OF_10_HZ_MS = 100.0


class ReportError(ValueError):
    """A file that is no report of a benchmark, named, with what was expected."""


def load_report(path: str) -> Report:
    """Reads a report.

    Raises:
        ReportError: naming the file, where it is no benchmark's report.
        OSError: where it cannot be read.
    """
    with open(path, encoding="utf-8") as file:
        try:
            report = json.load(file)
        except ValueError as error:
            raise ReportError(f"{path}: not JSON: {error}") from None
    try:
        for name in report["rows"]:
            report["times"][name]["frames"], report["times"][name]["cluster_ms"]["median"]
            report["quality"]["rows"][name]["per_class"]
        report["quality"]["before_clustering"]["scans"], report["quality"]["scans"].values()
    except (KeyError, TypeError, AttributeError) as error:
        what = f"key {error} is missing" if isinstance(error, KeyError) else str(error)
        raise ReportError(f"{path}: {what}, expected a report of panoptic_benchmark") from None
    return dict(report)


def draw_report(report: Report, folder: str, formats: Sequence[str] = FORMATS) -> List[str]:
    """Draws quality, objects and PQ by class (where there was ground truth), time, and time against points.

    Args:
        report: as of :func:`load_report`.
        folder: made where it is missing; each file is written aside and renamed.
        formats: of ``png`` and ``svg``.

    Returns:
        The files written.

    Raises:
        ValueError: on another format.
        ImportError: where there is no matplotlib.
        OSError: naming the file that cannot be written.
    """
    for name in formats:
        if name not in FORMATS:
            raise ValueError(f"format is '{name}', expected one of {', '.join(FORMATS)}")
    charts: List[Tuple[str, Callable[[Report], Page]]] = [("time", draw_times), ("time_by_points", draw_time_by_points)]
    if report["quality"]["before_clustering"]["scans"] > 0:
        charts = [("quality", draw_quality), ("objects", draw_objects), ("pq_by_class", draw_classes)] + charts
    os.makedirs(folder, exist_ok=True)
    written = []
    for name, draw in charts:
        page = draw(report)
        for kind in formats:
            path = os.path.join(folder, f"{name}.{kind}")
            page.save(path, kind)
            written.append(path)
    return written


def subtitle(report: Report) -> str:
    """Semantics, number of scans and sequences."""
    scans = report["quality"]["scans"]
    text = f"semantics: {report['quality']['semantics']}"
    if scans:
        text += f"; {sum(scans.values()):,} scans evaluated, sequences {', '.join(sorted(scans))}"
    return text + ("; interrupted" if report.get("interrupted") else "")


def draw_quality(report: Report) -> Page:
    """PQ, RQ, SQ, PQ of things and of things that occur; LSTQ where ids were tracked: bars by row."""
    figures = {"PQ": "pq", "RQ": "rq", "SQ": "sq", "PQ of things": "pq_th", "PQ of things that occur": "pq_th_present"}
    rows = [report["quality"]["rows"][name] for name in report["rows"]]
    series = {title: [100.0 * row[key] for row in rows] for title, key in figures.items()}
    if rows and all("temporal" in row for row in rows):
        series["LSTQ"] = [100.0 * row["temporal"]["lstq"] for row in rows]
    page = Page("Quality", subtitle(report), bars=len(rows) * len(series))
    page.bars(report["rows"], series, decimals=1)
    page.axes.set_ylim(0.0, 100.0)
    page.axes.set_ylabel("quality [%]")
    return page


def draw_objects(report: Report) -> Page:
    """True objects that were split, merged or missed: bars by row."""
    counts = [report["quality"]["rows"][name]["true_objects"] for name in report["rows"]]
    series = {what: [float(count[what]) for count in counts] for what in ("split", "merged", "missed")}
    total = f"; of {counts[0]['total']:,} true objects" if counts else ""
    page = Page("True objects that were not found", subtitle(report) + total, bars=3 * len(counts))
    page.bars(report["rows"], series, decimals=0)
    page.axes.set_ylim(0.0, max(1.0, 1.08 * max((max(values) for values in series.values() if values), default=1.0)))
    page.axes.set_ylabel("true objects")
    return page


def draw_classes(report: Report) -> Page:
    """PQ of the classes that occur, things first, the most frequent first: bars by class."""
    before = report["quality"]["before_clustering"]["per_class"]
    shown = [name for name, counts in before.items() if counts["tp"] + counts["fp"] + counts["fn"] > 0]
    shown.sort(key=lambda name: (before[name]["kind"] != "thing", -before[name]["points"]["true"], name))
    rows = report["quality"]["rows"]
    series = {row: [100.0 * rows[row]["per_class"][name]["pq"] for name in shown] for row in report["rows"]}
    page = Page("PQ by class", subtitle(report), bars=len(shown) * len(series))
    page.bars(shown, series, decimals=None)
    page.axes.set_ylim(0.0, 100.0)
    page.axes.set_ylabel("PQ [%]")
    things = sum(before[name]["kind"] == "thing" for name in shown)
    if 0 < things < len(shown):
        page.divide(things - 0.5, "things", "stuff")
    return page


def draw_times(report: Report) -> Page:
    """Median and 95th percentile of the time a scan, of clustering and of the whole pipeline: by row, logarithmic."""
    times = [report["times"][name] for name in report["rows"]]
    page = Page("Time a scan", subtitle(report), bars=2 * len(times))
    spans = {
        name: [(row[key]["median"], row[key]["p95"]) for row in times]
        for name, key in (("clustering", "cluster_ms"), ("pipeline", "pipeline_ms"))
    }
    page.spans(report["rows"], spans, ("median", "95th percentile"))
    page.axes.set_ylabel("time [ms]")
    page.reference(SCAN_OF_10_HZ_MS, "one scan at 10 Hz")
    return page


def draw_time_by_points(report: Report) -> Page:
    """Clustering time of each scan against its thing points: a marker a scan, a colour a row."""
    page = Page("Clustering time against thing points", subtitle(report))
    for index, name in enumerate(report["rows"]):
        frames = [frame for frame in report["times"][name]["frames"] if frame["cluster_ms"] > 0.0]
        page.axes.plot(
            [frame["thing_points"] for frame in frames],
            [frame["cluster_ms"] for frame in frames],
            linestyle="none",
            marker=marker_of(index),
            markersize=max(3.0, 8.0 - math.log10(len(frames) + 1)),
            markeredgewidth=0.0 if marker_of(index) not in "x+" else 1.8,
            color=color_of(index),
            alpha=0.8,
            rasterized=len(frames) > 2000,
            label=name,
        )
    page.logarithmic()
    page.axes.set_xlim(left=0.0)
    page.axes.set_xlabel("thing points of the range image")
    page.axes.set_ylabel("clustering time [ms]")
    page.reference(SCAN_OF_10_HZ_MS, "one scan at 10 Hz", right=False)
    return page
