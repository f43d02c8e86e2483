"""The commands `benchmark` and `label`: on any number of workers what panoptic_benchmark gives."""
import json
import os
import pathlib
import subprocess

import numpy as np
import pytest
from cluster_runs import COMMAND, data, files, quality, run, start, without_times, workers_of, write_scan  # noqa: F401

pytest.importorskip('distributed', minversion='2022.12', reason="no Dask 'distributed' of 2022.12 or newer")


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
