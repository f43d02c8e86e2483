"""The commands `benchmark` and `label`: on any number of workers what panoptic_benchmark gives."""
import json
import os
import pathlib
import signal
import subprocess
import sys
import time

import numpy as np
import pytest

pytest.importorskip('distributed', minversion='2022.12', reason="no Dask 'distributed' of 2022.12 or newer")

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


@pytest.fixture
def data(tmp_path):
    """Sequences 03 and 08 of 30 scans each."""
    for sequence in ('03', '08'):
        for number in range(30):
            write_scan(tmp_path / 'data', sequence, number)
    return tmp_path / 'data'


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


@pytest.mark.parametrize('workers', [1, 2])
def test_the_same_as_panoptic_benchmark(data, tmp_path, benchmark, workers):
    table = benchmark('--dataset', data, '--columns', 512, '--report', tmp_path / 'cpp.json',
                      '--output', tmp_path / 'a')
    status, out, err = run('benchmark', '--dataset', data, '--columns', 512, '--report', 'r.json', '--workers', workers,
                           '--scans-per-task', 7, '--output', 'b', cwd=tmp_path)
    assert status == 0, err
    assert quality(tmp_path / 'r.json') == quality(tmp_path / 'cpp.json')
    assert without_times(out) == without_times(table[table.index('Semantics'):])
    times = json.loads((tmp_path / 'r.json').read_text())['times']['depth']['frames']
    assert [frame['scan'] for frame in times] == [f'{s}/{n:06}' for s in ('03', '08') for n in range(30)]
    assert files(tmp_path / 'b') == files(tmp_path / 'a')
    assert '60/60' in err and 'a second' in err and 'left' in err
    assert not list(tmp_path.rglob('*.part'))


def test_tracked_sequences_are_tasks(data, tmp_path, benchmark):
    options = ['--dataset', data, '--columns', 512, '--track', '--algorithms', 'depth,birds_eye']
    benchmark(*options, '--report', tmp_path / 'cpp.json')
    status, _, err = run('benchmark', *options, '--report', 'r.json', '--workers', 2, cwd=tmp_path)
    assert status == 0, err
    assert quality(tmp_path / 'r.json') == quality(tmp_path / 'cpp.json')
    assert 'temporal' in quality(tmp_path / 'r.json')[0]['rows']['depth']


def test_recorded_scans(recorded, tmp_path, benchmark):
    options = ['--dataset', recorded, '--semantics', recorded / 'predictions/mininet',
               '--algorithms', 'depth,birds_eye']
    benchmark(*options, '--report', tmp_path / 'cpp.json')
    status, _, err = run('benchmark', *options, '--report', 'r.json', '--workers', 2, '--scans-per-task', 4,
                         cwd=tmp_path)
    assert status == 0, err
    assert quality(tmp_path / 'r.json') == quality(tmp_path / 'cpp.json')


def slow(data):
    """Options of a run of some seconds, in tasks of a few scans: columns cost time."""
    return [*slow_scans(data), '--workers', 2, '--scans-per-task', 2]


def slow_scans(data):
    """Of both programs."""
    return ['--dataset', data, '--columns', 8192, '--algorithms', 'depth,birds_eye']


def test_a_killed_worker_costs_nothing(data, tmp_path, benchmark):
    benchmark(*slow_scans(data), '--report', tmp_path / 'cpp.json')
    process = start('benchmark', *slow(data), '--report', 'r.json', '--output', 'out', cwd=tmp_path)
    wait_for(lambda: len(files(tmp_path / 'out')) > 20)
    os.kill(workers_of(process)[0], signal.SIGKILL)
    assert process.poll() is None, 'it was killed in mid-run'
    out, err = process.communicate(timeout=300)
    assert process.returncode == 0, err
    assert quality(tmp_path / 'r.json') == quality(tmp_path / 'cpp.json')


def test_a_worker_that_never_comes_back(data, tmp_path, benchmark):
    benchmark(*slow_scans(data), '--report', tmp_path / 'cpp.json')
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
    assert quality(tmp_path / 'r.json') == quality(tmp_path / 'cpp.json')


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


