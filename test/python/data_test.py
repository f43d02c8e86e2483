"""Data sets, quality, tracks and ground: what the programs say of the same files."""
import json
import pickle
import shutil

import numpy as np
import pytest
from conftest import in_file_order, label_files

import lidar_panoptic_clustering as lpc


def test_a_data_set_is_read(dataset):
    kitti = lpc.SemanticKitti(dataset)
    assert kitti.sequences == ['00']
    assert kitti.scans('00') == [f'{i:06}' for i in range(6)]
    points, labels = kitti.points('00', 2), kitti.labels('00', '000002')
    folder = dataset / 'sequences' / '00'
    np.testing.assert_array_equal(points, np.fromfile(folder / 'velodyne' / '000002.bin', np.float32).reshape(-1, 4))
    np.testing.assert_array_equal(labels, np.fromfile(folder / 'labels' / '000002.label', np.uint32))
    np.testing.assert_array_equal(kitti.classes('00', 2), labels & 0xFFFF)
    simulator = lpc.LidarSimulator('hdl64e', seed=5)
    moved = np.linalg.inv(simulator.pose(0)) @ simulator.pose(4)
    np.testing.assert_allclose(kitti.poses('00')[4], moved, atol=1e-5)
    np.testing.assert_allclose(kitti.times('00'), np.arange(6) / 10)
    assert lpc.SemanticKitti.split('valid') == ['08']


def test_errors_of_data_sets(dataset, tmp_path):
    kitti = lpc.SemanticKitti(dataset)
    for call, words in ((lambda: lpc.SemanticKitti(tmp_path), 'sequences/SS/velodyne.*' + tmp_path.name),
                        (lambda: lpc.SemanticKitti('/nowhere'), '/nowhere'),
                        (lambda: lpc.SemanticKitti(dataset, label_table='object'), 'semantics.*not given'),
                        (lambda: lpc.SemanticKitti(dataset, semantics=tmp_path).classes('00', 0), str(tmp_path)),
                        (lambda: lpc.SemanticKitti(dataset, class_table='cityscapes'), 'cityscapes'),
                        (lambda: kitti.scans('42'), '42'),
                        (lambda: kitti.points('00', 6), 'from 0 to 5, found 6'),
                        (lambda: kitti.points('00', -1), 'found -1'),
                        (lambda: kitti.points('00', '7'), "no scan '7', but 000000 to 000005"),
                        (lambda: lpc.SemanticKitti.split('validation'), 'validation')):
        with pytest.raises(ValueError, match=words):
            call()
    broken = tmp_path / 'broken'
    shutil.copytree(str(dataset), str(broken))
    labels = broken / 'sequences' / '00' / 'labels' / '000001.label'
    labels.write_bytes(labels.read_bytes()[:-4])
    with pytest.raises(ValueError, match=r'000001\.label'):
        lpc.SemanticKitti(broken).labels('00', 1)
    labels.unlink()
    with pytest.raises(ValueError, match=r'000001\.label'):
        lpc.SemanticKitti(broken).labels('00', 1)


def test_predictions_are_written_as_the_program_writes_them(dataset, benchmark, tmp_path):
    benchmark('--dataset', dataset, '--algorithms', 'depth', '--limit', 2, '--output', tmp_path / 'program')
    kitti = lpc.SemanticKitti(dataset)
    segmenter = lpc.Segmenter('depth')
    for scan in kitti.scans('00')[:2]:
        instances, labels = segmenter(kitti.points('00', scan), kitti.classes('00', scan), return_labels=True)
        path = kitti.write(tmp_path / 'python', '00', scan, labels, instances)
        assert path.endswith(f'sequences/00/predictions/{scan}.label')
    ours, theirs = label_files(tmp_path / 'python'), label_files(tmp_path / 'program' / 'depth')
    assert ours.keys() == theirs.keys()
    for scan in ours:
        np.testing.assert_array_equal(ours[scan], theirs[scan])
    with pytest.raises(ValueError, match='65535.*65536'):
        lpc.encode_labels([10], [65536])
    with pytest.raises(ValueError):
        lpc.encode_labels([10, 10], [1])


def test_quality_is_the_program_s(dataset, benchmark, tmp_path):
    report = tmp_path / 'report.json'
    benchmark('--dataset', dataset, '--algorithms', 'scan_line_run', '--report', report)
    expected = json.loads(report.read_text())['quality']['rows']['scan_line_run']
    kitti = lpc.SemanticKitti(dataset)
    segmenter = lpc.Segmenter('scan_line_run')
    parts = [lpc.PanopticQuality(), lpc.PanopticQuality()]
    for i, scan in enumerate(kitti.scans('00')):
        instances, labels = segmenter(kitti.points('00', scan), kitti.classes('00', scan), return_labels=True)
        parts[i % 2].add(lpc.encode_labels(labels, instances), kitti.labels('00', scan))
    whole = pickle.loads(pickle.dumps(parts[0]))
    assert whole == parts[0]
    whole += parts[1]
    assert whole.scans == 6 and parts[0].scans == 3
    for key in ('pq', 'sq', 'rq', 'pq_dagger', 'miou'):
        assert whole.figures()[key] == expected[key], key
    car = whole.classes()['car']
    assert {key: car[key] for key in ('tp', 'fp', 'fn')} == {key: expected['per_class']['car'][key]
                                                            for key in ('tp', 'fp', 'fn')}
    with pytest.raises(ValueError, match='found 1 and 2'):
        whole.add([0], [0, 0])
    with pytest.raises(ValueError):
        whole += lpc.PanopticQuality(min_points=1)
    with pytest.raises(ValueError):
        lpc.PanopticQuality(min_points=-1)


