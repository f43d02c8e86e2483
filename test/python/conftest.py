"""Scans for the tests: simulated ones in the order of KITTI's files, a data set of them, and recorded ones."""
import os
import pathlib
import subprocess

import numpy as np
import pytest

import lidar_panoptic_clustering as lpc

ROWS = {  # of panoptic_benchmark's table: what a segmenter is made of
    'birds_eye': ('birds_eye', {}),
    'depth': ('depth', {}),
    'euclidean': ('euclidean', {}),
    'scan_line_run': ('scan_line_run', {}),
    'supervoxel': ('supervoxel', {}),
    'supervoxel normal_weight=0.5': ('supervoxel', {'normal_weight': 0.5}),
}


def in_file_order(points, *others):
    """The returns of an organised scan ring after ring, each from straight ahead counter-clockwise, as KITTI has them."""
    order = []
    for row, line in enumerate(points):
        columns = np.flatnonzero(np.isfinite(line[:, 0]))
        azimuth = np.arctan2(line[columns, 1], line[columns, 0]) % (2 * np.pi)
        order.append(row * points.shape[1] + columns[np.argsort(azimuth, kind='stable')])
    order = np.concatenate(order)
    return (points.reshape(-1, points.shape[-1])[order], *(other.reshape(-1)[order] for other in others))


@pytest.fixture(scope='session')
def organized():
    """points (H, W, 4), labels (H, W), instances (H, W)"""
    return lpc.LidarSimulator('hdl64e', seed=5).scan(3)


@pytest.fixture(scope='session')
def scan(organized):
    """points (N, 4), labels (N,), instances (N,)"""
    return in_file_order(*organized)


@pytest.fixture(scope='session')
def dataset(tmp_path_factory):
    """A folder with sequence 00 of six simulated scans, with poses and times."""
    root = tmp_path_factory.mktemp('dataset')
    folder = root / 'sequences' / '00'
    (folder / 'velodyne').mkdir(parents=True)
    (folder / 'labels').mkdir()
    simulator = lpc.LidarSimulator('hdl64e', seed=5)
    first = np.linalg.inv(simulator.pose(0))
    poses = []
    for frame in range(6):
        points, labels, instances = in_file_order(*simulator.scan(frame))
        points.tofile(folder / 'velodyne' / f'{frame:06}.bin')
        (labels | instances << 16).astype(np.uint32).tofile(folder / 'labels' / f'{frame:06}.label')
        poses.append((first @ simulator.pose(frame))[:3])
    lines = [' '.join(f'{number:.9e}' for number in pose.reshape(-1)) for pose in poses]
    (folder / 'poses.txt').write_text('\n'.join(lines) + '\n')
    (folder / 'calib.txt').write_text('Tr: 1 0 0 0 0 1 0 0 0 0 1 0\n')
    (folder / 'times.txt').write_text('\n'.join(f'{0.1 * frame:e}' for frame in range(6)) + '\n')
    return root


@pytest.fixture(scope='session')
def recorded():
    """The folder of recorded scans of SemanticKITTI."""
    beside = pathlib.Path(__file__).resolve().parents[3] / 'shared' / 'data'
    folder = pathlib.Path(os.environ.get('LIDAR_PANOPTIC_DATA', str(beside))) / 'semantickitti'
    if not folder.is_dir():
        pytest.skip('no recorded scans (LIDAR_PANOPTIC_DATA)')
    return folder


@pytest.fixture(scope='session')
def benchmark():
    """Runs panoptic_benchmark of the same build with the arguments given."""
    program = os.environ.get('LIDAR_PANOPTIC_BENCHMARK', '')
    if not program:
        pytest.skip('no panoptic_benchmark to compare with (LIDAR_PANOPTIC_BENCHMARK)')

    def run(*arguments):
        done = subprocess.run([program, *map(str, arguments)], stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                              universal_newlines=True)
        assert done.returncode == 0, done.stdout
        return done.stdout
    return run


def label_files(folder):
    """What panoptic_benchmark wrote of a row: {(sequence, scan): labels}"""
    files = sorted(pathlib.Path(folder).glob('sequences/*/predictions/*.label'))
    assert files
    return {(f.parts[-3], f.stem): np.fromfile(f, np.uint32) for f in files}
