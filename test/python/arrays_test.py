"""What arrays are taken, and what is said of those that are not."""
import sys
import threading
import time

import numpy as np
import pytest

import lidar_panoptic_clustering as lpc


@pytest.fixture(scope='module')
def segmenter():
    return lpc.Segmenter('birds_eye')


@pytest.fixture(scope='module')
def expected(scan):
    return lpc.Segmenter('birds_eye')(scan[0], scan[1])


def test_types_of_labels(scan, segmenter, expected):
    points, labels, _ = scan
    for kind in (np.uint8, np.uint16, np.int16, np.uint32, np.int32, np.uint64, np.int64, '>u4', '>i2'):
        own = labels if np.iinfo(np.dtype(kind)).max >= labels.max() else None
        if own is None:  # 252 and more do not fit: the canonical ids do
            own = lpc.encode_labels(labels, np.zeros(len(labels), int))
            reference = segmenter(points, own)
        else:
            reference = expected
        np.testing.assert_array_equal(segmenter(points, own.astype(kind)), reference)


def test_types_of_points(scan, segmenter, expected):
    points, labels, _ = scan
    np.testing.assert_array_equal(segmenter(points.astype(np.float64), labels), expected)
    np.testing.assert_array_equal(segmenter(points.astype('>f4'), labels), expected)
    np.testing.assert_array_equal(segmenter(points.astype(np.longdouble), labels), expected)
    half = segmenter(points.astype(np.float16), labels)
    np.testing.assert_array_equal(half, segmenter(points.astype(np.float16).astype(np.float32), labels))


def test_views_of_any_stride(scan, segmenter, expected):
    points, labels, _ = scan
    wide = np.full((2 * len(points), 7), np.nan)
    wide[::2, 1:5] = points
    between = np.zeros((len(points), 3), np.int64)
    between[:, 1] = labels
    views = {
        'columns and every second row': wide[::2, 1:5],
        'three channels': points[:, :3],
        'Fortran order': np.asfortranarray(points),
        'backwards in memory': points[::-1].copy()[::-1],
        'more channels': np.concatenate([points, points], axis=1),
    }
    for name, view in views.items():
        np.testing.assert_array_equal(segmenter(view, between[:, 1]), expected, err_msg=name)
    unaligned = np.frombuffer(b'x' + points.tobytes(), np.uint8)[1:].view(np.dtype('<f4')).reshape(points.shape)
    np.testing.assert_array_equal(segmenter(unaligned, labels), expected)


def test_organized_views(organized):
    points, labels, _ = organized
    reference = lpc.Segmenter('depth')(points, labels)
    transposed = np.ascontiguousarray(points.transpose(1, 0, 2)).transpose(1, 0, 2)
    np.testing.assert_array_equal(lpc.Segmenter('depth')(transposed, np.asfortranarray(labels)), reference)


def test_what_is_given_is_never_changed(scan, segmenter):
    points, labels = scan[0].copy(), scan[1].copy()
    points.flags.writeable = labels.flags.writeable = False
    first = segmenter(points, labels)
    kept = first.copy()
    np.testing.assert_array_equal(points, scan[0])
    np.testing.assert_array_equal(labels, scan[1])
    segmenter(points[:1000], labels[:1000])
    np.testing.assert_array_equal(first, kept)  # a result is the caller's own


def test_lists_and_others_arrays(scan, segmenter, expected):
    points, labels, _ = scan

    class Tensor:
        def __init__(self, array):
            self.array = array

        def __array__(self, dtype=None, copy=None):
            return self.array

    np.testing.assert_array_equal(segmenter(Tensor(points), Tensor(labels)), expected)
    assert segmenter([[10.0, 1.0, 0.5], [10.1, 1.0, 0.5], [10.0, 9.0, 0.5]], [10, 10, 40]).tolist() == [1, 1, 0]
    if hasattr(np, 'from_dlpack'):
        class Capsule:
            def __init__(self, array):
                self.array = array

            def __dlpack__(self, **options):
                return self.array.__dlpack__()

            def __dlpack_device__(self):
                return self.array.__dlpack_device__()

        np.testing.assert_array_equal(segmenter(Capsule(points), Capsule(labels.astype(np.int64))), expected)


def test_torch(scan, segmenter, expected):
    torch = pytest.importorskip('torch')
    points, labels, _ = scan
    given = torch.from_numpy(points), torch.from_numpy(labels.astype(np.int64))
    np.testing.assert_array_equal(segmenter(*given), expected)
    with pytest.raises(ValueError, match='points.*Tensor.*grad'):
        segmenter(given[0].clone().requires_grad_(), given[1])


