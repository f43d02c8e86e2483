"""The segmenter against panoptic_benchmark, and what it promises of itself."""
import pickle

import numpy as np
import pytest
from conftest import ROWS, label_files

import lidar_panoptic_clustering as lpc


def compare(kitti, written, make):
    """Each scan's instances and labels with those of a label file, bit for bit."""
    segmenter = make()
    for (sequence, scan), expected in written.items():
        points, classes = kitti.points(sequence, scan), kitti.classes(sequence, scan)
        instances, voted = segmenter(points, classes, return_labels=True)
        assert instances.dtype == voted.dtype == np.uint32
        np.testing.assert_array_equal(instances, expected >> 16)
        np.testing.assert_array_equal(lpc.encode_labels(voted, instances), expected)


def folder_of(output, row):
    return next(f for f in output.iterdir() if f.is_dir() and f.name.replace('_', ' ') == row.replace('_', ' '))


def test_same_labels_as_the_program_on_simulated_scans(dataset, benchmark, tmp_path):
    benchmark('--dataset', dataset, '--limit', 3, '--output', tmp_path)
    kitti = lpc.SemanticKitti(dataset)
    for row, (algorithm, parameters) in ROWS.items():
        compare(kitti, label_files(folder_of(tmp_path, row)), lambda: lpc.Segmenter(algorithm, **parameters))


def test_same_labels_as_the_program_on_recorded_scans(recorded, benchmark, tmp_path):
    semantics = recorded / 'predictions' / 'mininet'
    for name, options in (('truth', {}), ('network', {'semantics': semantics})):
        arguments = [word for key, value in options.items() for word in ('--' + key, value)]
        benchmark('--dataset', recorded, '--limit', 2, '--output', tmp_path / name, *arguments)
        kitti = lpc.SemanticKitti(recorded, **options)
        for row, (algorithm, parameters) in ROWS.items():
            written = label_files(folder_of(tmp_path / name, row))
            assert len(written) >= 2
            compare(kitti, written, lambda: lpc.Segmenter(algorithm, **parameters))


def test_every_thing_point_has_an_instance(scan):
    points, labels, _ = scan
    things = [i for name in ('car', 'truck', 'person', 'bicycle', 'bicyclist', 'other-vehicle', 'motorcycle',
                             'motorcyclist') for i in lpc.class_ids()[name]]
    for algorithm in lpc.algorithms():
        instances = lpc.Segmenter(algorithm)(points, labels)
        np.testing.assert_array_equal(instances > 0, np.isin(labels, things))
        ids = np.unique(instances)
        np.testing.assert_array_equal(ids, np.arange(len(ids)))


def test_instances_are_the_true_ones_where_objects_stand_apart(scan):
    points, labels, truth = scan
    quality = lpc.PanopticQuality()
    quality.add(lpc.encode_labels(labels, lpc.Segmenter()(points, labels)), labels | truth << 16)
    assert quality.figures()['pq_th_present'] > 0.9


def test_organized_scans_keep_their_shape(organized):
    points, labels, _ = organized
    flat = None
    for algorithm in lpc.algorithms():
        instances, voted = lpc.Segmenter(algorithm)(points, labels, return_labels=True)
        assert instances.shape == voted.shape == labels.shape
        assert (instances[~np.isfinite(points[..., 0])] == 0).all()
        flat = instances.reshape(-1)
        assert 3 < flat.max() < 200


def test_ring_gives_rows_to_points_in_any_order(organized):
    points, labels, _ = organized
    rows = np.broadcast_to(np.arange(points.shape[0])[:, None], labels.shape)
    valid = np.isfinite(points[..., 0])
    order = np.random.RandomState(0).permutation(valid.sum())
    shuffled, classes, ring = points[valid][order], labels[valid][order], rows[valid][order]
    expected = lpc.Segmenter('depth')(points, labels)[valid][order]
    found = lpc.Segmenter('depth')(shuffled, classes, ring=ring.astype(np.uint8))
    pairs = {(a, b) for a, b in zip(expected.tolist(), found.tolist())}
    # the same objects: hardly any point changes between them when rows come from the ring and columns from the azimuth
    assert np.mean((expected > 0) == (found > 0)) == 1.0
    assert len(pairs) < 1.2 * len(np.unique(expected))


def test_points_without_order_are_refused_or_merged(scan):
    points, labels, _ = scan
    order = np.random.RandomState(0).permutation(len(points))
    with pytest.raises(ValueError, match=r'ring after ring.*found \d+.*rows=.*ring=.*merged'):
        lpc.Segmenter('birds_eye')(points[order], labels[order])
    merged = lpc.Segmenter('birds_eye', layout='merged')(points[order], labels[order])
    assert (merged > 0).sum() == (lpc.Segmenter('birds_eye')(points, labels) > 0).sum()
    with pytest.raises(ValueError, match='birds_eye, euclidean, supervoxel'):
        lpc.Segmenter('depth', layout='merged')(points[order], labels[order])


def test_what_came_before_counts_for_nothing(scan, organized):
    points, labels, _ = scan
    segmenter = lpc.Segmenter('scan_line_run')
    first = segmenter(points, labels)
    segmenter(organized[0], organized[1])
    segmenter(points[:5000], labels[:5000])
    np.testing.assert_array_equal(segmenter(points, labels), first)


