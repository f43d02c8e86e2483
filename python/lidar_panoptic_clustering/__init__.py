"""Objects from labelled lidar scans, by geometry alone: the C++ of lidar_panoptic_clustering from Python.

    import lidar_panoptic_clustering as lpc
    segmenter = lpc.Segmenter("scan_line_run", class_table="semantic_kitti")
    instances = segmenter(points, labels)      # (N, 3 or more) floats and (N,) integers -> (N,) uint32

Segmenter           classes in, instances out
cluster             the survey's algorithms with their published parameters, in one call
Tracker             ids that stay with an object from scan to scan
GroundLabeler       ground, structure and objects without a network
PanopticQuality     the official evaluator's figures
SemanticKitti       a data set's scans, labels and poses; writes predictions
LidarSimulator      scans with exact labels, without a data set
encode_labels       classes and instances as label files have them
algorithms, parameters, survey_parameters, class_tables, class_ids, sensors    what there is

Errors are ValueError, with what was expected and what was found. In a catkin workspace the package holds its messages
too (lidar_panoptic_clustering.msg).
"""
from pkgutil import extend_path

# A workspace and an installed wheel may each hold a part: messages there, the extension for this Python here.
__path__ = extend_path(__path__, __name__)

_CORE = {'GroundLabeler', 'LidarSimulator', 'PanopticQuality', 'Segmenter', 'SemanticKitti', 'Tracker', 'algorithms',
         'class_ids', 'class_tables', 'encode_labels', 'parameters', 'sensors', 'survey_parameters'}
__all__ = sorted(_CORE | {'cluster'})


def __getattr__(name):
    # The extension is loaded when it is first asked for: who only wants the messages needs neither it nor NumPy.
    if name == '__version__' or name in _CORE:
        return getattr(_extension(), name)
    if name == 'cluster':
        _extension()
        from ._survey import cluster
        return cluster
    raise AttributeError(f'module {__name__!r} has no attribute {name!r}')


def __dir__():
    return sorted(set(globals()) | set(__all__))


def _extension():
    from importlib import import_module
    try:
        return import_module(f'{__name__}._core')
    except ModuleNotFoundError as error:
        if error.name != f'{__name__}._core':
            raise
        import sys
        version = '.'.join(map(str, sys.version_info[:2]))
        raise ImportError(f'the extension of {__name__} is not built for Python {version}: looked for _core in '
                          f'{", ".join(__path__)}; run "pip install ." in a clone of the package') from None
