"""What all charts share: a page with title, subtitle, legend and one pair of axes, laid out by measured texts."""

import os
from typing import Any, List, Mapping, Optional, Sequence, Tuple

INK, FAINT_INK, GRID = "#1f2933", "#5b6770", "#dde2e7"
# Okabe and Ito's palette, which colour-blind readers can tell apart
PALETTE = ("#0072b2", "#e69f00", "#009e73", "#d55e00", "#cc79a7", "#56b4e9", "#f0e442", "#000000")
MARKERS = "os^Dvx*P"
DPI = 100
STYLE = {
    "font.family": "DejaVu Sans",
    "font.size": 13.0,
    "text.color": INK,
    "axes.labelcolor": INK,
    "axes.edgecolor": FAINT_INK,
    "axes.axisbelow": True,
    "axes.grid": True,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.spines.left": False,
    "grid.color": GRID,
    "xtick.color": FAINT_INK,
    "ytick.color": FAINT_INK,
    "xtick.labelsize": 13.0,
    "svg.hashsalt": "lidar_panoptic_clustering",  # the same report gives the same file
}


def color_of(index: int) -> Any:
    """Of a series; after the palette its lighter half, and again."""
    from matplotlib.colors import to_rgb

    color = to_rgb(PALETTE[index % len(PALETTE)])
    return color if (index // len(PALETTE)) % 2 == 0 else tuple(0.5 + 0.5 * part for part in color)


def marker_of(index: int) -> str:
    """Of a series."""
    return MARKERS[index % len(MARKERS)]


def wrapped(name: str) -> str:
    """A category's name, a line a word."""
    return name.replace(", ", ",\n").replace(" ", "\n")


class Page:
    """A chart of 16:9, wider where it holds many bars."""

    def __init__(self, title: str, subtitle: str, bars: int = 0) -> None:
        import matplotlib
        from matplotlib.backends.backend_agg import FigureCanvasAgg
        from matplotlib.figure import Figure

        self._style = matplotlib.rc_context
        with self._style(STYLE):
            width = min(40.0, max(16.0, 0.14 * bars))
            self.figure = Figure(figsize=(width, 9.0), dpi=DPI, facecolor="white")
            FigureCanvasAgg(self.figure)
            self.axes = self.figure.add_subplot(1, 1, 1)
        self._left = 1.05 / width
        self.figure.text(0.35 / width, 0.965, title, size=20, weight="bold", va="top", color=INK)
        self.figure.text(0.35 / width, 0.917, subtitle, size=13, color=FAINT_INK, va="top")
        self._values: List[Tuple[Any, float]] = []  # texts and the widths they have [categories]
        self._categories: List[str] = []
        self._handles: Optional[List[Any]] = None

    def bars(self, categories: Sequence[str], series: Mapping[str, Sequence[float]], decimals: Optional[int]) -> None:
        """Grouped bars, one a series in each category; with `decimals` each value is written at its bar."""
        width = 0.8 / max(1, len(series))
        for index, (name, values) in enumerate(series.items()):
            places = [c + (index + 0.5) * width - 0.4 for c in range(len(categories))]
            if places:  # Matplotlib 3.1 cannot name bars that are none
                self.axes.bar(places, values, 0.94 * width, color=color_of(index), label=name)
            for place, value in zip(places, values):
                if decimals is not None:
                    self._write(place, value, f"{value:,.{decimals}f}", width)
        self._name(categories)

    def spans(
        self, categories: Sequence[str], series: Mapping[str, Sequence[Tuple[float, float]]], ends: Tuple[str, str]
    ) -> None:
        """On a logarithmic axis, from a full mark at the lower to an open one at the upper value, both written."""
        from matplotlib.lines import Line2D

        width = 0.8 / max(1, len(series))
        self._handles = []
        for index, (name, values) in enumerate(series.items()):
            color = color_of(index)
            for c, (low, high) in enumerate(values):
                if not 0.0 < low <= high:
                    continue  # nothing was measured
                place = c + (index + 0.5) * width - 0.4
                self.axes.plot([place, place], [low, high], color=color, linewidth=5.0, alpha=0.35, zorder=2)
                self.axes.plot([place], [low], "o", color=color, markersize=10, zorder=3)
                self.axes.plot([place], [high], "o", color=color, markerfacecolor="white", markersize=10, zorder=3)
                for value, above in ((low, False), (high, True)):
                    self._write(place, value, f"{value:,.2f}" if value < 10 else f"{value:,.1f}", width, above, 9.0)
            self._handles.append(Line2D([], [], color=color, linewidth=5.0, label=name))
        for face, end in ((FAINT_INK, ends[0]), ("white", ends[1])):
            self._handles.append(
                Line2D([], [], marker="o", linestyle="none", color=FAINT_INK, markerfacecolor=face, label=end)
            )
        self._name(categories)
        self.logarithmic()
        self.axes.margins(y=0.12)

    def logarithmic(self) -> None:
        """The y axis, with plain numbers."""
        from matplotlib.ticker import FuncFormatter

        self.axes.set_yscale("log")
        self.axes.tick_params(axis="y", which="minor", length=0)
        self.axes.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:,.10g}"))
        if not self._categories:
            self.axes.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:,.0f}"))

    def reference(self, value: float, text: str, right: bool = True) -> None:
        """A dashed line across, where the values come near it."""
        low, high = self.axes.get_ylim()
        if not low <= value <= 1.5 * high:
            return
        self.axes.axhline(value, color=FAINT_INK, linewidth=1.2, linestyle=(0, (5, 4)), zorder=1)
        self.axes.annotate(
            text, (1.0 if right else 0.005, value), (0, 4), self.axes.get_yaxis_transform(), "offset points",
            ha="right" if right else "left", va="bottom", size=12, color=FAINT_INK, zorder=5,
            bbox={"facecolor": "white", "alpha": 0.8, "edgecolor": "none", "pad": 1.0},
        )

    def divide(self, place: float, left: str, right: str) -> None:
        """A line between categories, with the names of both sides."""
        self.axes.axvline(place, color=FAINT_INK, linewidth=1.0)
        for text, offset, side in ((left, -8, "right"), (right, 8, "left")):
            self.axes.annotate(
                text, (place, 1.0), (offset, -2), self.axes.get_xaxis_transform(), "offset points",
                ha=side, va="top", size=13, color=FAINT_INK,
            )

    def save(self, path: str, kind: str) -> None:
        """Aside and renamed."""
        with self._style(STYLE):
            self._lay_out()
            part = f"{path}.{os.getpid()}.part"
            metadata = {"Date": None} if kind == "svg" else None
            try:
                self.figure.savefig(part, format=kind, dpi=DPI, metadata=metadata)
                os.replace(part, path)
            except OSError as error:
                if os.path.exists(part):
                    os.remove(part)
                raise OSError(f"cannot write {path}: {error.strerror or error}") from None

    def _write(
        self, place: float, value: float, text: str, width: float, above: bool = True, gap: float = 3.0
    ) -> None:
        label = self.axes.annotate(
            text, (place, value), (0, gap if above else -gap), "data", "offset points",
            ha="center", va="bottom" if above else "top", size=12, zorder=4,
        )
        self._values.append((label, width))

    def _name(self, categories: Sequence[str]) -> None:
        self._categories = list(categories)
        self.axes.set_xticks(range(len(categories)))
        self.axes.set_xticklabels([wrapped(name) for name in categories], color=INK)
        self.axes.set_xlim(-0.5, max(1, len(categories)) - 0.5)
        self.axes.tick_params(axis="x", length=0, pad=8)
        self.axes.grid(False, axis="x")

    def _lay_out(self) -> None:
        """What is free for the plot follows from the sizes of the texts around it, as they are drawn."""
        height = self.figure.bbox.height
        self.figure.subplots_adjust(left=self._left, right=1.0 - 0.35 * self._left, top=0.85, bottom=0.12)
        renderer = self.figure.canvas.get_renderer()
        slot = self.axes.get_window_extent(renderer).width / max(1, len(self._categories))
        legend = self._legend(renderer)
        top = 0.875 - (legend.get_window_extent(renderer).height / height + 0.01 if legend else 0.0)
        if legend:
            legend.set_bbox_to_anchor((self._left - 0.004, 0.885), transform=self.figure.transFigure)
        bottom = self._fit_names(renderer, slot) / height + (0.045 if self._categories else 0.1)
        self._fit_values(renderer, slot)
        self.figure.subplots_adjust(top=max(top, bottom + 0.1), bottom=bottom)
        highest = max((label.get_window_extent(renderer).y1 for label, _ in self._values), default=0.0)
        above = (highest - self.axes.get_window_extent(renderer).y1) / height  # values of bars that reach the top
        if above > 0.0:
            self.figure.subplots_adjust(top=max(top - above, bottom + 0.1))

    def _legend(self, renderer: Any) -> Any:
        """As many names in a line as fit; none for a single series."""
        handles = self._handles or self.axes.get_legend_handles_labels()[0]
        room = 0.96 * self.figure.bbox.width
        length = 1.0 if self._handles is None else 1.4
        size = 13 if len(handles) < 25 else 10
        self.figure.legends.clear()
        if len(handles) < 2:
            return None
        for columns in range(len(handles), 0, -1):
            self.figure.legends.clear()
            legend = self.figure.legend(
                handles=handles, loc="upper left", ncol=columns, frameon=False, borderpad=0.0, borderaxespad=0.0,
                handlelength=length, columnspacing=1.6, fontsize=size,
            )
            if legend.get_window_extent(renderer).width <= room:
                break
        return legend

    def _fit_names(self, renderer: Any, slot: float) -> float:
        """Names of categories side by side, else slanted. Returns their height [px]."""
        labels = self.axes.get_xticklabels()
        if not self._categories:
            return 0.0
        if max(label.get_window_extent(renderer).width for label in labels) > 0.96 * slot:
            self.axes.set_xticklabels(self._categories, color=INK)
            labels = self.axes.get_xticklabels()
            for label in labels:
                label.set(rotation=35, ha="right", rotation_mode="anchor")
        return float(max(label.get_window_extent(renderer).height for label in labels))

    def _fit_values(self, renderer: Any, slot: float) -> None:
        """Values as large as fit above their bars, else upright."""
        widest = max((label.get_window_extent(renderer).width / width for label, width in self._values), default=0.0)
        if widest <= 0.0:
            return
        shrunk = 12.0 * slot / widest
        upright = shrunk < 9.0
        for label, _ in self._values:
            label.set(size=min(11.0, max(5.0, 2.2 * shrunk)) if upright else min(12.0, shrunk), rotation=90 * upright)
