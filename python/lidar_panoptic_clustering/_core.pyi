# help() says more of each.
from os import PathLike
from typing import Any, Dict, List, Literal, Mapping, Optional, Protocol, Sequence, Tuple, TypedDict, Union, overload

import numpy
from numpy.typing import ArrayLike, NDArray

__version__: str

class _Tensor(Protocol):
    def __array__(self) -> Any: ...

_Array = Union[ArrayLike, _Tensor]
_Ids = NDArray[numpy.uint32]
_Path = Union[str, "PathLike[str]"]
_Algorithm = Literal['euclidean', 'supervoxel', 'depth', 'scan_line_run', 'birds_eye']
_Layout = Literal['auto', 'organized', 'ring', 'beams', 'unfold', 'merged']
_Orientation = Literal['auto', 'rows_are_rings', 'rows_are_firings']
_FieldOfView = Literal['auto', 'full_turn', 'sector']

class Segmenter:
    def __init__(
        self,
        algorithm: Union[_Algorithm, str] = ...,
        *,
        # labels
        class_table: _Path = ...,
        label_table: _Path = ...,
        max_unknown_labels: float = ...,
        # layout
        layout: _Layout = ...,
        orientation: _Orientation = ...,
        sensor: _Path = ...,
        rows: int = ...,
        columns: int = ...,
        # all algorithms
        max_range_m: float = ...,
        field_of_view: _FieldOfView = ...,
        class_policy: Literal['class', 'group', 'any'] = ...,
        link_distance_scale: float = ...,
        bridge_distance_m: float = ...,
        split: bool = ...,
        size_margin: float = ...,
        merge: bool = ...,
        vote: bool = ...,
        min_points: int = ...,
        # euclidean, birds_eye
        distance_m: float = ...,
        # euclidean, supervoxel
        voxel_m: float = ...,
        # supervoxel
        seed_m: float = ...,
        color_weight: float = ...,
        spatial_weight: float = ...,
        normal_weight: float = ...,
        # depth
        theta_deg: float = ...,
        max_gap_px: int = ...,
        max_distance_m: float = ...,
        # scan_line_run
        run_distance_m: float = ...,
        line_distance_m: float = ...,
        max_line_gap: int = ...,
        max_window_px: int = ...,
        # of an algorithm that is added
        **parameters: Any,
    ) -> None: ...
    @overload
    def __call__(
        self, points: _Array, labels: _Array, ring: Optional[_Array] = ..., return_labels: Literal[False] = ...
    ) -> _Ids: ...
    @overload
    def __call__(
        self, points: _Array, labels: _Array, ring: Optional[_Array] = ..., *, return_labels: Literal[True]
    ) -> Tuple[_Ids, _Ids]: ...
    @overload
    def __call__(
        self, points: _Array, labels: _Array, ring: Optional[_Array], return_labels: Literal[True]
    ) -> Tuple[_Ids, _Ids]: ...
    @property
    def objects(self) -> NDArray[numpy.void]: ...
    @property
    def algorithm(self) -> str: ...
    @property
    def parameters(self) -> Dict[str, Union[bool, int, float, str]]: ...

class Tracker:
    def __init__(
        self,
        *,
        class_table: _Path = ...,
        label_table: _Path = ...,
        max_unknown_labels: float = ...,
        max_missed_s: float = ...,
        vote_over_time: bool = ...,
        **parameters: Any,
    ) -> None: ...
    @overload
    def __call__(
        self,
        points: _Array,
        labels: _Array,
        instances: _Array,
        time_s: float,
        pose: Optional[_Array] = ...,
        return_labels: Literal[False] = ...,
    ) -> _Ids: ...
    @overload
    def __call__(
        self,
        points: _Array,
        labels: _Array,
        instances: _Array,
        time_s: float,
        pose: Optional[_Array] = ...,
        *,
        return_labels: Literal[True],
    ) -> Tuple[_Ids, _Ids]: ...
    @property
    def objects(self) -> NDArray[numpy.void]: ...
    def restart(self) -> None: ...

