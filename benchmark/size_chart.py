#!/usr/bin/env python3
"""Draws what size_benchmark prints: size_benchmark | size_chart.py chart.png"""
import csv
import math
import sys

import matplotlib
matplotlib.use("Agg")
from matplotlib import pyplot  # noqa: E402


def main():
    lines = {}
    for row in csv.DictReader(sys.stdin):
        line = lines.setdefault((row["algorithm"], row["classes"]), [])
        line.append((float(row["things"]), float(row["copies"])))
    figure, axes = pyplot.subplots(figsize=(10, 6))
    for (algorithm, classes), points in lines.items():
        style = "o-" if classes == "true classes" else "s--"
        axes.loglog(*zip(*points), style, label=f"{algorithm}, {classes}")
    things, copies = list(lines.values())[-1][1]
    sizes = [things * 2.0**k for k in range(9)]
    guide = [copies * n * math.log(n) / (things * math.log(things)) for n in sizes]
    axes.loglog(sizes, guide, color="0.6", label="n log n")
    axes.set(xlabel="things", ylabel="copies of a 64 x 2048 cloud", title="Cost of a scan against its size")
    axes.grid(True, color="0.9")
    axes.legend()
    figure.savefig(sys.argv[1], dpi=150)


if __name__ == "__main__":
    main()
