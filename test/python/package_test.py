"""The package itself: its stubs, its help, and the messages beside it."""
import ast
import inspect
import os
import pathlib
import subprocess
import sys

import pytest

import lidar_panoptic_clustering as lpc

ROOT = pathlib.Path(__file__).resolve().parents[2]
SOURCE = ROOT / 'python' / 'lidar_panoptic_clustering'
OF_COMMANDS = {'BenchmarkPlan', 'BenchmarkSum', 'SequenceBenchmark'}  # what python3 -m works with, no part of the package
EXAMPLE = '''
import numpy as np
import lidar_panoptic_clustering as lpc

points = np.zeros((5, 4), np.float32)
labels = np.full(5, 10, np.uint16)
segmenter = lpc.Segmenter('scan_line_run', class_table='semantic_kitti', min_points=1, max_line_gap=2)
ids = segmenter(points, labels)
ids = segmenter(points, labels, ring=np.zeros(5, np.uint8))
instances, voted = segmenter(points, labels, return_labels=True)
reveal_type(ids.dtype)
largest: int = int(segmenter.objects['points'].max())
tracks = lpc.Tracker(max_missed_s=1.0)(points, voted, instances, time_s=0.1, pose=np.eye(4))
quality = lpc.PanopticQuality()
quality.add(lpc.encode_labels(voted, instances), labels)
quality += lpc.PanopticQuality(min_points=50)
pq: float = quality.figures()['pq']
kitti = lpc.SemanticKitti('/data', semantics='')
for scan in kitti.scans('08'):
    survey = lpc.cluster(kitti.points('08', scan), kitti.classes('08', scan), 'depth', theta_deg=5)
height: float = lpc.GroundLabeler(structure='strict').ground['sensor_height_m']
version: str = lpc.__version__
'''


def stub_names(tree):
    """{class or function: {parameter, ..}} of a stub, methods as Class.method."""
    found = {}
    for node in tree.body:
        if isinstance(node, ast.FunctionDef):
            found[node.name] = {a.arg for a in node.args.args + node.args.kwonlyargs}
        if isinstance(node, ast.ClassDef) and not node.name.startswith('_'):
            found[node.name] = set()
            for item in node.body:
                if isinstance(item, ast.FunctionDef):
                    names = {a.arg for a in item.args.args + item.args.kwonlyargs} - {'self'}
                    found.setdefault(f'{node.name}.{item.name}', set()).update(names)
    return found


def test_stubs_are_complete():
    stubs = stub_names(ast.parse((SOURCE / '_core.pyi').read_text()))
    import lidar_panoptic_clustering._core as core
    public = {name for name in dir(core) if not name.startswith('_')} - OF_COMMANDS
    assert {name for name in stubs if '.' not in name} - OF_COMMANDS == public == lpc._CORE
    assert set(lpc.__all__) == public | {'cluster'}
    for name in public:
        if inspect.isclass(getattr(core, name)):
            # what pickling and comparing need is no more than object has
            members = {m for m in vars(getattr(core, name)) if not m.startswith('_')} | {'__init__'}
            members |= {'__call__'} & set(vars(getattr(core, name)))
            own = {n.partition('.')[2] for n in stubs if n.startswith(name + '.')} - {'__iadd__'}
            assert own == members, name


def test_stubs_have_every_parameter():
    stubs = stub_names(ast.parse((SOURCE / '_core.pyi').read_text()))
    known = {name for algorithm in lpc.algorithms() for name in lpc.parameters(algorithm)}
    assert stubs['Segmenter.__init__'] == known | {'algorithm'}
    for name, cls in (('Tracker', lpc.Tracker), ('GroundLabeler', lpc.GroundLabeler)):
        with pytest.raises(ValueError) as error:
            cls(no_such_parameter=1)
        listed = set(str(error.value).partition('there are: ')[2].split(', '))
        assert stubs[name + '.__init__'] == listed


