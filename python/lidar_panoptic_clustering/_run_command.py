"""What the commands ``benchmark`` and ``label`` share: options, parts, and how a run ends."""

import argparse
import os
import signal
import sys
from contextlib import contextmanager
from typing import Any, Callable, Dict, Iterator, List, NamedTuple, Tuple

from ._cluster import Outcome, Run
from ._connect import Cluster, ClusterError, connect
from ._progress import Progress
from ._tasks import Part, Work, package_version

SCANS_A_TASK = 25
FOLDERS = ("dataset", "semantics", "output")
TABLES = ("class-table", "label-table")


def make_parser(name: str, description: str) -> argparse.ArgumentParser:
    """The options of panoptic_benchmark, and those of a cluster."""
    from . import _core

    parser = argparse.ArgumentParser(
        prog=f"python3 -m lidar_panoptic_clustering {name}",
        description=description,
        formatter_class=argparse.RawDescriptionHelpFormatter,
        allow_abbrev=False,
        usage="%(prog)s --dataset DIR [options]",
    )
    plan = parser.add_argument_group("What to run on, and with")
    for option, kind, value, default, text in _core.BenchmarkPlan.options():
        settings: Dict[str, Any] = {"help": text.replace("%", "%%")}
        if kind == "flag":
            settings["action"] = "store_true"
        else:
            settings["metavar"] = value
        if kind == "list":
            settings.update(action="extend", nargs="+")
        if kind == "number":
            settings["help"] += f" (default: {default})"
        plan.add_argument(f"--{option}", **settings)
    cluster = parser.add_argument_group("Where to run")
    cluster.add_argument("--scheduler", metavar="tcp://HOST:8786", help="of a Dask cluster; else processes here")
    cluster.add_argument("--scheduler-file", metavar="FILE", help="as 'dask scheduler' writes it, instead of that")
    cluster.add_argument(
        "--workers", type=_positive, metavar="N", help="processes on this machine (default: one a processor)"
    )
    cluster.add_argument("--dashboard", metavar=":8787", help="where Dask's dashboard of the processes here listens")
    cluster.add_argument(
        "--scans-per-task", type=_positive, default=SCANS_A_TASK, metavar="N",
        help=f"scans a worker does in one go (default: {SCANS_A_TASK}; with --track a whole sequence)",
    )
    cluster.add_argument(
        "--patience", type=_seconds, metavar="S",
        help="seconds after which a task is begun on another worker too (default: 20 times the usual, 60 at least)",
    )
    cluster.add_argument(
        "--wait", type=_seconds, default=30.0, metavar="S", help="for scheduler and first worker (default: 30 s)"
    )
    return parser


def _positive(text: str) -> int:
    if not text.isdigit() or int(text) < 1:
        raise argparse.ArgumentTypeError(f"{text!r}, expected a number from 1 on")
    return int(text)


def _seconds(text: str) -> float:
    try:
        seconds = float(text)
    except ValueError:
        seconds = -1.0
    if not 0.0 < seconds < 1e9:
        raise argparse.ArgumentTypeError(f"{text!r}, expected seconds above 0")
    return seconds


class Counts(NamedTuple):
    """Of the whole run."""

    scans: Dict[str, int]
    """By sequence."""
    skipped: List[Tuple[str, str]]
    """Predictions without a scan, and why."""


def count_scans(plan: Any) -> Counts:
    """Looks through all sequences, so that what is wrong with them is told before the first scan is read."""
    from . import _core

    scans: Dict[str, int] = {}
    skipped: List[Tuple[str, str]] = []
    for sequence in plan.sequences:
        benchmark = _core.SequenceBenchmark(plan, sequence)
        scans[sequence] = len(benchmark)
        skipped += benchmark.skipped
    return Counts(scans, skipped)


def parts_of(plan: Any, scans: Dict[str, int], scans_a_task: int) -> Iterator[Part]:
    """In order; never of two sequences, and whole sequences where objects are tracked."""
    from . import _core

    for sequence, count in scans.items():
        benchmark = _core.SequenceBenchmark(plan, sequence)
        step = count if plan.track else scans_a_task
        for begin in range(0, count, step):
            yield Part(sequence, begin, min(begin + step, count), benchmark.scan_name(begin))


