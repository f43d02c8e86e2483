"""Preloaded by the workers of a local cluster (Dask's ``preload``)."""

import signal
import threading
from typing import Any


def dask_setup(worker: Any) -> None:
    """Ctrl-C reaches every process of a terminal; it is the driver's to end the run."""
    if threading.current_thread() is threading.main_thread():
        signal.signal(signal.SIGINT, signal.SIG_IGN)
