"""For the tests of `benchmark` and `label`: a small data set, and commands on their way."""
import json
import os
import pathlib
import subprocess
import sys
import time

import numpy as np
import pytest

COMMAND = [sys.executable, '-m', 'lidar_panoptic_clustering']
CAR, ROAD = 10, 40


def write_scan(root, sequence, number, points=200):
    """Two cars side by side and a stretch of road, a little farther in each scan."""
    folder = root / 'sequences' / sequence
    for name in ('velodyne', 'labels'):
        (folder / name).mkdir(parents=True, exist_ok=True)
    third = points // 3
    y = np.concatenate([0.5 + 0.05 * np.arange(third), 5.0 + 0.05 * np.arange(third),
                        9.0 + 0.05 * np.arange(points - 2 * third)])
    scan = np.zeros((points, 4), np.float32)
    scan[:, 0], scan[:, 1] = 10.0 + 0.1 * (number % 50), y
    labels = np.repeat([7 << 16 | CAR, 8 << 16 | CAR, ROAD], [third, third, points - 2 * third]).astype(np.uint32)
    scan.tofile(folder / 'velodyne' / f'{number:06}.bin')
    labels.tofile(folder / 'labels' / f'{number:06}.label')
    return folder


def write_data(folder):
    """Sequences 03 and 08 of 30 scans each."""
    for sequence in ('03', '08'):
        for number in range(30):
            write_scan(folder / 'data', sequence, number)
    return folder / 'data'


@pytest.fixture
def data(tmp_path):
    """See write_data()."""
    return write_data(tmp_path)


def run(command, *arguments, cwd):
    """(exit status, stdout, stderr)"""
    done = subprocess.run([*COMMAND, command, *map(str, arguments)], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                          universal_newlines=True, cwd=str(cwd), timeout=300)
    return done.returncode, done.stdout, done.stderr


def quality(path):
    """All but the times."""
    report = json.loads(pathlib.Path(path).read_text())
    return report['quality'], report['rows'], report['interrupted']


def without_times(table):
    """The first columns of the table, up to the objects."""
    lines = table.splitlines()
    end = max(line.find(' clustering ') for line in lines) - 8
    return [line[:end].rstrip() for line in lines]


def files(folder):
    """All label files, by their way from the folder."""
    return {str(path.relative_to(folder)): path.read_bytes() for path in pathlib.Path(folder).rglob('*.label')}


def children(pid):
    """Processes below one, by id: {id: command line}"""
    found = {}
    for entry in pathlib.Path('/proc').glob('[0-9]*'):
        try:
            parent = int((entry / 'stat').read_text().rsplit(')', 1)[1].split()[1])
            if parent == pid:
                found[int(entry.name)] = (entry / 'cmdline').read_text().replace('\0', ' ')
        except (OSError, ValueError, IndexError):
            pass  # ended in the meantime
    return found


def start(command, *arguments, cwd):
    """A command on its way, in a session of its own."""
    return subprocess.Popen([*COMMAND, command, *map(str, arguments)], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                            universal_newlines=True, cwd=str(cwd), start_new_session=True)


def wait_for(condition, seconds=120):
    end = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < end, 'waited in vain'
        time.sleep(0.05)


def workers_of(process):
    """Ids of the local cluster's worker processes."""
    return [pid for pid, line in children(process.pid).items() if 'spawn_main' in line]


def slow(data):
    """Options of a run of some seconds, in tasks of a few scans: columns cost time."""
    return [*slow_scans(data), '--workers', 2, '--scans-per-task', 2]


def slow_scans(data):
    """Of both programs."""
    return ['--dataset', data, '--columns', 8192, '--algorithms', 'depth,birds_eye']


@pytest.fixture(scope='module')
def slow_report(tmp_path_factory, benchmark):
    """What panoptic_benchmark reports of slow_scans()."""
    folder = tmp_path_factory.mktemp('slow')
    benchmark(*slow_scans(write_data(folder)), '--report', folder / 'r.json')
    return folder / 'r.json'