@contextmanager
def noted_signals() -> Iterator[Callable[[], int]]:
    """SIGINT and SIGTERM are only noted, each once; the function returns which one, or 0."""
    received: List[int] = []

    def note(number: int, _: Any) -> None:
        received.append(number)
        signal.signal(number, signal.SIG_DFL)  # a second one ends the program at once

    before = {number: signal.signal(number, note) for number in (signal.SIGINT, signal.SIGTERM)}
    try:
        yield lambda: received[0] if received else 0
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


class Ended(NamedTuple):
    """How a command's run ended."""

    outcome: Outcome
    signal: int
    used: int
    resumed: int
    skipped: int


def run_parts(
    name: str, plan: Any, work: Work, given: argparse.Namespace, take: Callable[[Dict[str, Any]], None],
    skip: Callable[[str, str], None],
) -> Ended:
    """Runs all parts of a plan on the cluster that the options name.

    Raises:
        ClusterError, ValueError, RuntimeError: with what is wrong, before a scan was read.
    """
    counts = count_scans(plan)
    numbers = {"used": 0, "resumed": 0, "skipped": 0}

    def taken(result: Dict[str, Any]) -> None:
        numbers["used"] += result["used"]
        numbers["resumed"] += result["resumed"]
        take(result)

    def skipped(scan: str, reason: str) -> None:
        numbers["skipped"] += 1
        skip(scan, reason)

    def name_of(sequence: str, scan: int) -> str:
        from . import _core

        return str(_core.SequenceBenchmark(plan, sequence).scan_name(scan))

    if given.scheduler and (given.workers or given.dashboard):
        raise ValueError("--scheduler excludes --workers and --dashboard: these are of this machine's own cluster")
    workers = given.workers or len(os.sched_getaffinity(0))
    where = Cluster(given.scheduler, given.scheduler_file, workers, given.dashboard, given.wait)
    for scan, reason in counts.skipped:
        print(f"skipped {scan}: {reason}", file=sys.stderr)
        skipped(scan, reason)
    with connect(where) as client, noted_signals() as received:
        if given.dashboard:
            print(f"dashboard: {client.dashboard_link}", file=sys.stderr)
        progress = Progress(name, sum(counts.scans.values()))
        run = Run(client, name, work, plan.keep_going, given.patience, taken, skipped, name_of)
        parts = parts_of(plan, counts.scans, given.scans_per_task)
        outcome = run.run(parts, progress, lambda: received() != 0)
        progress.finish()
        number = received()
    if number == 0 and outcome.failure is None and numbers["used"] == 0:
        outcome = Outcome(False, False, f"none of the {sum(counts.scans.values())} scans could be used")
    return Ended(outcome, number, numbers["used"], numbers["resumed"], numbers["skipped"])


def make_work(given: argparse.Namespace, label: bool) -> Tuple[Any, Work]:
    """The plan of the options. For workers elsewhere all paths are made absolute, to mean the same to each."""
    from . import _core

    elsewhere = given.scheduler or given.scheduler_file
    options: Dict[str, Tuple[str, ...]] = {}
    for name, kind, *_ in _core.BenchmarkPlan.options():
        value = getattr(given, name.replace("-", "_"))
        if value is None or value is False:
            continue
        if elsewhere and (name in FOLDERS or (name in TABLES and os.path.isfile(value))):
            value = os.path.abspath(value)
        options[name] = () if kind == "flag" else tuple(value) if kind == "list" else (value,)
    return _core.BenchmarkPlan(options, label), Work(tuple(options.items()), label, package_version())


def exit_status(name: str, ended: Ended) -> int:
    """Prints how a run ended where that is not the end of its parts."""
    if ended.outcome.failure is not None:
        print(f"{name}: {ended.outcome.failure}", file=sys.stderr)
        return 1
    if ended.signal:
        print(f"{name}: interrupted; the figures are of the scans done by then", file=sys.stderr)
        return 128 + ended.signal
    return 0


def guarded(name: str, command: Callable[[], int]) -> int:
    """Exit status of a command; errors are printed behind its name."""
    try:
        return command()
    except KeyboardInterrupt:
        print(f"{name}: interrupted before the first scan", file=sys.stderr)
        return 130
    except (ClusterError, OSError, ValueError, RuntimeError, ImportError) as error:
        print(f"{name}: {error}", file=sys.stderr)
        return 1