def test_labelling_goes_on_where_it_stopped(data, tmp_path, benchmark):
    benchmark('--dataset', data, '--columns', 512, '--algorithms', 'birds_eye', '--output', tmp_path / 'cpp')
    options = ['--dataset', data, '--columns', 512, '--algorithm', 'birds_eye', '--output', 'labels', '--workers', 2,
               '--scans-per-task', 4]
    status, out, err = run('label', *options, '--limit', 10, cwd=tmp_path)
    assert (status, out) == (0, '20 scans labelled, 0 of them by a run before; 0 skipped\n'), err
    kept = tmp_path / 'labels/sequences/03/predictions/000005.label'
    before = kept.stat().st_mtime_ns
    (tmp_path / 'labels/sequences/03/predictions/000006.label').unlink()
    (tmp_path / 'labels/sequences/08/predictions/000001.label').write_bytes(b'half')
    status, out, err = run('label', *options, cwd=tmp_path)
    assert (status, out) == (0, '60 scans labelled, 18 of them by a run before; 0 skipped\n'), err
    assert kept.stat().st_mtime_ns == before
    assert files(tmp_path / 'labels') == files(tmp_path / 'cpp/birds_eye')
    status, out, err = run('label', *options, '--set', 'birds_eye.vote=false', cwd=tmp_path)
    assert status == 1
    assert 'choose another --output' in err


def test_labelling_without_ground_truth(data, tmp_path):
    for sequence in ('03', '08'):
        labels = data / 'sequences' / sequence / 'labels'
        to = tmp_path / 'net/sequences' / sequence / 'predictions'
        to.parent.mkdir(parents=True)
        labels.rename(to)
    status, out, err = run('label', '--dataset', data, '--semantics', 'net', '--output', 'labels', '--columns', 512,
                           '--workers', 1, cwd=tmp_path)
    assert status == 0, err
    assert len(files(tmp_path / 'labels')) == 60
    labels = np.fromfile(tmp_path / 'labels/sequences/08/predictions/000003.label', np.uint32)
    assert len(np.unique(labels[:132] >> 16)) == 2 and not (labels[132:] >> 16).any()


def memory_kb(pid):
    """Resident."""
    for line in pathlib.Path(f'/proc/{pid}/status').read_text().splitlines():
        if line.startswith('VmRSS'):
            return int(line.split()[1])
    return 0


def test_ten_thousand_scans_keep_memory_flat(tmp_path):
    folder = write_scan(tmp_path / 'data', '00', 0, points=60)
    for number in range(1, 10000):
        for name, ending in (('velodyne', 'bin'), ('labels', 'label')):
            os.symlink(folder / name / f'000000.{ending}', folder / name / f'{number:06}.{ending}')
    process = start('benchmark', '--dataset', tmp_path / 'data', '--algorithms', 'depth', '--columns', 64,
                    '--workers', 2, '--report', 'r.json', cwd=tmp_path)
    samples = []
    lines = []
    for line in process.stderr:
        lines.append(line)
        if line.startswith('benchmark: '):
            samples.append([memory_kb(pid) for pid in [process.pid, *sorted(workers_of(process))]])
    assert process.wait(timeout=60) == 0, lines
    report = json.loads((tmp_path / 'r.json').read_text())
    assert report['quality']['scans'] == {'00': 10000}
    # from a fifth of the way on: the driver keeps 10,000 times, some hundred bytes each; workers keep nothing
    for first, last, room in zip(samples[1], samples[-1], [20000, 8000, 8000]):
        assert last - first < room, samples


