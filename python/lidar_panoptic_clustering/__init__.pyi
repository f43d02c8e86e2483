from ._core import (
    GroundLabeler as GroundLabeler,
    LidarSimulator as LidarSimulator,
    PanopticQuality as PanopticQuality,
    Segmenter as Segmenter,
    SemanticKitti as SemanticKitti,
    Tracker as Tracker,
    __version__ as __version__,
    algorithms as algorithms,
    class_ids as class_ids,
    class_tables as class_tables,
    encode_labels as encode_labels,
    parameters as parameters,
    sensors as sensors,
    survey_parameters as survey_parameters,
)
from ._survey import cluster as cluster
