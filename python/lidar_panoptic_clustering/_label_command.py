"""The command ``label``: predictions for whole data sets, on all workers of a cluster."""

from typing import List

from ._run_command import exit_status, guarded, make_parser, make_work, run_parts

NAME = "label"


def main(arguments: List[str]) -> int:
    """Exit status: 0, 1 after an error, 130 after Ctrl-C; a later run goes on where this one stopped."""
    return guarded(NAME, lambda: _label(arguments))


def _label(arguments: List[str]) -> int:
    parser = make_parser(
        NAME,
        "Instances for a whole data set: OUTPUT/sequences/SS/predictions/NNNNNN.label, each written aside\n"
        "and renamed. A later run with the same options goes on where this one stopped.",
    )
    parser.add_argument("--algorithm", metavar="A", help="which one (default: birds_eye)")
    given = parser.parse_args(arguments)
    if given.algorithm and given.algorithms:
        raise ValueError("--algorithm and --algorithms exclude each other")
    given.algorithms = given.algorithms or given.algorithm or "birds_eye"
    plan, work = make_work(given, label=True)
    ended = run_parts(NAME, plan, work, given, lambda _: None, lambda *_: None)
    print(f"{ended.used} scans labelled, {ended.resumed} of them by a run before; {ended.skipped} skipped")
    return exit_status(NAME, ended)
