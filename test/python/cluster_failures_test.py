"""The commands `benchmark` and `label` where workers, scans or the user end them."""
import json
import os
import pathlib
import signal
import time

import pytest
from cluster_runs import data, files, quality, run, slow, slow_report, start, wait_for, workers_of  # noqa: F401

pytest.importorskip('distributed', minversion='2022.12', reason="no Dask 'distributed' of 2022.12 or newer")


def test_a_killed_worker_costs_nothing(data, tmp_path, slow_report):
    process = start('benchmark', *slow(data), '--report', 'r.json', '--output', 'out', cwd=tmp_path)
    wait_for(lambda: len(files(tmp_path / 'out')) > 20)
    os.kill(workers_of(process)[0], signal.SIGKILL)
    assert process.poll() is None, 'it was killed in mid-run'
    out, err = process.communicate(timeout=300)
    assert process.returncode == 0, err
    assert quality(tmp_path / 'r.json') == quality(slow_report)


def test_a_worker_that_never_comes_back(data, tmp_path, slow_report):
    process = start('benchmark', *slow(data), '--report', 'r.json', '--output', 'out', '--patience', 6, cwd=tmp_path)
    wait_for(lambda: len(files(tmp_path / 'out')) > 20)
    stopped = workers_of(process)[0]
    os.kill(stopped, signal.SIGSTOP)
    assert process.poll() is None
    try:
        out, err = process.communicate(timeout=300)
    finally:
        try:
            os.kill(stopped, signal.SIGKILL)
        except ProcessLookupError:
            pass
    assert process.returncode == 0, err
    assert 'begun on another worker' in err
    assert quality(tmp_path / 'r.json') == quality(slow_report)


def test_ctrl_c_ends_with_the_figures_so_far(data, tmp_path):
    process = start('benchmark', *slow(data), '--report', 'r.json', '--output', 'out', cwd=tmp_path)
    wait_for(lambda: len(files(tmp_path / 'out')) > 20)
    os.killpg(process.pid, signal.SIGINT)  # as a terminal does: to every process
    out, err = process.communicate(timeout=300)
    assert process.returncode == 130, err
    assert 'interrupted; the figures are of the scans done by then' in err
    assert 'Traceback' not in err
    report = json.loads((tmp_path / 'r.json').read_text())
    assert report['interrupted'] is True
    scans = report['quality']['before_clustering']['scans']
    assert 0 < scans < 60
    assert len(report['times']['depth']['frames']) == scans
    assert 'interrupted' in out


def test_a_scan_that_cannot_be_read(data, tmp_path, benchmark):
    wrong = data / 'sequences/03/velodyne/000011.bin'
    wrong.write_bytes(b'half a point')
    wrong = data / 'sequences/08/velodyne/000004.bin'
    wrong.write_bytes(b'half a point')
    options = ['--dataset', data, '--columns', 512, '--algorithms', 'depth']
    status, out, err = run('benchmark', *options, '--workers', 2, '--scans-per-task', 3, '--report', 'r.json',
                           cwd=tmp_path)
    assert status == 1
    assert '03/velodyne/000011.bin' in err and 'Traceback' not in err, 'the first one is named'
    assert not (tmp_path / 'r.json').exists() and not (tmp_path / 'r.json.part').exists()
    benchmark(*options, '--keep-going', '--report', tmp_path / 'cpp.json')
    status, out, err = run('benchmark', *options, '--workers', 2, '--keep-going', '--report', 'r.json', cwd=tmp_path)
    assert status == 0, err
    assert 'skipped 03/000011' in err
    assert quality(tmp_path / 'r.json') == quality(tmp_path / 'cpp.json')


class StopsItsWorker:
    """A result that stops the first worker that hands it over."""

    def __init__(self, stopped):
        self.stopped = stopped

    def __reduce__(self):
        try:
            with open(self.stopped, 'x') as file:
                file.write(str(os.getpid()))
        except FileExistsError:
            return bytes, ()
        os.kill(os.getpid(), signal.SIGSTOP)
        return bytes, ()


def test_a_worker_that_ends_a_part_and_then_answers_no_more(tmp_path):
    """Its result is not waited for: another worker is given the part, and the others' results count meanwhile."""
    from lidar_panoptic_clustering import _cluster
    from lidar_panoptic_clustering._connect import Cluster, connect
    from lidar_panoptic_clustering._progress import Progress
    from lidar_panoptic_clustering._tasks import Part, Work

    stopped = str(tmp_path / 'stopped')

    def run_part(_, part):
        report = StopsItsWorker(stopped) if part.begin == 5 else b''
        return {'used': part.end - part.begin, 'resumed': 0, 'skipped': [], 'report': report}

    class Notes(Progress):
        def note(self, text):
            notes.append(text)

    taken, notes = [], []
    parts = [Part('00', scan, scan + 1, f'{scan:06}') for scan in range(20)]
    with pytest.MonkeyPatch.context() as patch, connect(Cluster(None, None, 2, None, 60.0)) as client:
        patch.setattr(_cluster, 'run_part', run_part)
        run_all = _cluster.Run(client, 'test', Work((), False, ''), False, 3.0, taken.append,
                               lambda scan, reason: None, lambda _, scan: f'{scan:06}')
        begin = time.monotonic()
        outcome = run_all.run(iter(parts), Notes('test', 20), lambda: False)
        seconds = time.monotonic() - begin
        os.kill(int(pathlib.Path(stopped).read_text()), signal.SIGKILL)
    assert outcome == (False, False, None)
    assert sum(result['used'] for result in taken) == 20
    assert any('begun on another worker' in note for note in notes), notes
    assert seconds < 25.0, 'before the scheduler gives the worker up, after 30 s'


@pytest.mark.parametrize('keep_going', [True, False])
def test_a_scan_that_kills_its_workers(keep_going):
    """Its task is divided until it is found."""
    import dask

    from lidar_panoptic_clustering import _cluster
    from lidar_panoptic_clustering._connect import Cluster, connect
    from lidar_panoptic_clustering._progress import Progress
    from lidar_panoptic_clustering._tasks import Part, Work

    def run_part(_, part):
        if part.begin <= 5 < part.end:
            os.kill(os.getpid(), signal.SIGKILL)
        return {'used': part.end - part.begin, 'resumed': 0, 'skipped': [], 'report': b''}

    taken, skipped = [], []
    parts = [Part('00', 0, 4, '000000'), Part('00', 4, 8, '000004'), Part('00', 8, 9, '000008')]
    with dask.config.set({'distributed.scheduler.allowed-failures': 0}), pytest.MonkeyPatch.context() as patch, \
            connect(Cluster(None, None, 2, None, 60.0)) as client:
        patch.setattr(_cluster, 'run_part', run_part)
        run_all = _cluster.Run(client, 'test', Work((), True, ''), keep_going, None, taken.append,
                               lambda scan, reason: skipped.append((scan, reason)), lambda _, scan: f'{scan:06}')
        outcome = run_all.run(iter(parts), Progress('test', 9), lambda: False)
    if keep_going:
        assert outcome == (False, False, None)
        assert sum(result['used'] for result in taken) == 8
        assert [scan for scan, _ in skipped] == ['00/000005']
        assert 'each worker that was given it ended' in skipped[0][1]
    else:
        assert outcome.interrupted and outcome.failure.startswith('00/000005: each worker that was given it ended')
        assert not skipped