def test_no_points_and_one(segmenter):
    for algorithm in lpc.algorithms():
        segmenter = lpc.Segmenter(algorithm)
        assert segmenter(np.zeros((0, 4), np.float32), np.zeros(0, int)).shape == (0,)
        assert segmenter(np.zeros((0, 5, 3), np.float32), np.zeros((0, 5), int)).shape == (0, 5)
        assert len(segmenter.objects) == 0
        assert segmenter(np.float32([[5, 1, 0.5, 0.1]]), [10]).tolist() == [1]
        assert segmenter.objects['points'].tolist() == [1]
        assert segmenter(np.float32([[[5, 1, 0.5]]]), [[10]]).tolist() == [[1]]
        assert segmenter(np.float32([[5, 1, 0.5, 0.1]]), [40]).tolist() == [0]


def test_no_returns(scan):
    points, labels, _ = scan
    holes = points.copy()
    lost = np.arange(len(points)) % 7 == 0
    holes[lost, 0] = [np.nan, np.inf, -np.inf][0]
    holes[lost & (np.arange(len(points)) % 2 == 0), :3] = 0
    for algorithm in lpc.algorithms():
        segmenter = lpc.Segmenter(algorithm)
        instances = segmenter(holes, labels)
        assert instances.shape == (len(points),)
        assert (instances[~lost] > 0).sum() == (lpc.Segmenter(algorithm)(points, labels)[~lost] > 0).sum()
        assert np.isfinite(np.array(segmenter.objects['box'].tolist())).all()
    nothing = np.full((100, 4), np.nan, np.float32)
    assert lpc.Segmenter()(nothing, np.full(100, 40)).tolist() == [0] * 100
    lpc.Segmenter()(nothing, np.full(100, 10))
    huge = np.full((100, 4), 3e38)
    lpc.Segmenter()(huge, np.full(100, 10))


def test_labels_with_an_instance(scan, segmenter, expected):
    points, labels, truth = scan
    np.testing.assert_array_equal(segmenter(points, labels | truth << 16), expected)


@pytest.mark.parametrize('points, labels, words', [
    (np.zeros((5, 4), np.float32), np.zeros(4, int), r'labels: expected shape \(5,\), one a point, found \(4,\)'),
    (np.zeros((5, 4), np.float32), np.zeros((5, 1), int), r'labels: expected shape \(5,\).*found \(5, 1\)'),
    (np.zeros((5, 4), np.float32), np.zeros(5), 'labels: expected whole numbers, found float64'),
    (np.zeros((5, 4), np.float32), np.zeros(5, bool), 'labels: expected whole numbers, found bool'),
    (np.zeros((5, 4), np.float32), np.int32([0, 0, -3, 0, 0]), 'labels: .* found -3 at point 2'),
    (np.zeros((5, 4), np.float32), np.uint64([0, 0, 0, 0, 2 ** 40]), 'labels: .* found 1099511627776 at point 4'),
    (np.zeros((5, 4), np.float32), np.uint16([0, 0, 0, 7, 0]), "labels: point 3 has class id 7, which is not in class "
                                                               "table 'semantic_kitti'"),
    (np.zeros((5, 4), np.float32), None, 'labels: expected whole numbers, found object'),
    (np.zeros((5, 4), np.float32), 'text', 'labels: expected whole numbers'),
    (np.zeros((5, 2), np.float32), np.zeros(5, int), r'points: expected shape \(N, 3 or more\).*found \(5, 2\)'),
    (np.zeros(12, np.float32), np.zeros(4, int), r'points: expected shape .*found \(12,\)'),
    (np.zeros((2, 2, 2, 3), np.float32), np.zeros(4, int), r'points: expected shape .*found \(2, 2, 2, 3\)'),
    (np.zeros((5, 4), np.int32), np.zeros(5, int), 'points: expected floating-point numbers, found int32'),
    (np.zeros((5, 4), complex), np.zeros(5, int), 'points: expected floating-point numbers, found complex128'),
    (np.zeros((2, 3, 4), np.float32), np.zeros(6, int), r'labels: expected shape \(2, 3\).*found \(6,\)'),
    (object(), np.zeros(6, int), 'points: expected floating-point numbers, found object'),
])
def test_errors_say_what_was_expected_and_found(segmenter, points, labels, words):
    with pytest.raises(ValueError, match=words):
        segmenter(points, labels)


