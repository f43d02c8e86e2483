#!/usr/bin/env python3
"""Writes test/fuzz/corpus: what fuzzers found, and an ordinary input of each kind to begin with."""
import json
import math
import pathlib
import struct

HERE = pathlib.Path(__file__).resolve().parent
ALGORITHMS = ('euclidean', 'supervoxel', 'depth', 'scan_line_run', 'birds_eye')
# 29 returns a metre apart, of which PCL made 30 supervoxels: a component of an id that no array had
OVERFLOW = ((37.5851898, -1.14850283, -.859377325), (38.5070076, -2.75324106, .568704009),
            (38.5072784, 3.31792212, -1.01061451), (38.3421135, 1.15134084, -.989667177),
            (39.6890144, 3.71784163, .549791873), (43.5460663, -.517626345, -.130458459),
            (39.6705284, .762029469, .328913093), (38.5943756, 2.75488281, .892648458),
            (38.7209282, -.16045545, -.878596127), (37.3699226, -2.16053915, 1.03895974),
            (40.3631325, -3.23377252, .751641214), (41.2993927, -3.26777768, -.73685497),
            (43.9549294, 2.32972693, .580258727), (42.7743568, -2.4187696, .380243599),
            (36.1679306, 1.18471014, -.132751361), (37.4885178, .205950007, .462219596),
            (43.4054718, -3.56959867, -.519802153), (36.9703827, 3.4554739, .528655529),
            (41.544445, -3.02119708, .336752236), (42.938549, -.833413839, .96204865),
            (39.9891014, -.721747577, -.921661854), (42.7680588, 2.4061749, -.414779663),
            (40.1124992, -1.81770074, .47596705), (36.7658463, -3.13617253, -.0477089919),
            (43.8290939, 3.7020402, .133209288), (44.2379799, -1.67393196, .0281106271),
            (39.9904709, 1.78733408, .14313145), (41.2873955, 1.56770015, .478809983),
            (36.3110695, -1.19178283, .0212875716))
TABLE = 'classes: [{name: car, kind: thing, ids: [%s], color: [0, 0, 0], size: [%s], link: %s}]\n'
SENSOR = 'elevations_deg: [2, 1.5, -3]\ncolumns: %s\nmax_range_m: %s\nhorizontal_fov_deg: 90\n'
# what yaml-cpp 0.6 reads for ever
COLONS = {'colon_at_end': 'classes: [{name: car, kind: thing, ids: [10, 10], color:',
          'colon_before_bracket': 'elevations_deg: [2, 1.5:]\ncolumns: 1024\n',
          'colon_before_byte_4': 'elevations_deg: [2, 1.5:\4',
          'colon_alone': 'classes: [:]\n'}


def scan(algorithm, rows, choice, near, points):
    data = bytes((ALGORITHMS.index(algorithm), rows - 1, choice, near))
    return data + b''.join(struct.pack('<3fB', *p[:3], p[3] if len(p) > 3 else 0) for p in points)


