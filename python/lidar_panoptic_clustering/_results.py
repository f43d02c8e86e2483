"""Fetches the results of tasks that ended from the workers of a Dask cluster, and waits for none of them."""

import asyncio
import time
from concurrent.futures import CancelledError, Future
from typing import Any, Callable, Dict, List, Tuple

FETCH_S = 2.0  # after which results are fetched worker by worker
NO_PART = -1  # in place of a part's order
EVERY_WORKER = ""  # in place of an address
SCHEDULER_GONE = (OSError, asyncio.CancelledError, CancelledError)
"""What a client's calls raise where there is no scheduler any more."""


def holders(client: Any, futures: List[Any]) -> Dict[str, str]:
    """A worker that has the result, by task; none for what is not done.

    Raises:
        SCHEDULER_GONE
    """
    return {key: workers[0] for key, workers in client.who_has(futures).items() if workers} if futures else {}


class _Fetch:
    """Results on their way, of the parts of these orders."""

    def __init__(self, futures: Dict[int, Any], response: "Future[Dict[str, Any]]") -> None:
        self.futures, self.response, self.since = futures, response, time.monotonic()


class Results:
    """Of tasks that ended, by the order of their part.

    Several are fetched at a time, which costs the scheduler little more than one. A worker may end a task and then
    answer no more: what does not come is fetched worker by worker, and from one that owes an answer nothing else is
    asked.

    Args:
        client: of ``distributed``.
        ended: is told of a task that is to be looked at, because it failed when it was begun anew; and of NO_PART when
            results came. May be called by another thread.
    """

    def __init__(self, client: Any, ended: Callable[[int, str], None]) -> None:
        self._client, self._ended = client, ended
        self._waiting: Dict[int, Any] = {}
        self._fetches: Dict[str, _Fetch] = {}  # by worker

    def add(self, order: int, future: Any) -> None:
        """Has the result of a task that ended fetched."""
        self._waiting[order] = future

    def fetched(self, is_wanted: Callable[[int], bool]) -> List[Tuple[int, Any]]:
        """What came since the last call, by order. What is not wanted any more is not asked for.

        Raises:
            SCHEDULER_GONE
        """
        came: List[Tuple[int, Any]] = []
        is_late = False
        for worker, fetch in list(self._fetches.items()):
            if fetch.response.done():
                del self._fetches[worker]
                response = fetch.response.result()
                if response["status"] == "OK":
                    came += [(order, response["data"][future.key]) for order, future in fetch.futures.items()]
                else:  # a worker ended before it handed its results over
                    self._waiting = {**fetch.futures, **self._waiting}
            elif worker == EVERY_WORKER and time.monotonic() - fetch.since > FETCH_S:
                is_late = True
                del self._fetches[worker]
                fetch.response.cancel()
                self._waiting = {**fetch.futures, **self._waiting}
        if EVERY_WORKER not in self._fetches:
            self._begin(self._take_ready(is_wanted), is_late or bool(self._fetches))
        return came

    def cancel(self) -> None:
        """Gives up what is on its way."""
        for fetch in self._fetches.values():
            fetch.response.cancel()

    def _take_ready(self, is_wanted: Callable[[int], bool]) -> Dict[int, Any]:
        ready: Dict[int, Any] = {}
        waiting, self._waiting = self._waiting, {}
        for order, future in waiting.items():
            if not is_wanted(order):
                continue
            if future.status == "finished":
                ready[order] = future
            elif future.status == "error":
                self._ended(order, future.key)
            else:  # its worker ended with the result, and the task was begun anew
                self._waiting[order] = future
        return ready

    def _begin(self, ready: Dict[int, Any], by_worker: bool) -> None:
        groups: Dict[str, Dict[int, Any]] = {}
        holder = holders(self._client, list(ready.values())) if by_worker else {}
        for order, future in ready.items():
            groups.setdefault(holder.get(future.key, EVERY_WORKER), {})[order] = future
        for worker, futures in groups.items():
            if worker in self._fetches:
                self._waiting.update(futures)
                continue
            # not Client.gather(), which makes one of several, and cancels all with one
            gathering = self._client.scheduler.gather(keys=[future.key for future in futures.values()])
            response = asyncio.run_coroutine_threadsafe(gathering, self._client.loop.asyncio_loop)
            response.add_done_callback(lambda _: self._ended(NO_PART, ""))
            self._fetches[worker] = _Fetch(futures, response)
