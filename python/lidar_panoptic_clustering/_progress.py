"""Progress of a long run on stderr."""

import sys
import time
from typing import TextIO


class Progress:
    """On a terminal one bar with rate and time left, else a plain line every ten percent."""

    def __init__(self, what: str, total: int, out: TextIO = sys.stderr) -> None:
        self._what, self._total, self._out = what, total, out
        self._done = 0
        self._terminal = out.isatty()
        self._begin, self._drawn, self._shown = time.monotonic(), 0.0, False

    def step(self, count: int) -> None:
        """So many more are done."""
        before, self._done = self._done, self._done + count
        now = time.monotonic()
        if self._terminal:
            if now - self._drawn >= 0.1 or self._done >= self._total:
                self._drawn, self._shown = now, True
                filled = 30 * self._done // max(1, self._total)
                self._out.write(f"\r{self._what} [{'#' * filled:30}] {self._summary()}\x1b[K")
                self._out.flush()
        elif 10 * self._done // max(1, self._total) != 10 * before // max(1, self._total):
            print(f"{self._what}: {self._summary()}", file=self._out, flush=True)

    def note(self, line: str) -> None:
        """A line of its own."""
        self.finish()
        print(line, file=self._out, flush=True)

    def finish(self) -> None:
        """Ends the bar's line."""
        if self._shown:
            self._out.write("\r\x1b[K")
            self._out.flush()
        self._shown = False

    def _summary(self) -> str:
        rate = self._done / max(1e-6, time.monotonic() - self._begin)
        left = round((self._total - min(self._done, self._total)) / max(rate, 1e-9))
        minutes, seconds = divmod(left, 60)
        return f"{self._done}/{self._total}, {rate:.1f} a second, {minutes}:{seconds:02d} left"