def street(rows, columns):
    """A wall of things of several classes around, with gaps."""
    for row in range(rows):
        for column in range(columns):
            azimuth, distance = 2 * math.pi * column / columns, 6 + 3 * (column // 7 % 3)
            yield (distance * math.cos(azimuth), -distance * math.sin(azimuth), 0.4 * row, column // 7 % 6)


def report():
    counts = {'tp': 3, 'fp': 1, 'fn': 0, 'iou_sum': {'whole': 2, 'fraction_2_53': 5},
              'points': {'both': 9, 'predicted': 10, 'true': 11}}
    return {'class_table': 'two', 'min_points': 50, 'scans': 4,
            'per_class': {'car': dict(counts, kind='thing'), 'road': dict(counts, kind='stuff')},
            'true_objects': {'matched': 3, 'split': 1, 'merged': 0, 'missed': 2},
            'skipped': [{'scan': '08/000001', 'reason': 'short'}]}


def benchmark():
    frames = [{'scan': '08/000000', 'points': 9, 'thing_points': 5, 'cluster_ms': 0.5, 'pipeline_ms': 1.5}]
    return {'rows': ['depth'], 'interrupted': False, 'times': {'depth': {'frames': frames}},
            'quality': {'semantics': 'net', 'scans': {'08': 4}, 'before_clustering': report(),
                        'rows': {'depth': report()}}}


def cloud(layout, height, width, fields, points):
    """fields: (name's place in the fuzzer's list, offset, datatype); points: x, y, z, label."""
    header = struct.pack('<BHHHBBB', layout, height, width, 16, 0, 0, len(fields))
    header += b''.join(struct.pack('<BHBB', name, offset, datatype, 0) for name, offset, datatype in fields)
    return header + b''.join(struct.pack('<3fI', *p) for p in points)


def dataset(points, labels, poses, times, calib):
    parts = [b''.join(struct.pack('<4f', *p) for p in points), b''.join(struct.pack('<I', n) for n in labels),
             poses.encode(), times.encode()]
    return struct.pack('<4H', *map(len, parts)) + b''.join(parts) + calib.encode()


def corpus():
    yield 'class_table', 'ordinary', TABLE % ('10, 252', '4.5, 1.8', 0.8)
    yield 'class_table', 'id_twice_in_one_class', TABLE % ('10, 10', '4, 2', 1)
    yield 'class_table', 'negative_id', TABLE % ('-1', '4, 2', 1)
    for number in ('1e-30', '1e30', '.nan', '.inf'):
        yield 'class_table', 'link_' + number.strip('.'), TABLE % ('10', '4, 2', number)
        yield 'class_table', 'size_' + number.strip('.'), TABLE % ('10', number + ', ' + number, 1)
    yield 'class_table', 'nested', 'classes: ' + '[' * 5000
    yield 'class_table', 'itself', 'classes: &a [*a]\n'
    yield 'class_table', 'bomb', 'a: &a [x, x, x]\nb: &b [*a, *a, *a]\nc: &c [*b, *b, *b]\nclasses: [*c, *c]\n'
    for name, text in COLONS.items():
        yield 'class_table', name, text
        yield 'sensor_model', name, text
    yield 'sensor_model', 'ordinary', SENSOR % (1024, 120)
    yield 'sensor_model', 'negative', SENSOR % (-1, -1)
    yield 'sensor_model', 'endless', SENSOR % (1024, '.inf')
    yield 'sensor_model', 'many', SENSOR % (4294967296, '1e30')
    yield 'report', 'evaluation', json.dumps(report())
    yield 'report', 'benchmark', json.dumps(benchmark())
    yield 'report', 'nested', '{"class_table":"two","min_points":' + '[' * 5000 + ']' * 5000 + '}'
    yield 'report', 'float_for_count', json.dumps(benchmark()).replace('"points": 9, "thing', '"points": 1e300, "thing')
    yield 'report', 'escape', json.dumps(benchmark()).replace('net', '\\u001b[2J')
    yield 'dataset', 'ordinary', dataset([(5, 1, 0, .5)] * 20, [10] * 20, '1 0 0 0 0 1 0 0 0 0 1 0\n', '0.1\n',
                                         'Tr: 0 -1 0 0 0 0 -1 0 1 0 0 0\n')
    yield 'dataset', 'wild_numbers', dataset([(math.nan, math.inf, 1e30, 1e-30)] * 5, [2**32 - 1] * 5,
                                             '1e300 ' * 12 + '\n', '1e300\n', 'Tr: nan\n')
    yield 'dataset', 'short', dataset([(5, 1, 0, .5)] * 3, [10] * 2, '1 2\n', 'x\n', '')[:40]
    for algorithm in ALGORITHMS:
        yield 'clusterers', algorithm, scan(algorithm, 4, 0, 1, street(4, 40))
        yield 'clusterers', algorithm + '_wild', scan(algorithm, 2, 12, 0, [
            (math.nan, 1, 1), (math.inf, 1, 1), (9999, 9, 0), (-9999, -9, 0), (1e-30, 0, 0), (1e30, 1, 1), (0, 0, 5)])
    yield 'clusterers', 'supervoxel_without_voxels', scan('supervoxel', 1, 0, 0, OVERFLOW)
    yield 'clusterers', 'supervoxel_border', scan('supervoxel', 1, 0, 0, [(-4, -8, .5), (-3, -8e-23, .5)])  # PCL 1.10
    yield 'clusterers', 'tiny_distance', scan('birds_eye', 1, 1, 0, [(-70.00003, 3, 0), (1412.8, 3, 0)])
    xyz_label = [(0, 0, 7), (1, 4, 7), (2, 8, 7), (5, 12, 6)]
    points = [(x, y, z, (10, 252, 30, 18, 40, 7)[int(c)]) for x, y, z, c in street(4, 40)]
    for layout in range(8):
        yield 'raw_cloud', f'organised_{layout}', cloud(32 + layout, 4, 40, xyz_label, points)
        yield 'raw_cloud', f'one_row_{layout}', cloud(32 + layout, 1, 160, xyz_label, points)
        yield 'raw_cloud', f'nothing_{layout}', cloud(32 + layout, 4, 0, xyz_label, [])
    yield 'raw_cloud', 'offset_too_far', cloud(32, 4, 40, [(0, 65535, 7)] + xyz_label[1:], points)


for target, name, content in corpus():
    folder = HERE / 'corpus' / target
    folder.mkdir(parents=True, exist_ok=True)
    (folder / name).write_bytes(content.encode() if isinstance(content, str) else content)
