#!/usr/bin/env python3
"""Holds the files of each algorithm to doc/architecture.md, "Your own algorithm": none of the six places is forgotten."""
import pathlib
import re
import subprocess
import sys
import unittest

ROOT = pathlib.Path(__file__).resolve().parent.parent
PACKAGE = 'lidar_panoptic_clustering'


def camel_case(algorithm):
    """scan_line_run -> ScanLineRun, as cluster.launch makes it."""
    return algorithm.title().replace('_', '')


class AlgorithmFiles(unittest.TestCase):
    def setUp(self):
        factory = (ROOT / 'src' / 'pipeline' / 'factory.cpp').read_text()
        self.algorithms = re.findall(r'entry<\w+>\("(\w+)"\)', factory)
        self.assertGreater(len(self.algorithms), 4)

    def test_each_has_its_files(self):
        for name in self.algorithms:
            for path in (f'include/{PACKAGE}/clusterers/{name}_clusterer.h', f'src/clusterers/{name}_clusterer.cpp',
                         f'cfg/{camel_case(name)}Cluster.cfg', f'src/nodelets/{name}_cluster_nodelet.cpp'):
                self.assertTrue((ROOT / path).is_file(), f'algorithm {name}: there is no {path}')

    def test_each_cfg_file_is_executable_and_named_after_its_algorithm(self):
        for name in self.algorithms:
            path = ROOT / 'cfg' / f'{camel_case(name)}Cluster.cfg'
            self.assertTrue(path.stat().st_mode & 0o100, f'chmod +x {path.name}')
            self.assertIn(f'"{camel_case(name)}Cluster"', path.read_text(), path.name)

    def test_each_nodelet_is_a_plug_in(self):
        plug_ins = re.findall(rf'<class name="{PACKAGE}/(\w+)ClusterNodelet"',
                              (ROOT / 'nodelet_plugins.xml').read_text())
        self.assertEqual(sorted(plug_ins), sorted(camel_case(name) for name in self.algorithms))

    def test_ranges_with_a_gap_are_told(self):
        """dynamic_reconfigure knows one range: what takes 0, or from a least distance on, has to say so in words."""
        header = (ROOT / 'include' / PACKAGE / 'core' / 'parameters.h').read_text()
        least = re.search(r'kLeastDistanceM = ([\d.]+);', header).group(1)
        sources = ''.join(path.read_text() for path in (ROOT / 'src').rglob('*.cpp'))
        names = set(re.findall(r'requireOffOrDistance\("(\w+)"', sources))
        self.assertGreater(len(names), 2)
        page = (ROOT / 'doc' / 'topics_and_parameters.md').read_text()
        for path in list((ROOT / 'cfg').glob('*.cfg')) + [ROOT / 'cfg' / 'pipeline_parameters.py']:
            for call in re.findall(r'generator\.add\((.*?)\)\n', path.read_text(), re.S):
                name = re.match(r'"(\w+)"', call).group(1)
                said = f'else from {least}' in re.sub(r'"\s+"', '', call)
                self.assertEqual(said, name in names, f'{path.name}: {name}')
        for name in names:
            self.assertRegex(page, rf'`{name}` \| [\d.]+ \| 0, or {least} to ', name)

    def test_the_demo_takes_each(self):
        answer = subprocess.run([ROOT / 'demo', '--algorithm', 'sonar'], capture_output=True, text=True, check=False)
        self.assertEqual(answer.returncode, 2)
        named = re.search(r"--algorithm is 'sonar', expected some of (.*), or all", answer.stderr)
        self.assertIsNotNone(named, answer.stderr)
        self.assertEqual(sorted(named.group(1).split(', ')), sorted(self.algorithms))


if __name__ == '__main__':
    sys.exit(unittest.main())
