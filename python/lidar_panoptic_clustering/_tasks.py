"""What runs on a cluster's workers. Nothing here needs Dask, and the driver's arguments are all it knows."""

import threading
from typing import Any, Callable, Dict, List, NamedTuple, Optional, Tuple

_cache = threading.local()


class Work(NamedTuple):
    """What all tasks of a run have in common."""

    options: Tuple[Tuple[str, Tuple[str, ...]], ...]
    """Of panoptic_benchmark: names and values."""
    label: bool
    """Predictions alone."""
    version: str
    """Of this package where the run was started."""

    @property
    def track(self) -> bool:
        """Whether a part is a whole sequence."""
        return "track" in dict(self.options)


class Part(NamedTuple):
    """Scans of one sequence that a worker does in one go."""

    sequence: str
    begin: int
    end: int
    name: str
    """Of the first scan, for people."""


class VersionMismatch(Exception):
    """A worker runs another version of this package than the driver."""


def package_version() -> str:
    """Of the compiled part."""
    from . import _core

    return str(_core.__version__)


def run_part(work: Work, part: Part) -> Dict[str, Any]:
    """The task: as ``SequenceBenchmark.run``. Buffers and the sequence's list of scans last from task to task."""
    version = package_version()
    if version != work.version:
        raise VersionMismatch(f"lidar_panoptic_clustering {version}, expected {work.version} as where the run began")
    return dict(_benchmark_of(work, part.sequence).run(part.begin, part.end))


def _benchmark_of(work: Work, sequence: str) -> Any:
    from . import _core

    known: Optional[Tuple[Work, str, Any]] = getattr(_cache, "benchmark", None)
    if known is None or known[:2] != (work, sequence):
        _cache.benchmark = None  # the memory of the one before, first
        plan = _core.BenchmarkPlan(dict(work.options), work.label)
        _cache.benchmark = known = (work, sequence, _core.SequenceBenchmark(plan, sequence))
    return known[2]


def describe_part(part: Part) -> str:
    """For messages."""
    count = part.end - part.begin
    return f"{part.sequence}/{part.name}" if count == 1 else f"{count} scans from {part.sequence}/{part.name} on"


def halves(part: Part, name_of: Callable[[str, int], str]) -> List[Part]:
    """Of a part of two scans or more. ``name_of``: a sequence's scan."""
    middle = (part.begin + part.end) // 2
    return [
        Part(part.sequence, part.begin, middle, part.name),
        Part(part.sequence, middle, part.end, name_of(part.sequence, middle)),
    ]
