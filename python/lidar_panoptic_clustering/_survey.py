"""The survey's algorithms with their published parameters."""
import threading
from typing import TYPE_CHECKING, Any, Dict, Optional, Tuple

if TYPE_CHECKING:
    import numpy
    from numpy.typing import ArrayLike, NDArray

    from ._core import Segmenter

_KEPT = 8  # segmenters a thread keeps, which remember their buffers
_of_thread = threading.local()


def cluster(points: 'ArrayLike', labels: 'ArrayLike', algorithm: str = 'scan_line_run', *,
            ring: 'Optional[ArrayLike]' = None, class_table: str = 'semantic_kitti',
            **parameters: Any) -> 'NDArray[numpy.uint32]':
    """The instance of each point, as Zhao, Zhang and Huang (ICCV workshops 2021) set the algorithms.

        instances = lidar_panoptic_clustering.cluster(points, labels, 'depth')

    points: (N, 3 or more) floats as KITTI's files have them, or (H, W, 3 or more); x y z [m].
    labels: (N,) or (H, W) integers, the class of each point by class_table.
    algorithm: 'euclidean' (distance_m 0.5), 'supervoxel' (voxel_m 0.5, seed_m 8, spatial_weight 1; normal_weight 0, or
        0.5 in the survey's second row), 'depth' (theta_deg 10) or 'scan_line_run' (run_distance_m 0.5, line_distance_m
        1); also 'birds_eye', with distance_m 0.5.
    ring: (N,) integers where the points come in another order.
    parameters: others than the survey's, by name, see parameters(algorithm).

    No class has a size and nothing is refined afterwards: what panoptic_benchmark --survey does. Segmenter is the same
    with this package's settings, which are better. Returns uint32 of the shape of labels: 0 for what is no thing, 1..n
    for things, hidden points included. Raises ValueError with what was expected and found.
    """
    return _segmenter(algorithm, class_table, parameters)(points, labels, ring=ring)


def _segmenter(algorithm: str, class_table: str, parameters: Dict[str, Any]) -> 'Segmenter':
    from . import _core
    kept: Dict[Tuple[Any, ...], 'Segmenter'] = _of_thread.__dict__.setdefault('segmenters', {})
    key = (algorithm, str(class_table), *sorted((name, str(value)) for name, value in parameters.items()))
    if key not in kept:
        made = _core.Segmenter(algorithm, class_table=class_table,
                               **{**_core.survey_parameters(algorithm), **parameters})
        while len(kept) >= _KEPT:
            del kept[next(iter(kept))]
        kept[key] = made
    return kept[key]
