"""Charts of a benchmark's report."""
import json
import os
import subprocess
import sys

import pytest

from lidar_panoptic_clustering import plot

matplotlib_image = pytest.importorskip('matplotlib.image')


def quality_of(pq, **more):
    """Of one row."""
    classes = {
        'road': {'kind': 'stuff', 'tp': 2, 'fp': 0, 'fn': 0, 'pq': 0.75, 'points': {'true': 900}},
        'bicycle': {'kind': 'thing', 'tp': 1, 'fp': 1, 'fn': 0, 'pq': 0.5 * pq, 'points': {'true': 20}},
        'car': {'kind': 'thing', 'tp': 3, 'fp': 0, 'fn': 1, 'pq': pq, 'points': {'true': 300}},
        'truck': {'kind': 'thing', 'tp': 0, 'fp': 0, 'fn': 0, 'pq': 0.0, 'points': {'true': 0}},
    }
    figures = {key: pq for key in ('pq', 'rq', 'sq', 'pq_th', 'pq_th_present')}
    objects = {'split': 1, 'merged': 2, 'missed': 7, 'matched': 5, 'total': 15}
    return {**figures, 'scans': 2, 'per_class': classes, 'true_objects': objects, **more}


def times_of(milliseconds):
    """Of one row."""
    frames = [{'scan': f'00/{i}', 'points': 100, 'thing_points': 10 * i, 'cluster_ms': milliseconds + i,
               'pipeline_ms': 2 * milliseconds} for i in range(4)]
    summary = {'median': milliseconds, 'p95': 3 * milliseconds, 'max': 4 * milliseconds}
    return {'frames': frames, 'cluster_ms': summary, 'pipeline_ms': summary}


@pytest.fixture
def report():
    """Two rows on two scans."""
    rows = {'depth': 0.8, 'supervoxel normal_weight=0.5': 0.6}
    return {
        'rows': list(rows),
        'interrupted': False,
        'quality': {'semantics': 'my network', 'scans': {'00': 1, '05': 1}, 'before_clustering': quality_of(0.1),
                    'rows': {name: quality_of(pq) for name, pq in rows.items()}},
        'times': {name: times_of(5.0 * (i + 1)) for i, name in enumerate(rows)},
    }


def heights(page):
    """Of the bars, series after series."""
    return [[round(bar.get_height(), 9) for bar in container] for container in page.axes.containers]


def texts(page):
    """All that is written at the values and the axes."""
    return ({text.get_text() for text in page.axes.texts} | {label.get_text() for label in page.axes.get_xticklabels()} |
            {page.axes.get_ylabel()} | {text.get_text() for text in page.figure.texts})


def test_bars_are_the_reports_figures(report):
    quality = plot.draw_quality(report)
    assert heights(quality) == [[80.0, 60.0]] * 5
    assert {'80.0', '60.0', 'Quality', 'depth', 'supervoxel\nnormal_weight=0.5',
            'semantics: my network; 2 scans evaluated, sequences 00, 05'} <= texts(quality)
    objects = plot.draw_objects(report)
    assert heights(objects) == [[1.0, 1.0], [2.0, 2.0], [7.0, 7.0]]


def test_classes_that_occur_things_first_the_most_frequent_first(report):
    page = plot.draw_classes(report)
    assert [label.get_text() for label in page.axes.get_xticklabels()] == ['car', 'bicycle', 'road']
    assert heights(page) == [[80.0, 40.0, 75.0], [60.0, 30.0, 75.0]]
    assert {'things', 'stuff'} <= texts(page)


def test_times_are_from_median_to_95th_percentile(report):
    page = plot.draw_times(report)
    spans = [tuple(line.get_ydata()) for line in page.axes.lines if len(line.get_ydata()) == 2]
    assert spans[:4] == [(5.0, 15.0), (10.0, 30.0), (5.0, 15.0), (10.0, 30.0)]
    assert {'5.00', '15.0', '10.0', '30.0', 'time [ms]'} <= texts(page)
    by_points = plot.draw_time_by_points(report)
    assert list(by_points.axes.lines[1].get_xdata()) == [0, 10, 20, 30]
    assert list(by_points.axes.lines[1].get_ydata()) == [10.0, 11.0, 12.0, 13.0]
    assert by_points.axes.get_yscale() == 'log'


def test_lstq_where_ids_were_tracked(report):
    for row in report['quality']['rows'].values():
        row['temporal'] = {'lstq': 0.25}
    assert heights(plot.draw_quality(report))[-1] == [25.0, 25.0]