def test_errors_of_ring(scan, segmenter):
    points, labels, _ = scan
    with pytest.raises(ValueError, match=r'ring: expected shape'):
        segmenter(points, labels, ring=np.zeros(3, int))
    with pytest.raises(ValueError, match='ring: expected whole numbers, found float64'):
        segmenter(points, labels, ring=np.zeros(len(points)))
    with pytest.raises(ValueError, match='ring: .* found -1 at point 0'):
        segmenter(points, labels, ring=np.full(len(points), -1))


@pytest.mark.parametrize('algorithm, parameters, words', [
    ('birdseye', {}, 'no algorithm .birdseye.*birds_eye'),
    ('depth', {'theta': 5}, "no parameter 'theta'.*theta_deg.*class_table.*layout"),
    ('depth', {'theta_deg': 90}, "'theta_deg': expected a number from 0.1 to 89, got 90"),
    ('depth', {'theta_deg': 'wide'}, "'theta_deg': expected a number .*got 'wide'"),
    ('depth', {'theta_deg': float('nan')}, "'theta_deg': expected a number"),
    ('depth', {'split': 3}, "'split': expected true or false, got 3"),
    ('depth', {'min_points': 2.5}, "'min_points': expected a whole number"),
    ('depth', {'min_points': None}, "'min_points': expected a bool, a number or text, found NoneType"),
    ('depth', {'min_points': 10 ** 400}, 'min_points'),
    ('depth', {'class_table': 'semantic_kity'}, 'semantic_kity'),
    ('depth', {'class_table': '/nowhere/table.yaml'}, '/nowhere/table.yaml'),
    ('depth', {'label_table': 'nuscene'}, 'nuscene'),
    ('depth', {'layout': 'rings'}, "'layout': expected one of 'auto'"),
    ('depth', {'layout': 'beams'}, 'sensor'),
    ('depth', {'sensor': 'vlp99'}, 'vlp99'),
    ('depth', {'columns': 5}, 'columns'),
    ('depth', {'rows': 0}, "'rows': expected a whole number from 1 to 1024, got 0"),
])
def test_errors_of_parameters(algorithm, parameters, words):
    with pytest.raises(ValueError, match=words):
        lpc.Segmenter(algorithm, **parameters)


def test_parameters_of_numpy_and_paths(tmp_path, scan):
    points, labels, _ = scan
    table = tmp_path / 'table.yaml'
    table.write_text('')
    with pytest.raises(ValueError, match='table.yaml'):
        lpc.Segmenter(class_table=table)
    segmenter = lpc.Segmenter('depth', min_points=np.int64(3), theta_deg=np.float32(5), vote=np.bool_(False))
    assert segmenter.parameters['vote'] is False
    assert segmenter(points, labels).max() > 3


def test_a_call_lets_other_threads_run(scan):
    """The GIL is released: this thread goes on counting while another one's call works."""
    points, labels, _ = scan
    many, classes = np.tile(points, (8, 1)), np.tile(labels, 8)
    segmenter = lpc.Segmenter('euclidean', rows=1024, voxel_m=0.01)
    times = []

    def work():
        start = time.perf_counter()
        segmenter(many, classes)
        times.extend((start, time.perf_counter()))

    worker = threading.Thread(target=work)
    ticks = []
    worker.start()
    while worker.is_alive():
        ticks.append(time.perf_counter())
        time.sleep(0.001)
    start, end = times
    assert end - start > 0.05
    # were it held, nobody would tick between the call's beginning and its end
    inside = [t for t in ticks if start + 0.2 * (end - start) < t < end - 0.2 * (end - start)]
    assert len(inside) > 3


def test_one_segmenter_in_many_threads(scan, expected):
    points, labels, _ = scan
    segmenter = lpc.Segmenter('birds_eye')
    cut = segmenter(points[:20000], labels[:20000])
    wrong = []

    def work(count, reference):
        for _ in range(8):
            if not np.array_equal(segmenter(points[:count], labels[:count]), reference):
                wrong.append(count)
            len(segmenter.objects)

    workers = [threading.Thread(target=work, args=given)
               for given in ((len(points), expected), (20000, cut)) for _ in range(2)]
    for worker in workers:
        worker.start()
    for worker in workers:
        worker.join()
    assert wrong == []


def test_nothing_is_leaked(scan, segmenter):
    points, labels, _ = scan
    before = sys.getrefcount(points), sys.getrefcount(labels)
    for _ in range(3):
        segmenter(points, labels)
        with pytest.raises(ValueError):
            segmenter(points, labels[:-1])
    assert (sys.getrefcount(points), sys.getrefcount(labels)) == before