class GroundLabeler:
    def __init__(
        self,
        *,
        layout: _Layout = ...,
        orientation: _Orientation = ...,
        sensor: _Path = ...,
        rows: int = ...,
        columns: int = ...,
        max_range_m: float = ...,
        field_of_view: _FieldOfView = ...,
        ground_height_m: float = ...,
        max_slope: float = ...,
        link_m: float = ...,
        max_height_m: float = ...,
        max_length_m: float = ...,
        structure: Literal['strict', 'balanced', 'keep_objects'] = ...,
        **parameters: Any,
    ) -> None: ...
    def __call__(self, points: _Array, ring: Optional[_Array] = ...) -> _Ids: ...
    @property
    def ground(self) -> _Ground: ...

class _Ground(TypedDict):
    found: bool
    sensor_height_m: float
    slope_deg: float
    plane: Tuple[float, float, float]

class LidarSimulator:
    def __init__(
        self,
        sensor: str = ...,
        *,
        seed: int = ...,
        rate_hz: float = ...,
        speed_mps: float = ...,
        noise_scale: float = ...,
        dropout_scale: float = ...,
        traffic_density: float = ...,
        parking_density: float = ...,
        pedestrian_density: float = ...,
    ) -> None: ...
    def scan(self, frame: int) -> Tuple[NDArray[numpy.float32], _Ids, _Ids]: ...
    def pose(self, frame: int) -> NDArray[numpy.float64]: ...

class _ClassQuality(TypedDict):
    pq: float
    sq: float
    rq: float
    iou: float
    tp: int
    fp: int
    fn: int

class PanopticQuality:
    def __init__(self, class_table: _Path = ..., min_points: int = ...) -> None: ...
    def add(self, predicted: _Array, truth: _Array) -> None: ...
    def figures(self) -> Dict[str, float]: ...
    def classes(self) -> Dict[str, _ClassQuality]: ...
    @property
    def scans(self) -> int: ...
    def __iadd__(self, other: PanopticQuality) -> PanopticQuality: ...

class SemanticKitti:
    def __init__(
        self, dataset: _Path, semantics: _Path = ..., class_table: _Path = ..., label_table: _Path = ...
    ) -> None: ...
    @property
    def sequences(self) -> List[str]: ...
    @staticmethod
    def split(name: str) -> List[str]: ...
    def scans(self, sequence: str) -> List[str]: ...
    def points(self, sequence: str, scan: Union[str, int]) -> NDArray[numpy.float32]: ...
    def labels(self, sequence: str, scan: Union[str, int]) -> _Ids: ...
    def classes(self, sequence: str, scan: Union[str, int]) -> _Ids: ...
    def poses(self, sequence: str) -> NDArray[numpy.float64]: ...
    def times(self, sequence: str) -> NDArray[numpy.float64]: ...
    def write(
        self, output: _Path, sequence: str, scan: Union[str, int], labels: _Array, instances: _Array
    ) -> str: ...

def algorithms() -> List[str]: ...
def parameters(algorithm: str = ...) -> Dict[str, Dict[str, Any]]: ...
def survey_parameters(algorithm: str) -> Dict[str, Any]: ...
def class_tables() -> List[str]: ...
def class_ids(class_table: _Path = ...) -> Dict[str, List[int]]: ...
def sensors() -> List[str]: ...
def encode_labels(labels: _Array, instances: _Array, class_table: _Path = ...) -> _Ids: ...

# behind the commands `benchmark` and `label`
class BenchmarkPlan:
    def __init__(self, options: Mapping[str, Sequence[str]], label: bool = ...) -> None: ...
    @staticmethod
    def options() -> List[Tuple[str, str, str, int, str]]: ...
    @property
    def sequences(self) -> List[str]: ...
    @property
    def rows(self) -> List[str]: ...
    @property
    def track(self) -> bool: ...
    @property
    def keep_going(self) -> bool: ...

class SequenceBenchmark:
    def __init__(self, plan: BenchmarkPlan, sequence: str) -> None: ...
    def __len__(self) -> int: ...
    def scan_name(self, scan: int) -> str: ...
    @property
    def skipped(self) -> List[Tuple[str, str]]: ...
    def run(self, begin: int, end: int) -> Dict[str, Any]: ...

class BenchmarkSum:
    def __init__(self, plan: BenchmarkPlan) -> None: ...
    def add(self, report: bytes) -> None: ...
    def skip(self, scan: str, reason: str) -> None: ...
    def table(self, interrupted: bool, width: int) -> str: ...
    def json(self, interrupted: bool) -> bytes: ...
