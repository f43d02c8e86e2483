"""The command line: ``python3 -m lidar_panoptic_clustering plot | benchmark | label``."""

import sys
from typing import Callable, Dict, List, Optional

USAGE = """python3 -m lidar_panoptic_clustering COMMAND ..

  plot       charts of a benchmark's report
  benchmark  quality and time of the algorithms on a data set, on all workers of a cluster
  label      predictions for a whole data set, on all workers of a cluster

Each has a --help of its own.
"""


def _plot(arguments: List[str]) -> int:
    from ._plot_command import main

    return main(arguments)


def _benchmark(arguments: List[str]) -> int:
    from ._benchmark_command import main

    return main(arguments)


def _label(arguments: List[str]) -> int:
    from ._label_command import main

    return main(arguments)


COMMANDS: Dict[str, Callable[[List[str]], int]] = {"plot": _plot, "benchmark": _benchmark, "label": _label}


def main(arguments: Optional[List[str]] = None) -> int:
    """Exit status: 0, 1 after an error, 2 after a wrong command line, 130 after Ctrl-C."""
    given = sys.argv[1:] if arguments is None else arguments
    if given and given[0] in COMMANDS:
        return COMMANDS[given[0]](given[1:])
    asked = bool(given) and given[0] in ("-h", "--help")
    if given and not asked:
        print(f"unknown command '{given[0]}', expected one of {', '.join(COMMANDS)}\n", file=sys.stderr)
    print(USAGE, end="", file=sys.stdout if asked else sys.stderr)
    return 0 if asked else 2


if __name__ == "__main__":
    sys.exit(main())
