#!/usr/bin/env python3
"""Holds package.xml to the keys that rosdep knows (test/rosdep_keys.txt) and to what the files use."""
import pathlib
import re
import sys
import unittest
import xml.etree.ElementTree as ElementTree

ROOT = pathlib.Path(__file__).resolve().parent.parent
PACKAGE = 'lidar_panoptic_clustering'
# first folder of a header, or a header, whose package has another name
PACKAGE_OF = {'ros': 'roscpp', 'ros/package.h': 'roslib', 'rosbag': 'rosbag_storage', 'Eigen': 'eigen', 'pcl': 'libpcl-all-dev',
              'nlohmann': 'nlohmann-json-dev', 'cairo.h': 'libcairo2-dev'}
LIBRARY_TAGS = {'depend', 'build_depend'}
RUN_TAGS = {'depend', 'exec_depend'}
ALL_TAGS = LIBRARY_TAGS | RUN_TAGS | {'test_depend'}


def known_keys():
    lines = (ROOT / 'test' / 'rosdep_keys.txt').read_text().splitlines()
    return {line.strip() for line in lines if line.strip() and not line.startswith('#')}


def declared(xml, tags):
    return {element.text.strip() for element in ElementTree.fromstring(xml) if element.tag in tags}


def package_of(header, keys):
    """The key of the package that a header in angle brackets belongs to, None for those of the system."""
    folder = header.split('/')[0]
    key = PACKAGE_OF.get(header) or PACKAGE_OF.get(folder) or folder
    return key if key in keys else None


def used_headers(*folders):
    """The headers in angle brackets of all sources below `folders`."""
    found = set()
    for folder in folders:
        for path in (ROOT / folder).rglob('*'):
            if path.suffix in ('.h', '.cpp', '.in'):
                found.update(re.findall(r'^#include <([^>]+)>', path.read_text(), re.MULTILINE))
    return found


def launched(folder, pattern):
    """The packages whose programs the launch files of a folder start."""
    found = set()
    for path in (ROOT / folder).glob(pattern):
        found.update(re.findall(r'\bpkg="([^"$]+)"', path.read_text()))
    return found - {PACKAGE}


def python_packages(folder, keys):
    """The ROS packages that the python files of a folder import."""
    found = set()
    for path in (ROOT / folder).rglob('*.py'):
        found.update(re.findall(r'^\s*(?:import|from) (\w+)', path.read_text(), re.MULTILINE))
    return found & keys


class PackageKeys(unittest.TestCase):
    def setUp(self):
        self.xml = (ROOT / 'package.xml').read_text()
        self.keys = known_keys()

    def test_rosdep_knows_every_key(self):
        tags = ALL_TAGS | {'buildtool_depend', 'build_export_depend', 'doc_depend'}
        self.assertEqual(sorted(declared(self.xml, tags) - self.keys), [])

    def test_an_unknown_key_is_found(self):
        wrong = self.xml.replace('libcairo2-dev', 'cairo')
        self.assertEqual(declared(wrong, ALL_TAGS) - self.keys, {'cairo'})

    def test_the_libraries_and_programs_have_what_they_include(self):
        used = {package_of(header, self.keys) for header in used_headers('include', 'src', 'benchmark')} - {None}
        self.assertGreater(len(used), 15)
        self.assertEqual(sorted(used - declared(self.xml, LIBRARY_TAGS)), [])

    def test_the_tests_have_what_they_include(self):
        used = {package_of(header, self.keys) for header in used_headers('test')} - {None}
        self.assertIn('rosgraph_msgs', used)
        self.assertEqual(sorted(used - declared(self.xml, ALL_TAGS)), [])

    def test_launch_files_have_what_they_start(self):
        self.assertIn('nodelet', launched('launch', '*.launch'))
        self.assertEqual(sorted(launched('launch', '*.launch') - declared(self.xml, RUN_TAGS)), [])
        self.assertIn('rosbag', launched('test/ros', '*.test'))
        self.assertEqual(sorted(launched('test/ros', '*.test') - declared(self.xml, ALL_TAGS)), [])

    def test_python_has_what_it_imports(self):
        self.assertEqual(sorted(python_packages('test', self.keys) - declared(self.xml, ALL_TAGS)), [])

    def test_catkin_finds_only_what_is_declared(self):
        cmake = (ROOT / 'CMakeLists.txt').read_text()
        components = re.search(r'find_package\(catkin REQUIRED COMPONENTS([^)]*)\)', cmake).group(1).split()
        self.assertIn('roscpp', components)
        self.assertEqual(sorted(set(components) - declared(self.xml, LIBRARY_TAGS)), [])


if __name__ == '__main__':
    sys.exit(unittest.main())
