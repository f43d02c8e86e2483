#!/usr/bin/env python3
"""Runs ./demo on what was built: two at once, on a master that is told, and ended in its first seconds.

usage: demo_test.py DEVEL_SPACE [unittest's arguments]
"""
import os
import pathlib
import re
import signal
import subprocess
import sys
import tempfile
import time
import unittest

ROOT = pathlib.Path(__file__).resolve().parent.parent
devel = ''


def processes_with(text):
    """The command lines of the processes whose environment holds a text."""
    found = []
    for process in pathlib.Path('/proc').glob('[0-9]*'):
        try:
            if text.encode() in (process / 'environ').read_bytes():
                found.append((process / 'cmdline').read_bytes().replace(b'\0', b' ').decode())
        except OSError:  # another user's, or gone
            pass
    return found


class Demo(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory(prefix='lidar_panoptic_demo_test_')
        self.addCleanup(scratch.cleanup)
        self.scratch = scratch.name

    def start(self, *arguments):
        """A demo of a few points, in a process group as in a terminal. Its files go to the scratch folder, whose name
        marks what it starts."""
        environment = dict(os.environ, TMPDIR=self.scratch)
        return subprocess.Popen([ROOT / 'demo', '--headless', '--sensor', 'vlp16', '--devel', devel, *arguments],
                                env=environment, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                                start_new_session=True)

    @staticmethod
    def press_ctrl_c(demo):
        os.killpg(demo.pid, signal.SIGINT)

    def test_two_started_at_once_both_run(self):
        demos = [self.start('--frames', '3') for _ in range(2)]
        masters = set()
        for demo in demos:
            printed, errors = demo.communicate(timeout=120)
            self.assertEqual(demo.returncode, 0, printed + errors)
            self.assertIn('done: 3 of 3 frames of each algorithm', printed)
            masters.update(re.findall(r'^  export ROS_MASTER_URI=(http://\S+:\d+)$', printed, re.MULTILINE))
        self.assertEqual(len(masters), 2)
        self.assertFalse([m for m in masters if m.endswith(':11311')])  # a vehicle's
        self.assertEqual(processes_with(self.scratch), [])

    def test_one_name_on_one_master_is_refused_and_another_runs(self):
        first = self.start()
        try:
            lines = []
            while not re.match(r' +2 birds_eye', lines[-1] if lines else ''):
                lines.append(first.stdout.readline())
                self.assertNotEqual(lines[-1], '', lines)
            master = re.search(r'ROS_MASTER_URI=(\S+)', ''.join(lines)).group(1)

            same = self.start('--frames', '1', '--master', master)
            errors = same.communicate(timeout=60)[1]
            self.assertEqual(same.returncode, 1)
            self.assertRegex(errors, r'the node /lidar_panoptic_demo/\w+ runs on \S+ already: --namespace gives')

            other = self.start('--frames', '1', '--master', master, '--namespace', 'other')
            printed, errors = other.communicate(timeout=120)
            self.assertEqual(other.returncode, 0, printed + errors)
            self.assertIsNone(first.poll())
        finally:
            self.press_ctrl_c(first)
            printed, _ = first.communicate(timeout=60)
        self.assertEqual(first.returncode, 0)  # it has shown what it had to
        self.assertIn('Summary:', printed)
        self.assertEqual(processes_with(self.scratch), [])

    def test_ended_in_its_first_seconds_it_leaves_nothing(self):
        for seconds in (0.3, 1.0, 1.7, 2.4, 3.5):
            demo = self.start()
            time.sleep(seconds)
            self.press_ctrl_c(demo)
            ended = time.monotonic()
            printed, errors = demo.communicate(timeout=60)
            self.assertLess(time.monotonic() - ended, 30.0, seconds)
            # where it has shown frames by then, it has done what it was asked to
            expected = 0 if 'Summary:' in printed else 130
            # ended by the signal itself, in another bash, is 130 to whoever started it too
            code = 128 - demo.returncode if demo.returncode < 0 else demo.returncode
            self.assertEqual((code, errors), (expected, ''), printed)
            self.assertEqual(processes_with(self.scratch), [], seconds)


if __name__ == '__main__':
    devel = sys.argv.pop(1)
    unittest.main()