def test_tracks_are_the_program_s(dataset, benchmark, tmp_path):
    benchmark('--dataset', dataset, '--algorithms', 'birds_eye', '--track', '--output', tmp_path)
    kitti = lpc.SemanticKitti(dataset)
    segmenter, tracker = lpc.Segmenter('birds_eye'), lpc.Tracker()
    poses, times = kitti.poses('00'), kitti.times('00')
    lasting = None
    for i, scan in enumerate(kitti.scans('00')):
        points = kitti.points('00', scan)
        instances, labels = segmenter(points, kitti.classes('00', scan), return_labels=True)
        canonical = lpc.encode_labels(labels, np.zeros_like(labels))
        tracks, voted = tracker(points, canonical, instances, times[i], pose=poses[i], return_labels=True)
        expected = np.fromfile(next(tmp_path.glob(f'*/sequences/00/predictions/{scan}.label')), np.uint32)
        np.testing.assert_array_equal(tracks, expected >> 16)
        np.testing.assert_array_equal(lpc.encode_labels(voted, tracks), expected)
        ids = set(np.unique(tracks)) - {0}
        lasting = ids if lasting is None else lasting & ids
        assert set(tracker.objects['id']) == ids
    assert len(lasting) > 5
    assert np.isfinite(tracker.objects['velocity']).all()
    assert tracker.objects['age_s'].max() == pytest.approx(0.5)
    tracker.restart()
    assert tracker(points, canonical, instances, 0.0)[instances > 0].min() == 1


@pytest.mark.parametrize('given, words', [
    ({'pose': np.eye(3)}, r'pose: expected a matrix of shape \(4, 4\)'),
    ({'pose': np.full((4, 4), np.nan)}, 'pose: expected finite numbers'),
    ({'pose': 'north'}, 'pose: expected a matrix'),
    ({'time_s': float('inf')}, 'time_s'),
    ({'instances': np.zeros(2, int)}, r'instances: expected shape \(3,\)'),
    ({'instances': np.zeros(3)}, 'instances: expected whole numbers'),
])
def test_errors_of_the_tracker(given, words):
    call = {'points': np.zeros((3, 3)), 'labels': np.zeros(3, int), 'instances': np.zeros(3, int), 'time_s': 0.0}
    with pytest.raises(ValueError, match=words):
        lpc.Tracker()(**{**call, **given})
    with pytest.raises(ValueError, match='max_missed_s'):
        lpc.Tracker(max_missed_s=-1)


def test_ground_and_objects_without_a_network(organized, scan):
    truth_ground = [i for name in ('road', 'parking', 'sidewalk', 'other-ground') for i in lpc.class_ids()[name]]
    object_table = lpc.class_ids('object')
    for points, labels in (organized[:2], scan[:2]):
        labeler = lpc.GroundLabeler()
        found = labeler(points)
        assert found.shape == labels.shape and found.dtype == np.uint32
        valid = np.isfinite(points[..., 0])
        is_ground = np.isin(found, object_table['ground'])
        agree = (is_ground == np.isin(labels, truth_ground))[valid]
        assert agree.mean() > 0.95
        assert labeler.ground['found'] and labeler.ground['sensor_height_m'] == pytest.approx(1.73, abs=0.1)
        assert lpc.Segmenter(class_table='object')(points, found).max() > 5
    order = np.random.RandomState(1).permutation(len(scan[0]))
    merged = lpc.GroundLabeler(layout='merged')(scan[0][order])
    assert np.mean(np.isin(merged, object_table['ground']) == np.isin(scan[1][order], truth_ground)) > 0.9
    with pytest.raises(ValueError, match="'structure': expected one of 'strict'"):
        lpc.GroundLabeler(structure='loose')


def test_simulated_scans_are_a_function_of_their_number():
    first, again = lpc.LidarSimulator('vlp16', seed=9), lpc.LidarSimulator('vlp16', seed=9)
    assert 'vlp16' in lpc.sensors()
    again.scan(7)
    for a, b in zip(first.scan(2), again.scan(2)):
        np.testing.assert_array_equal(a, b)
    assert in_file_order(*first.scan(0))[0].shape[1] == 4
    with pytest.raises(ValueError, match='seed'):
        lpc.LidarSimulator(seed=-1)
    with pytest.raises(ValueError, match='vlp17'):
        lpc.LidarSimulator('vlp17')
