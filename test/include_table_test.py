#!/usr/bin/env python3
"""Holds the includes of include/ and src/ to the table of folders in doc/architecture.md."""
import pathlib
import re
import sys
import unittest

ROOT = pathlib.Path(__file__).resolve().parent.parent
PACKAGE = 'lidar_panoptic_clustering'
ROS_FOLDERS = {'ros', 'reporting', 'nodelets', 'manager', 'bags'}
ROS_HEADERS = re.compile(r'(ros|nodelet|pluginlib|pcl_ros|pcl_conversions|rosbag|tf2\w*|diagnostic_updater|'
                         r'dynamic_reconfigure|\w+_msgs|std_srvs|xmlrpcpp)/')


def read_table(text):
    """The folders that each folder may include, from rows of the form | `folder/` | holds | a, b |."""
    rows = re.findall(r'^\| `(\w+)/` \|[^|]*\|([^|]*)\|$', text, re.MULTILINE)
    return {folder: {name.strip() for name in allowed.split(',') if name.strip()} for folder, allowed in rows}


def read_includes(root):
    """(file, folder, what it includes, whether in angle brackets) of every include below include/ and src/."""
    for base in (root / 'include' / PACKAGE, root / 'src'):
        for path in sorted(base.rglob('*')):
            if path.suffix in ('.h', '.cpp'):
                folder = path.relative_to(base).parts[0]
                for bracket, name in re.findall(r'^#include ([<"])([^>"]+)', path.read_text(), re.MULTILINE):
                    yield path.relative_to(root), folder, name, bracket == '<'


def violations(table, includes):
    """What the table does not allow, as lines to be read."""
    found = []
    for path, folder, name, is_system in includes:
        if folder not in table:
            found.append(f'{path}: folder {folder}/ has no row in doc/architecture.md')
        elif is_system:
            if folder not in ROS_FOLDERS and ROS_HEADERS.match(name):
                found.append(f'{path}: {folder}/ knows no ROS, but includes <{name}>')
        else:
            parts = name.split('/')
            target = parts[1] if parts[0] == PACKAGE else parts[0]
            if len(parts) > 1 and target != folder and target not in table[folder]:
                found.append(f'{path}: {folder}/ may not include {target}/ ({name})')
    return found


class IncludeTable(unittest.TestCase):
    def setUp(self):
        self.table = read_table((ROOT / 'doc' / 'architecture.md').read_text())

    def test_every_folder_has_a_row_and_every_row_a_folder(self):
        folders = {p.name for base in (ROOT / 'include' / PACKAGE, ROOT / 'src') for p in base.iterdir() if p.is_dir()}
        self.assertEqual(folders, set(self.table))

    def test_rows_name_folders(self):
        for folder, allowed in self.table.items():
            self.assertLessEqual(allowed, set(self.table), folder)

    def test_includes_follow_the_table(self):
        includes = list(read_includes(ROOT))
        self.assertGreater(len(includes), 500)
        self.assertEqual(violations(self.table, includes), [])

    def test_a_wrong_include_is_found(self):
        wrong = [('a.cpp', 'core', PACKAGE + '/pipeline/factory.h', False), ('b.cpp', 'core', 'ros/ros.h', True),
                 ('c.cpp', 'cellar', 'x/y.h', False), ('d.cpp', 'geometry', PACKAGE + '/core/parameters.h', False)]
        self.assertEqual(len(violations(self.table, wrong)), 3)


if __name__ == '__main__':
    sys.exit(unittest.main())