def test_an_example_passes_strict_type_checking(tmp_path):
    pytest.importorskip('mypy')
    pytest.importorskip('numpy', minversion='1.20', reason='numpy has types from 1.20 on')
    (tmp_path / 'example.py').write_text(EXAMPLE)
    environment = {**os.environ, 'MYPYPATH': str(SOURCE.parent)}
    environment.pop('PYTHONPATH', None)
    done = subprocess.run([sys.executable, '-m', 'mypy', '--strict', '--cache-dir', str(tmp_path / 'cache'),
                           'example.py'], cwd=str(tmp_path), env=environment, stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, universal_newlines=True)
    assert done.returncode == 0, done.stdout
    assert 'unsignedinteger' in done.stdout or 'uint32' in done.stdout  # the type that was asked for


def test_help_says_shapes_units_errors_and_sources():
    for name in lpc.__all__:
        text = inspect.getdoc(getattr(lpc, name))
        assert text and len(text) > 20, name
    assert 'ValueError' in lpc.Segmenter.__doc__ and 'Bogoslavskyi' in lpc.Segmenter.__doc__
    for word in ('(N, 3 or more)', '[m]', 'ValueError', 'Linear'):
        assert word in lpc.Segmenter.__call__.__doc__
    text = subprocess.run([sys.executable, '-c', 'import lidar_panoptic_clustering as lpc; help(lpc)'],
                          stdout=subprocess.PIPE, universal_newlines=True).stdout
    for name in lpc.__all__:
        assert name in text


def test_version_is_the_package_s():
    cmake = (ROOT / 'CMakeLists.txt').read_text()
    assert f'VERSION {lpc.__version__} ' in cmake


def test_unknown_names_are_named():
    with pytest.raises(AttributeError, match='Segmentor'):
        lpc.Segmentor
    with pytest.raises(ImportError):
        from lidar_panoptic_clustering import Segmentor  # noqa: F401


def run(code, **environment):
    return subprocess.run([sys.executable, '-c', code], env={**os.environ, **environment}, stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, universal_newlines=True)


def test_messages_and_segmenter_are_one_package(tmp_path):
    if os.environ.get('LIDAR_PANOPTIC_WORKSPACE') != '1':
        pytest.skip('no workspace')
    both = '''
import lidar_panoptic_clustering as lpc
from lidar_panoptic_clustering.msg import Object, ObjectArray
from lidar_panoptic_clustering.cfg import DepthClusterConfig
print(lpc.Segmenter(), Object(track_id=3).track_id)
'''
    done = run(both)
    assert done.returncode == 0 and done.stdout.strip() == "Segmenter('birds_eye') 3", done.stdout

    # a wheel before the workspace, and behind it: its extension may be for this Python alone, the messages are not its
    core = pathlib.Path(sys.modules['lidar_panoptic_clustering._core'].__file__)
    wheel = tmp_path / 'lidar_panoptic_clustering'
    wheel.mkdir()
    (wheel / core.name).symlink_to(core)
    for file in SOURCE.glob('*.py*'):
        (wheel / file.name).write_bytes(file.read_bytes())
    path = os.environ['PYTHONPATH']
    for order in (f'{tmp_path}:{path}', f'{path}:{tmp_path}'):
        done = run(both, PYTHONPATH=order)
        assert done.returncode == 0 and done.stdout.strip() == "Segmenter('birds_eye') 3", done.stdout


def test_messages_do_without_the_extension(tmp_path):
    package = tmp_path / 'lidar_panoptic_clustering'
    package.mkdir()
    (package / '__init__.py').write_bytes((SOURCE / '__init__.py').read_bytes())
    (package / 'msg.py').write_text('Object = 1')
    code = '''
from lidar_panoptic_clustering.msg import Object
import sys, lidar_panoptic_clustering
assert 'numpy' not in sys.modules
lidar_panoptic_clustering.Segmenter
'''
    done = subprocess.run([sys.executable, '-S', '-c', code], env={**os.environ, 'PYTHONPATH': str(tmp_path)},
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT, universal_newlines=True)
    assert 'ImportError: the extension' in done.stdout and 'pip install .' in done.stdout, done.stdout