def test_png_and_svg(report, tmp_path):
    names = {'quality', 'objects', 'pq_by_class', 'time', 'time_by_points'}
    written = plot.draw_report(report, str(tmp_path / 'charts'))
    assert {os.path.basename(path) for path in written} == {f'{n}.{kind}' for n in names for kind in ('png', 'svg')}
    assert sorted(os.listdir(tmp_path / 'charts')) == sorted(map(os.path.basename, written)), 'nothing is left aside'
    picture = matplotlib_image.imread(str(tmp_path / 'charts/quality.png'))
    assert picture.shape[:2] == (900, 1600)
    assert (picture[:, :, :3].min(axis=2) > 0.99).mean() > 0.3, 'white paper'
    assert (tmp_path / 'charts/time.svg').read_text().rstrip().endswith('</svg>')
    again = plot.draw_report(report, str(tmp_path / 'again'), ['svg'])
    assert len(again) == 5
    for path in again:
        assert open(path).read() == (tmp_path / 'charts' / os.path.basename(path)).read_text()


def test_texts_do_not_overlap_the_plot(report, tmp_path):
    """However many rows: names below, legend above, values inside the page."""
    for count in (2, 24):
        names = [f'depth, all but bridge {i}' for i in range(count)]
        report['rows'] = names
        report['quality']['rows'] = {name: quality_of(1.0) for name in names}
        report['times'] = {name: times_of(123.4) for name in names}
        for draw in (plot.draw_quality, plot.draw_classes, plot.draw_times):
            page = draw(report)
            page.save(str(tmp_path / 'page.png'), 'png')
            renderer = page.figure.canvas.get_renderer()
            axes = page.axes.get_window_extent(renderer)
            assert axes.height > 200
            for label in page.axes.get_xticklabels():
                assert label.get_window_extent(renderer).y0 >= 0
                assert label.get_window_extent(renderer).y1 <= axes.y0
            for legend in page.figure.legends:
                bottom = legend.get_window_extent(renderer).y0
                assert bottom >= axes.y1
                for text, _ in page._values:
                    assert text.get_window_extent(renderer).y1 <= bottom + 1


def test_without_ground_truth_only_times(report, tmp_path):
    report['quality']['before_clustering']['scans'] = 0
    report['quality']['scans'] = {}
    written = plot.draw_report(report, str(tmp_path), ['png'])
    assert [os.path.basename(path) for path in written] == ['time.png', 'time_by_points.png']


def test_no_rows_and_no_frames(report, tmp_path):
    for name in report['rows']:
        report['times'][name] = {**times_of(0.0), 'frames': []}
    plot.draw_report(report, str(tmp_path), ['png'])
    report['rows'] = []
    plot.draw_report(report, str(tmp_path), ['png'])


@pytest.mark.parametrize('text, part', [('{', 'not JSON'), ('[]', 'report of panoptic_benchmark'),
                                        ('{"rows": ["a"], "times": {}}', "key 'a' is missing")])
def test_what_is_no_report_is_named(tmp_path, text, part):
    path = tmp_path / 'wrong.json'
    path.write_text(text)
    with pytest.raises(ValueError, match=part) as error:
        plot.load_report(str(path))
    assert str(path) in str(error.value)


def run_command(*arguments, **environment):
    """(exit status, stdout, stderr)"""
    done = subprocess.run([sys.executable, '-m', 'lidar_panoptic_clustering', *map(str, arguments)],
                          stdout=subprocess.PIPE, stderr=subprocess.PIPE, universal_newlines=True,
                          env={**os.environ, **environment})
    return done.returncode, done.stdout, done.stderr


def test_command(report, tmp_path):
    path = tmp_path / 'report.json'
    path.write_text(json.dumps(report))
    status, out, err = run_command('plot', path, '--format', 'svg')
    assert status == 0, err
    assert str(tmp_path / 'report/quality.svg') in out.splitlines()
    assert run_command('plot', path, '--format', 'gif') == (1, '', "plot: format is 'gif', expected one of png, svg\n")
    status, _, err = run_command('plot', tmp_path / 'missing.json')
    assert status == 1 and 'missing.json' in err
    (tmp_path / 'file').write_text('')
    status, _, err = run_command('plot', path, '--output', tmp_path / 'file/inside')
    assert status == 1 and 'file' in err and 'Traceback' not in err
    status, _, err = run_command('plott')
    assert status == 2 and "unknown command 'plott', expected one of plot, benchmark, label" in err


def test_without_matplotlib_it_says_what_to_install(report, tmp_path):
    path = tmp_path / 'report.json'
    path.write_text(json.dumps(report))
    (tmp_path / 'matplotlib').mkdir()
    (tmp_path / 'matplotlib/__init__.py').write_text(
        'raise ModuleNotFoundError("No module named \'matplotlib\'", name="matplotlib")')
    status, _, err = run_command('plot', path, PYTHONPATH=f'{tmp_path}:{os.environ.get("PYTHONPATH", "")}')
    assert status == 1
    assert 'apt-get install python3-matplotlib, or pip install matplotlib' in err
    assert 'Traceback' not in err