def test_objects(scan):
    points, labels, _ = scan
    segmenter = lpc.Segmenter('birds_eye')
    assert segmenter.objects.shape == (0,)
    instances, voted = segmenter(points, labels, return_labels=True)
    objects = segmenter.objects
    assert objects.dtype.names == ('id', 'class', 'box', 'points')
    assert objects.dtype['box'].names == ('x', 'y', 'z', 'length', 'width', 'height', 'yaw')
    np.testing.assert_array_equal(objects['id'], np.arange(1, instances.max() + 1))
    np.testing.assert_array_equal(objects['points'], np.bincount(instances)[1:])
    for one in objects:
        own = points[instances == one['id'], :3]
        assert np.all(lpc.encode_labels(voted[instances == one['id']], np.zeros(len(own), int)) == one['class'])
        box = one['box']
        along, across = np.cos(box['yaw']), np.sin(box['yaw'])
        x, y = own[:, 0] - box['x'], own[:, 1] - box['y']
        assert np.abs(along * x + across * y).max() == pytest.approx(box['length'] / 2, abs=2e-3)
        assert np.abs(along * y - across * x).max() == pytest.approx(box['width'] / 2, abs=2e-3)
        assert np.ptp(own[:, 2]) == pytest.approx(box['height'], abs=1e-3)
    assert segmenter.objects['id'][0] == 1  # may be asked for again


def test_a_refused_scan_leaves_no_objects(scan):
    points, labels, _ = scan
    segmenter = lpc.Segmenter()
    segmenter(points, labels)
    with pytest.raises(ValueError):
        segmenter(points, np.full(len(points), 7777, np.uint16))
    assert len(segmenter.objects) == 0


def test_min_points(scan):
    points, labels, _ = scan
    instances = lpc.Segmenter('birds_eye', min_points=40)(points, labels)
    counts = np.bincount(instances)[1:]
    assert counts.min() >= 40 and counts.max() > 200


def test_labels_of_another_table(scan):
    points, labels, _ = scan
    training = {name: ids[0] for name, ids in lpc.class_ids('semantic_kitti_training').items()}
    # training ids say less: all that moves is with what stands
    own = np.zeros_like(labels)
    for name, ids in lpc.class_ids().items():
        if name in training:
            own[np.isin(labels, ids)] = training[name]
    expected = lpc.Segmenter('depth')(points, lpc.encode_labels(labels, np.zeros(len(labels), int)))
    found, voted = lpc.Segmenter('depth', label_table='semantic_kitti_training')(points, own, return_labels=True)
    np.testing.assert_array_equal(found > 0, expected > 0)
    assert set(np.unique(voted)) <= {i for ids in lpc.class_ids().values() for i in ids}


def test_parameters_are_those_of_the_nodelets():
    for algorithm in lpc.algorithms():
        known = lpc.parameters(algorithm)
        assert {'min_points', 'vote', 'class_policy', 'max_range_m', 'layout', 'class_table'} <= set(known)
        segmenter = lpc.Segmenter(algorithm, **{name: info['default'] for name, info in known.items()})
        assert segmenter.parameters == {name: info['default'] for name, info in known.items()}
    assert lpc.parameters('depth')['theta_deg'] == {'default': 10.0, 'min': 0.1, 'max': 89.0}
    assert lpc.parameters('depth')['class_policy']['choices'] == ['class', 'group', 'any']


def test_survives_a_pickle(scan):
    points, labels, _ = scan
    segmenter = lpc.Segmenter('depth', theta_deg=5, class_table='semantic_kitti')
    again = pickle.loads(pickle.dumps(segmenter))
    assert repr(again) == repr(segmenter) == "Segmenter('depth', class_table='semantic_kitti', theta_deg=5.0)"
    np.testing.assert_array_equal(again(points, labels), segmenter(points, labels))


def test_the_survey_s_function_is_the_program_s_survey(dataset, benchmark, tmp_path):
    benchmark('--dataset', dataset, '--limit', 2, '--survey', '--output', tmp_path)
    kitti = lpc.SemanticKitti(dataset)
    for algorithm in ('euclidean', 'supervoxel', 'depth', 'scan_line_run'):
        for (sequence, scan), expected in label_files(folder_of(tmp_path, f'{algorithm} survey')).items():
            points, classes = kitti.points(sequence, scan), kitti.classes(sequence, scan)
            np.testing.assert_array_equal(lpc.cluster(points, classes, algorithm), expected >> 16)
    normals = label_files(folder_of(tmp_path, 'supervoxel survey normal_weight=0.5'))
    for (sequence, scan), expected in normals.items():
        points, classes = kitti.points(sequence, scan), kitti.classes(sequence, scan)
        np.testing.assert_array_equal(lpc.cluster(points, classes, 'supervoxel', normal_weight=0.5), expected >> 16)


def test_the_survey_s_function_has_the_nodelet_s_algorithm_with_published_parameters(scan):
    points, labels, _ = scan
    published = {'euclidean': {'distance_m': 0.5}, 'supervoxel': {'voxel_m': 0.5, 'seed_m': 8, 'normal_weight': 0},
                 'depth': {'theta_deg': 10, 'max_gap_px': 9}, 'scan_line_run': {'run_distance_m': 0.5,
                                                                               'line_distance_m': 1.0}}
    for algorithm, parameters in published.items():
        nodelet = lpc.Segmenter(algorithm, link_distance_scale=100, bridge_distance_m=0, split=False, merge=False,
                                vote=False, **parameters)
        np.testing.assert_array_equal(lpc.cluster(points, labels, algorithm), nodelet(points, labels))
        assert lpc.cluster(points, labels, algorithm, min_points=100).max() < nodelet(points, labels).max()
