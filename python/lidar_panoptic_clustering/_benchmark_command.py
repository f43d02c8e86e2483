"""The command ``benchmark``: panoptic_benchmark on all workers of a cluster."""

import contextlib
import os
import shutil
import sys
from typing import Any, Dict, List, Optional

from ._run_command import exit_status, guarded, make_parser, make_work, run_parts

NAME = "benchmark"


def main(arguments: List[str]) -> int:
    """Exit status: 0, 1 after an error, 130 after Ctrl-C, which ends with the figures so far."""
    return guarded(NAME, lambda: _benchmark(arguments))


class _ReportFile:
    """Opened aside before the run, so that a path that cannot be written costs no figures; renamed when saved."""

    def __init__(self, path: str) -> None:
        special = os.path.exists(path) and not os.path.isfile(path)  # a pipe, /dev/stdout: written to as it is
        self.path, self._part = path, path if special else f"{path}.{os.getpid()}.part"
        self._file = open(self._part, "wb")

    def save(self, text: bytes) -> None:
        self._file.write(text)
        self._file.close()
        if self._part != self.path:
            os.replace(self._part, self.path)

    def discard(self) -> None:
        """Unless it was saved."""
        if not self._file.closed:
            self._file.close()
            if self._part != self.path:
                os.remove(self._part)


def _benchmark(arguments: List[str]) -> int:
    from . import _core

    parser = make_parser(NAME, "Quality and time of clustering algorithms on a data set, on all workers of a cluster.")
    parser.add_argument("--report", metavar="FILE.json", help="write all figures, as panoptic_benchmark does")
    parser.add_argument("--plot", metavar="DIR", help="write charts of them; the report too, if --report is not given")
    given = parser.parse_args(arguments)
    plan, work = make_work(given, label=False)
    if given.plot:
        os.makedirs(given.plot, exist_ok=True)
    path = given.report or (os.path.join(given.plot, "report.json") if given.plot else None)
    file: Optional[_ReportFile] = _ReportFile(path) if path else None
    total = _core.BenchmarkSum(plan)

    def take(result: Dict[str, Any]) -> None:
        if result["used"]:
            total.add(result["report"])

    try:
        ended = run_parts(NAME, plan, work, given, take, total.skip)
        if ended.outcome.failure is None or (ended.outcome.lost and ended.used):
            width = shutil.get_terminal_size().columns if sys.stdout.isatty() else 0
            print(total.table(ended.outcome.interrupted, width), end="", flush=True)
            if file:
                file.save(total.json(ended.outcome.interrupted))
    finally:
        if file:
            file.discard()
    status = exit_status(NAME, ended)
    if given.plot and path and os.path.exists(path) and status != 1:
        from ._plot_command import main as plot

        with contextlib.redirect_stdout(sys.stderr):  # the table alone goes to stdout
            status = plot(["--output", given.plot, path]) or status
    return status
