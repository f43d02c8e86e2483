#!/usr/bin/env python3
"""Builds the packages in examples/ as a user does, against the built or the installed library, and runs them.

usage: examples_test.py --prefix DIR --work DIR [WithoutRos|CatkinPackage]...

`prefix` is a devel space or a place of installation; the examples are built in `work`.
"""
import argparse
import math
import os
import pathlib
import re
import signal
import struct
import subprocess
import sys
import unittest

ROOT = pathlib.Path(__file__).resolve().parent.parent
options = argparse.Namespace(prefix='', work='')


def run(*command, **arguments):
    """What a command prints; what it printed until it failed stands in the exception."""
    done = subprocess.run([str(c) for c in command], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                          **arguments)
    if done.returncode != 0:
        raise AssertionError(f'{" ".join(map(str, command))} ended with {done.returncode}:\n{done.stdout[-4000:]}')
    return done.stdout


def build(name, *arguments):
    """Builds an example in a folder outside of it, warnings as errors; the folder."""
    folder = pathlib.Path(options.work) / name
    run('cmake', '-S', ROOT / 'examples' / name, '-B', folder, '-DCMAKE_BUILD_TYPE=Release',
        '-DCMAKE_CXX_FLAGS=-Wall -Wextra -Werror', f'-DCMAKE_PREFIX_PATH={options.prefix}', *arguments)
    run('cmake', '--build', folder)
    return folder


def range_to_scene(azimuth, elevation, walls):
    """The distance from a lidar 1.73 m above a street to a box of 4 x 2 x 1.5 m at (10, 3) m, or to what is behind it:
    flat ground and, where asked for, walls 25 m to the left and the right."""
    direction = (math.cos(elevation) * math.cos(azimuth), math.cos(elevation) * math.sin(azimuth), math.sin(elevation))
    near, far = 0.0, math.inf
    for d, low, high in zip(direction, (8.0, 2.0, -1.73), (12.0, 4.0, -0.23)):
        ends = sorted((bound / d) if d else math.copysign(math.inf, bound) for bound in (low, high))
        near, far = max(near, ends[0]), min(far, ends[1])
    if near < far:
        return near
    ground = -1.73 / direction[2] if direction[2] < 0.0 else math.inf
    behind = min(ground, 25.0 / abs(direction[1]) if walls and direction[1] else math.inf)
    return behind if behind < 80.0 else None


def write_scan(path, walls):
    """A scan of that scene as KITTI stores it: ring after ring, the highest first, float32 x y z intensity."""
    with open(path, 'wb') as file:
        for ring in range(64):
            elevation = math.radians(2.0 - 26.8 * ring / 63.0)
            for firing in range(1500):
                azimuth = 2.0 * math.pi * firing / 1500.0
                distance = range_to_scene(azimuth, elevation, walls)
                if distance is not None:
                    flat = distance * math.cos(elevation)
                    file.write(struct.pack('<4f', flat * math.cos(azimuth), flat * math.sin(azimuth),
                                           distance * math.sin(elevation), 0.5))


class WithoutRos(unittest.TestCase):
    def test_prints_the_object_of_a_scan(self):
        folder = build('without_ros')
        scan = folder / 'scan.bin'
        for walls in (True, False):  # without them nothing is as high as the sensor
            with self.subTest(walls=walls):
                self.check_scan(folder, scan, walls)

    def check_scan(self, folder, scan, walls):
        write_scan(scan, walls)
        printed = run(folder / 'scan_objects', scan)
        points = re.match(r'(\d+) points, \d+ objects\n', printed)
        self.assertTrue(points and int(points.group(1)) * 16 == scan.stat().st_size, printed)
        found = re.findall(r'^(\w+) \d+: (\d+) points at \(([-\d.]+), ([-\d.]+)\) m', printed, re.MULTILINE)
        self.assertEqual(len(found), 1, printed)
        name, count, x, y = found[0]
        self.assertEqual(name, 'object')
        self.assertGreater(int(count), 200)
        self.assertLess(math.hypot(float(x) - 10.0, float(y) - 3.0), 1.5, printed)

    def test_says_what_is_wrong_with_a_file(self):
        folder = build('without_ros')
        done = subprocess.run([folder / 'scan_objects', '/nowhere.bin'], stderr=subprocess.PIPE, text=True)
        self.assertEqual((done.returncode, done.stderr), (1, 'scan_objects: no points in /nowhere.bin\n'))


class CatkinPackage(unittest.TestCase):
    def test_its_nodelet_gives_instances(self):
        folder = build('catkin_package', '-DCATKIN_ENABLE_TESTING=OFF', '-DPYTHON_EXECUTABLE=/usr/bin/python3')
        cache = (folder / 'CMakeCache.txt').read_text()
        self.assertNotIn('LIDAR_PANOPTIC', cache)  # it takes no more from us than find_package() gives
        read, write = os.pipe()
        host = os.environ.get('ROS_HOSTNAME') or os.environ.get('ROS_IP', '')
        launch = subprocess.Popen(
            ['bash', '-c', 'source "$0/devel/setup.bash" && exec "$@"', folder, sys.executable,
             ROOT / 'scripts' / 'launch.py', str(write), host or 'localhost', '', 'grid_clustering_example',
             'example.launch'], pass_fds=[write], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        try:
            os.close(write)
            with os.fdopen(read) as address:
                os.environ["ROS_MASTER_URI"] = address.readline().strip()
            import rospy
            from sensor_msgs.msg import PointCloud2
            from sensor_msgs import point_cloud2
            rospy.init_node('examples_test', disable_signals=True)
            cloud = rospy.wait_for_message('/grid/output', PointCloud2, timeout=60.0)
            labels = list(point_cloud2.read_points(cloud, ('label', 'instance')))
        finally:
            launch.send_signal(signal.SIGTERM)
            errors = launch.communicate()[1]
        self.assertEqual(len(labels), cloud.width * cloud.height, errors)
        instances = {instance for _, instance in labels} - {0}
        self.assertGreater(len(instances), 3)
        self.assertEqual(instances, set(range(1, len(instances) + 1)))
        for instance in instances:  # an instance is of one class
            self.assertEqual(len({label for label, i in labels if i == instance}), 1)


if __name__ == '__main__':
    parser = argparse.ArgumentParser()
    parser.add_argument('--prefix', required=True)
    parser.add_argument('--work', required=True)
    _, left = parser.parse_known_args(namespace=options)
    options.prefix, options.work = os.path.abspath(options.prefix), os.path.abspath(options.work)
    unittest.main(argv=[sys.argv[0]] + left)
