"""Commands and workers that are started apart, as on a cluster."""
import json
import os
import subprocess
import sys

import pytest
from cluster_runs import data, files, quality, run, slow_scans, start, wait_for  # noqa: F401

pytest.importorskip('distributed', minversion='2022.12', reason="no Dask 'distributed' of 2022.12 or newer")


@pytest.fixture
def scheduler(tmp_path):
    file = tmp_path / 'scheduler.json'
    process = subprocess.Popen([sys.executable, '-m', 'distributed.cli.dask_scheduler', '--port', '0',
                                '--no-dashboard', '--dashboard-address', ':0', '--scheduler-file', str(file)],
                               stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    wait_for(file.exists)
    yield process, file
    process.kill()
    process.wait()


def start_worker(file, cwd, **environment):
    return subprocess.Popen([sys.executable, '-m', 'distributed.cli.dask_worker', '--scheduler-file', str(file),
                             '--nthreads', '1', '--no-dashboard', '--death-timeout', '60'], cwd=str(cwd),
                            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                            env={**os.environ, **environment})


def test_workers_elsewhere(data, tmp_path, benchmark, scheduler):
    benchmark('--dataset', data, '--columns', 512, '--report', tmp_path / 'cpp.json')
    (tmp_path / 'elsewhere').mkdir()
    workers = [start_worker(scheduler[1], tmp_path / 'elsewhere') for _ in range(2)]
    try:
        status, _, err = run('benchmark', '--dataset', 'data', '--columns', 512, '--scheduler-file', scheduler[1],
                             '--report', 'r.json', '--scans-per-task', 5, cwd=tmp_path)
    finally:
        for worker in workers:
            worker.terminate()
            worker.wait()
    assert status == 0, err
    assert quality(tmp_path / 'r.json') == quality(tmp_path / 'cpp.json')


def test_without_a_worker(data, tmp_path, scheduler):
    status, _, err = run('benchmark', '--dataset', data, '--scheduler-file', scheduler[1], '--wait', 1,
                         cwd=tmp_path)
    assert status == 1
    assert 'has no worker after 1 s; one is started by' in err and 'Traceback' not in err


def refusal(data, tmp_path, scheduler, python_path):
    """What is said of a worker whose Python finds other packages."""
    worker = start_worker(scheduler[1], tmp_path, PYTHONPATH=python_path)
    try:
        status, _, err = run('benchmark', '--dataset', data, '--scheduler-file', scheduler[1], cwd=tmp_path)
    finally:
        worker.terminate()
        worker.wait()
    assert status == 1 and 'Traceback' not in err
    return err


def test_another_version(data, tmp_path, scheduler):
    other = tmp_path / 'other/lidar_panoptic_clustering'
    other.mkdir(parents=True)
    (other / '__init__.py').write_text('')
    (other / '_core.py').write_text('__version__ = "9.9.9"')
    (other / '_tasks.py').write_text('def package_version():\n    return "9.9.9"\n')
    err = refusal(data, tmp_path, scheduler, str(other.parent))
    assert '1 of 1 workers cannot take part' in err
    assert 'lidar_panoptic_clustering 9.9.9, expected lidar_panoptic_clustering ' in err


def test_without_the_package(data, tmp_path, scheduler):
    assert 'cannot load this package' in refusal(data, tmp_path, scheduler, '')


def test_a_scheduler_that_dies(data, tmp_path, scheduler):
    worker = start_worker(scheduler[1], tmp_path)
    try:
        process = start('benchmark', *slow_scans(data), '--scans-per-task', 2, '--output', 'out',
                        '--scheduler-file', scheduler[1], '--patience', 5, '--report', 'r.json', cwd=tmp_path)
        wait_for(lambda: len(files(tmp_path / 'out')) > 20)
        scheduler[0].kill()
        out, err = process.communicate(timeout=120)
    finally:
        worker.kill()
        worker.wait()
    assert process.returncode == 1
    assert 'the scheduler is gone' in err
    assert json.loads((tmp_path / 'r.json').read_text())['interrupted'] is True


def test_a_scheduler_that_never_was(data, tmp_path):
    status, _, err = run('benchmark', '--dataset', data, '--scheduler', 'tcp://127.0.0.1:9', '--wait', 2, cwd=tmp_path)
    assert status == 1
    assert 'no Dask scheduler answers at tcp://127.0.0.1:9 within 2 s' in err and 'Traceback' not in err
