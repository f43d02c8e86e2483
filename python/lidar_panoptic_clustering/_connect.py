"""To a Dask cluster: one that is there, or processes of this machine."""

import os
import re
import time
from contextlib import contextmanager
from typing import Any, Iterator, NamedTuple, Optional

from ._tasks import package_version

MISSING = (
    "a cluster needs Dask's 'distributed': apt-get install python3-distributed, or pip install distributed "
    "(panoptic_benchmark does the same on one machine without it)"
)
LOCAL_TTL = "30 s"  # after which a worker of a local cluster that says nothing is given up
POLL_S = 0.2
LEAST_VERSION = [2022, 12]


class ClusterError(RuntimeError):
    """What ended a run, with what to do about it."""


class Cluster(NamedTuple):
    """Where to run."""

    scheduler: Optional[str]
    """Address, ``tcp://head:8786``; none for a cluster of this machine's processes."""
    scheduler_file: Optional[str]
    """A file that ``dask scheduler --scheduler-file`` wrote, instead of the address."""
    workers: int
    """Processes of the local cluster."""
    dashboard: Optional[str]
    """Address of the local cluster's dashboard, ``:8787``."""
    wait_s: float
    """How long a scheduler, or a first worker, is waited for."""


@contextmanager
def connect(cluster: Cluster) -> Iterator[Any]:
    """A ``distributed.Client``; a local cluster ends with it.

    Raises:
        ClusterError: where there is no Dask, no scheduler or no worker, or a worker is of another version.
    """
    try:
        import dask
        import distributed
    except ImportError as error:
        raise ClusterError(f"{MISSING} ({error})") from None
    dask_distributed: Any = distributed  # which has no types
    if [int(number) for number in re.findall(r"\d+", dask_distributed.__version__)[:2]] < LEAST_VERSION:
        raise ClusterError(f"distributed is {dask_distributed.__version__}, expected 2022.12 or newer")
    if cluster.scheduler is None and cluster.scheduler_file is None:
        os.environ.setdefault("DASK_LOGGING__DISTRIBUTED", "error")  # of the workers; what matters comes back as errors
        settings = {
            "distributed.scheduler.worker-ttl": LOCAL_TTL,
            "distributed.worker.multiprocessing-method": "spawn",
            "distributed.admin.tick.limit": "60 s",  # a busy machine is not worth a warning
        }
        with dask.config.set(settings):
            local = dask_distributed.LocalCluster(
                n_workers=cluster.workers,
                threads_per_worker=1,
                processes=True,
                memory_limit=0,
                dashboard_address=cluster.dashboard,
                silence_logs=50,
                preload="lidar_panoptic_clustering._worker",
            )
            with local, dask_distributed.Client(local) as client:
                yield client
        return
    where = cluster.scheduler or f"the scheduler of {cluster.scheduler_file}"
    try:
        client = dask_distributed.Client(
            address=cluster.scheduler, scheduler_file=cluster.scheduler_file, timeout=cluster.wait_s
        )
    except (OSError, ValueError) as error:
        raise ClusterError(
            f"no Dask scheduler answers at {where} within {cluster.wait_s:g} s ({error or type(error).__name__}); "
            "one is started by 'dask scheduler' (before Dask 2022: dask-scheduler)"
        ) from None
    with client:
        require_workers(client, cluster.wait_s)
        yield client


def require_workers(client: Any, wait_s: float) -> None:
    """Waits for a first worker and looks at what all that are there run.

    Raises:
        ClusterError: where none comes, or one has not this package, or another version of it.
    """
    begin = time.monotonic()
    while not client.nthreads():
        if time.monotonic() - begin > wait_s:
            raise ClusterError(
                f"the scheduler at {client.scheduler.address} has no worker after {wait_s:g} s; one is started by "
                f"'dask worker {client.scheduler.address}' (before Dask 2022: dask-worker)"
            )
        time.sleep(POLL_S)
    expected = package_version()
    found = client.run(package_version, on_error="return")
    wrong = {worker: version for worker, version in found.items() if version != expected}
    if wrong:
        worker, version = sorted(wrong.items())[0]
        raise ClusterError(
            f"{len(wrong)} of {len(found)} workers cannot take part; {worker}: "
            + (import_problem(version) if isinstance(version, Exception) else f"lidar_panoptic_clustering {version}")
            + f", expected lidar_panoptic_clustering {expected} as here"
        )


def import_problem(error: BaseException) -> str:
    """Of a worker without this package, or with one it cannot load."""
    return f"it cannot load this package ({type(error).__name__}: {error})"
