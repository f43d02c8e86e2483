# What help() says more of.
from os import PathLike
from typing import Any, Dict, List, Optional, Tuple, Union, overload

import numpy
from numpy.typing import ArrayLike, NDArray
from typing_extensions import Literal, Protocol, TypedDict

__version__: str

class _Array(Protocol):  # a Torch tensor, for example
    def __array__(self) -> Any: ...

Floats = Union[ArrayLike, _Array]
Integers = Union[ArrayLike, _Array]
Ids = NDArray[numpy.uint32]
Path = Union[str, 'PathLike[str]']
Algorithm = Literal['euclidean', 'supervoxel', 'depth', 'scan_line_run', 'birds_eye']
Layout = Literal['auto', 'organized', 'ring', 'beams', 'unfold', 'merged']
Orientation = Literal['auto', 'rows_are_rings', 'rows_are_firings']
FieldOfView = Literal['auto', 'full_turn', 'sector']
