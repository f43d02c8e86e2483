"""The command ``plot``."""

import argparse
import sys
from typing import List

from .plot import FORMATS, draw_report, load_report

NAME = "python3 -m lidar_panoptic_clustering plot"


def main(arguments: List[str]) -> int:
    """Exit status: 0, or 1 after an error, which is printed."""
    parser = argparse.ArgumentParser(prog=NAME, description="Charts of a benchmark's report, by matplotlib.")
    parser.add_argument("report", help="as of panoptic_benchmark --report")
    parser.add_argument("--output", metavar="DIR", help="where to (default: the report's name without its ending)")
    parser.add_argument("--format", metavar="F,F", default=",".join(FORMATS), help="of png and svg (default: both)")
    given = parser.parse_args(arguments)
    folder = given.output or (given.report[:-5] if given.report.endswith(".json") else given.report + "_charts")
    try:
        for path in draw_report(load_report(given.report), folder, given.format.split(",")):
            print(path)
    except ImportError as error:
        if (error.name or "").split(".")[0] != "matplotlib":
            raise
        print(f"plot: {error}: apt-get install python3-matplotlib, or pip install matplotlib", file=sys.stderr)
        return 1
    except (OSError, ValueError) as error:
        print(f"plot: {error}", file=sys.stderr)
        return 1
    return 0
