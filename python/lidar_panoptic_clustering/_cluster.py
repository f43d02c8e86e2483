"""Runs the parts of a data set on the workers of a Dask cluster: in any order, each at least once, counted once."""

import itertools
import queue
import statistics
import time
import uuid
from typing import Any, Callable, Dict, Iterator, List, NamedTuple, Optional, Tuple

from ._connect import POLL_S, import_problem
from ._progress import Progress
from ._results import NO_PART, SCHEDULER_GONE, Results, holders
from ._tasks import Part, VersionMismatch, Work, describe_part, halves, run_part

AHEAD = 3  # tasks a worker's thread has waiting, so that it never waits for the driver
LEAST_AHEAD = 12  # and what all have together, so that tasks go out by several
COPIES = 3  # times a part is begun before it is given up
LEAST_PATIENCE_S = 60.0
WORKERS_EVERY_S = 2.0


class Outcome(NamedTuple):
    """How a run ended."""

    interrupted: bool
    """Some scans are missing."""
    lost: bool
    """The cluster went away; what was done by then counts."""
    failure: Optional[str]
    """What ended it, but for a signal."""


class _Flight:
    """A part on its way: the tasks begun for it, of which the first to end counts."""

    def __init__(self, order: int, part: Part, alone: bool) -> None:
        self.order, self.part, self.alone = order, part, alone
        self.futures: Dict[str, Any] = {}
        self.begun = 0
        self.since = time.monotonic()