class TestOfAScheduler:
    """Commands and workers that are started apart."""

    @pytest.fixture
    def scheduler(self, tmp_path):
        file = tmp_path / 'scheduler.json'
        process = subprocess.Popen([sys.executable, '-m', 'distributed.cli.dask_scheduler', '--port', '0',
                                    '--no-dashboard', '--dashboard-address', ':0', '--scheduler-file', str(file)],
                                   stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        wait_for(file.exists)
        yield process, file
        process.kill()
        process.wait()

    @staticmethod
    def worker(file, cwd, **environment):
        return subprocess.Popen([sys.executable, '-m', 'distributed.cli.dask_worker', '--scheduler-file', str(file),
                                 '--nthreads', '1', '--no-dashboard', '--death-timeout', '60'], cwd=str(cwd),
                                stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                                env={**os.environ, **environment})

    def test_workers_elsewhere(self, data, tmp_path, benchmark, scheduler):
        benchmark('--dataset', data, '--columns', 512, '--report', tmp_path / 'cpp.json')
        (tmp_path / 'elsewhere').mkdir()
        workers = [self.worker(scheduler[1], tmp_path / 'elsewhere') for _ in range(2)]
        try:
            status, _, err = run('benchmark', '--dataset', 'data', '--columns', 512, '--scheduler-file', scheduler[1],
                                 '--report', 'r.json', '--scans-per-task', 5, cwd=tmp_path)
        finally:
            for worker in workers:
                worker.terminate()
                worker.wait()
        assert status == 0, err
        assert quality(tmp_path / 'r.json') == quality(tmp_path / 'cpp.json')

    def test_without_a_worker(self, data, tmp_path, scheduler):
        status, _, err = run('benchmark', '--dataset', data, '--scheduler-file', scheduler[1], '--wait', 1,
                             cwd=tmp_path)
        assert status == 1
        assert 'has no worker after 1 s; one is started by' in err and 'Traceback' not in err

    def test_another_version(self, data, tmp_path, scheduler):
        other = tmp_path / 'other/lidar_panoptic_clustering'
        other.mkdir(parents=True)
        (other / '__init__.py').write_text('')
        (other / '_core.py').write_text('__version__ = "9.9.9"')
        (other / '_tasks.py').write_text('def package_version():\n    return "9.9.9"\n')
        worker = self.worker(scheduler[1], tmp_path, PYTHONPATH=str(other.parent))
        try:
            status, _, err = run('benchmark', '--dataset', data, '--scheduler-file', scheduler[1], cwd=tmp_path)
        finally:
            worker.terminate()
            worker.wait()
        assert status == 1
        assert '1 of 1 workers cannot take part' in err
        assert 'lidar_panoptic_clustering 9.9.9, expected lidar_panoptic_clustering ' in err

    def test_without_the_package(self, data, tmp_path, scheduler):
        worker = self.worker(scheduler[1], tmp_path, PYTHONPATH='')
        try:
            status, _, err = run('benchmark', '--dataset', data, '--scheduler-file', scheduler[1], cwd=tmp_path)
        finally:
            worker.terminate()
            worker.wait()
        assert status == 1
        assert 'cannot load this package' in err and 'Traceback' not in err

    def test_a_scheduler_that_dies(self, data, tmp_path, scheduler):
        worker = self.worker(scheduler[1], tmp_path)
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


@pytest.mark.parametrize('arguments, part', [
    (['benchmark'], '--dataset is missing'),
    (['benchmark', '--dataset', 'nowhere'], 'nowhere'),
    (['benchmark', '--dataset', 'data', '--algorithms', 'deep'], "'deep'"),
    (['benchmark', '--dataset', 'data', '--shard', '1/2'], '--shard'),
    (['benchmark', '--dataset', 'data', '--sequences', '03,03'], 'sequence 03 is given twice'),
    (['benchmark', '--dataset', 'data', '--report', 'no/such/r.json'], 'no/such/r.json'),
    (['label', '--dataset', 'data'], '--output is missing'),
    (['label', '--dataset', 'data', '--output', 'o', '--algorithms', 'depth,euclidean'], 'one algorithm'),
    (['benchmark', '--dataset', 'data', '--scheduler', 'tcp://a:1', '--workers', '2'], 'excludes --workers'),
])
def test_wrong_command_lines(data, tmp_path, arguments, part):
    status, out, err = run(arguments[0], *arguments[1:], cwd=tmp_path)
    assert status == (2 if part == '--shard' else 1), 'what is no option is told by argparse'
    assert part in err and 'Traceback' not in err
    assert out == ''


def test_without_dask_it_says_what_to_install(data, tmp_path):
    (tmp_path / 'none/distributed').mkdir(parents=True)
    (tmp_path / 'none/distributed/__init__.py').write_text('raise ImportError("no distributed here")')
    done = subprocess.run([*COMMAND, 'benchmark', '--dataset', str(data)], stderr=subprocess.PIPE,
                          universal_newlines=True, env={**os.environ, 'PYTHONPATH':
                                                        f'{tmp_path}/none:{os.environ.get("PYTHONPATH", "")}'})
    assert done.returncode == 1
    assert 'apt-get install python3-distributed, or pip install distributed' in done.stderr