class Run:
    """One run over all parts.

    Args:
        client: of ``distributed``.
        name: of the tasks, on the dashboard.
        work: what the tasks have in common.
        keep_going: a scan that ends its workers is skipped; else it ends the run. To find it, parts are divided.
        patience_s: after which a part is begun once more elsewhere; none: 20 times the usual, and at least a minute.
        take: is given each part's result, once, in any order.
        skip: is given the name of a scan that could not be used, and why.
        name_of: the name of a sequence's scan, from 0.
    """

    def __init__(
        self,
        client: Any,
        name: str,
        work: Work,
        keep_going: bool,
        patience_s: Optional[float],
        take: Callable[[Dict[str, Any]], None],
        skip: Callable[[str, str], None],
        name_of: Callable[[str, int], str],
    ) -> None:
        self._client, self._name, self._work, self._keep_going = client, name, work, keep_going
        self._patience_s, self._take, self._skip, self._name_of = patience_s, take, skip, name_of
        self._id = uuid.uuid4().hex[:8]
        self._flights: Dict[int, _Flight] = {}
        self._ended: "queue.Queue[Tuple[int, str]]" = queue.Queue()
        self._results = Results(client, lambda order, key: self._ended.put((order, key)))
        self._again: List[Part] = []
        self._suspects: List[Part] = []  # of one scan: it, or what was on the same worker, ended the worker
        self._order = 0
        self._window = 1
        self._looked = 0.0
        self._seen_workers = time.monotonic()
        self._durations: List[float] = []
        self._failure: Optional[Tuple[int, str]] = None  # of which part, NO_PART for the cluster itself

    def run(self, parts: Iterator[Part], progress: Progress, stopped: Callable[[], bool]) -> Outcome:
        """Until all parts are done, one failed, or ``stopped()``. What is on its way by then is given up."""
        try:
            while not stopped():
                self._look_at_workers()
                self._begin_parts(parts)
                if not self._flights:
                    break
                self._collect(progress)
                self._begin_again(progress)
                # the first of the failed parts is told of, however many workers there are
                if self._failure is not None and all(f.order > self._failure[0] for f in self._flights.values()):
                    break
        finally:
            self._results.cancel()
            self._cancel([future for flight in self._flights.values() for future in flight.futures.values()])
            self._flights.clear()
        order, reason = self._failure or (0, None)
        return Outcome(stopped() or reason is not None, order < 0, reason)

    def _cancel(self, futures: List[Any]) -> None:
        if futures and self._client.status == "running":
            try:
                self._client.cancel(futures, force=True)
            except SCHEDULER_GONE:
                pass  # the scheduler is gone, and they with it

    def _look_at_workers(self) -> None:
        now = time.monotonic()
        if now - self._looked < WORKERS_EVERY_S:
            return
        self._looked = now
        status, threads = self._client.status, sum(self._threads().values())
        if threads > 0:
            self._seen_workers, self._window = now, max(AHEAD * threads, LEAST_AHEAD)
        elif now - self._seen_workers > self._patience():
            what = "no worker is left" if status == "running" else f"the scheduler is gone (connection {status})"
            self._fail(NO_PART, f"{what} since {now - self._seen_workers:.0f} s")

    def _threads(self) -> Dict[str, int]:
        """By worker; none where the scheduler is gone."""
        try:
            return dict(self._client.nthreads()) if self._client.status == "running" else {}
        except SCHEDULER_GONE:
            return {}

    def _begin_parts(self, parts: Iterator[Part]) -> None:
        """Several at a time, which costs the scheduler little more than one."""
        if self._failure is not None or 4 * len(self._flights) > 3 * self._window:
            return
        begun = []
        while len(self._flights) < self._window:
            upcoming = [self._again.pop()] if self._again else list(itertools.islice(parts, 1))
            alone = not upcoming and not self._flights and bool(self._suspects)
            if alone:
                upcoming = [self._suspects.pop(0)]
            if not upcoming:
                break
            flight = _Flight(self._order, upcoming[0], alone)
            self._order += 1
            self._flights[flight.order] = flight
            begun.append(flight)
        if begun:
            self._submit(begun, None)

    def _submit(self, flights: List[_Flight], workers: Optional[List[str]]) -> None:
        keys = []
        for flight in flights:
            flight.begun += 1
            flight.since = time.monotonic()
            name = f"{self._name}-{flight.part.sequence}:{flight.part.begin}-{flight.part.end - 1}"
            keys.append(f"{name}-{self._id}-{flight.order}-{flight.begun}")
        futures = self._client.map(
            run_part, [self._work] * len(flights), [flight.part for flight in flights], key=keys, pure=False,
            workers=workers, priority=-flights[0].order,
        )
        for flight, key, future in zip(flights, keys, futures):
            flight.futures[key] = future
            future.add_done_callback(lambda _, order=flight.order, key=key: self._ended.put((order, key)))

    def _collect(self, progress: Progress) -> None:
        ended: List[Tuple[int, str]] = []
        try:
            ended.append(self._ended.get(timeout=POLL_S))
            while True:
                ended.append(self._ended.get_nowait())
        except queue.Empty:
            pass
        for order, key in ended:
            flight = self._flights.get(order)
            future = flight.futures.get(key) if flight else None
            if flight is None or future is None:
                continue  # a copy of a part that is done
            if future.status == "finished":
                self._results.add(order, future)
            elif future.status == "error":
                self._judge(flight, key, future, progress)
            else:
                self._fail(NO_PART, f"the scheduler is gone, or gave up a task ({future.status}: {key})")
        self._finish(progress)

    def _finish(self, progress: Progress) -> None:
        """Counts the results that came."""
        try:
            fetched = self._results.fetched(lambda order: order in self._flights)
        except SCHEDULER_GONE as error:
            self._fail(NO_PART, f"the scheduler is gone ({type(error).__name__} {error})")
            return
        for order, result in fetched:
            flight = self._flights.get(order)
            if flight is None:
                continue
            self._durations = self._durations[-99:] + [time.monotonic() - flight.since]
            self._drop(flight)
            for scan, reason in result["skipped"]:
                progress.note(f"skipped {scan}: {reason}")
                self._skip(scan, reason)
            self._take(result)
            progress.step(flight.part.end - flight.part.begin)

    def _drop(self, flight: _Flight) -> None:
        del self._flights[flight.order]
        if len(flight.futures) > 1:
            self._cancel(list(flight.futures.values()))
        flight.futures.clear()

    def _judge(self, flight: _Flight, key: str, future: Any, progress: Progress) -> None:
        from distributed.scheduler import KilledWorker

        error = future.exception()
        part = flight.part
        if isinstance(error, KilledWorker):
            reason = f"{describe_part(part)}: each worker that was given it ended (killed, out of memory, or crashed)"
            self._drop(flight)
            self._divide(flight, reason, progress)
        elif isinstance(error, VersionMismatch):
            self._fail(flight.order, f"a worker cannot take part: {error}")
        elif isinstance(error, ImportError):
            self._fail(flight.order, f"a worker cannot take part: {import_problem(error)}")
        else:
            flight.futures.pop(key)
            self._drop(flight)
            self._fail(flight.order, str(error))

    def _divide(self, flight: _Flight, reason: str, progress: Progress) -> None:
        """What to do with a part that no worker ends: a scan is only found guilty where nothing ran beside it."""
        part = flight.part
        if part.end - part.begin > 1 and not self._work.track:
            progress.note(f"divided: {reason}")
            self._again.extend(reversed(halves(part, self._name_of)))
        elif not flight.alone:
            self._suspects.append(part)
        elif self._keep_going:
            progress.note(f"skipped {reason}")
            self._skip(f"{part.sequence}/{part.name}", reason)
            progress.step(part.end - part.begin)
        else:
            self._fail(flight.order, reason)

    def _begin_again(self, progress: Progress) -> None:
        """A part that its worker does not end is given to another one too: the machine may be gone, or its disk."""
        now, patience = time.monotonic(), self._patience()
        late = [flight for flight in self._flights.values() if now - flight.since > patience]
        if not late or self._client.status != "running":
            return
        try:
            holding = {key: worker for worker, keys in self._client.processing().items() for key in keys}
            # a worker may have ended it, and not hand the result over
            holding.update(holders(self._client, [future for flight in late for future in flight.futures.values()]))
        except SCHEDULER_GONE:
            return
        workers = set(self._threads())
        for flight in late:
            silent = {holding[key] for key in flight.futures if key in holding}
            flight.since = now
            if not silent or not workers - silent:
                continue  # it waits for its turn, or there is nobody else
            if flight.begun >= COPIES:
                reason = f"{describe_part(flight.part)}: {COPIES} workers did not end it, {patience:.0f} s each"
                self._drop(flight)
                self._divide(flight, reason, progress)
                continue
            progress.note(
                f"{describe_part(flight.part)}: begun on another worker, {', '.join(sorted(silent))} has not ended it "
                f"after {patience:.0f} s"
            )
            self._submit([flight], sorted(workers - silent))

    def _patience(self) -> float:
        if self._patience_s is not None:
            return self._patience_s
        if self._work.track:  # a task may be minutes, and the first is no measure of the next
            return 86400.0 if not self._durations else max(LEAST_PATIENCE_S, 20.0 * max(self._durations))
        return max(LEAST_PATIENCE_S, 20.0 * statistics.median(self._durations or [0.0]))

    def _fail(self, order: int, reason: str) -> None:
        if self._failure is None or order < self._failure[0]:
            self._failure = (order, reason)
