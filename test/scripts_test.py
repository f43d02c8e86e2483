#!/usr/bin/env python3
"""What ./check and ./demo do on systems that are not as they wish: in copies of the scripts, with nothing built."""
import os
import pathlib
import shutil
import stat
import subprocess
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parent.parent
NOBODY = 65534


class Scripts(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix='lidar_panoptic_scripts_'))
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)
        self.folder.chmod(0o755)

    def copy_scripts(self, name):
        """A tree of ours, with a package that is configured and built in no time."""
        tree = self.folder / name
        shutil.copytree(ROOT / 'scripts', tree / 'scripts')
        for program in ('check', 'demo'):
            shutil.copy(ROOT / program, tree)
        for folder in ('cfg', 'cmake', 'config', 'include', 'src'):
            (tree / folder).mkdir()
        (tree / 'package.xml').touch()
        (tree / 'CMakeLists.txt').write_text('cmake_minimum_required(VERSION 3.16)\nproject(tiny NONE)\n'
                                             'add_custom_target(thing COMMAND ${CMAKE_COMMAND} -E echo made)\n')
        return tree

    def bash(self, tree, script, **arguments):
        """Runs a script that has sourced ours."""
        return subprocess.run(['bash', '-c', 'set -euo pipefail; source scripts/dependencies.sh; source scripts/build.sh\n'
                               'ros_setup=/nowhere\n' + script, 'check'], cwd=tree, stdout=subprocess.PIPE,
                              stderr=subprocess.PIPE, text=True, **arguments)

    def build(self, tree, **arguments):
        return self.bash(tree, 'build "$root/build" -DX=1 thing', **arguments)

    def test_a_folder_that_make_takes_apart_is_refused(self):
        for name in ('with space', 'semi;colon', "quote's", 'dollar$'):
            tree = self.copy_scripts(name)
            for program in ('check', 'demo'):
                done = subprocess.run([tree / program], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
                self.assertEqual((done.returncode, done.stdout), (1, ''), name)
                self.assertIn(f"the folder is '{tree}': move it to a path without spaces", done.stderr)
                self.assertEqual(done.stderr.count('\n'), 1)

    def test_a_folder_is_built_once(self):
        tree = self.copy_scripts('tree')
        first, second = self.build(tree), self.build(tree)
        self.assertEqual((first.returncode, second.returncode), (0, 0), first.stderr + second.stderr)
        self.assertIn('Configuring', first.stdout)
        self.assertNotIn('Configuring', second.stdout)

    def test_a_moved_or_copied_folder_is_configured_afresh(self):
        tree = self.copy_scripts('tree')
        self.assertEqual(self.build(tree).returncode, 0)
        (tree / 'build' / 'old').touch()
        copy = self.folder / 'copy'
        subprocess.run(['cp', '-a', tree, copy], check=True)
        moved = tree.rename(self.folder / 'moved')
        for place in (copy, moved):
            done = self.build(place)
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertIn(f'{place}/build was configured elsewhere, as {tree}/build: built afresh', done.stdout)
            self.assertIn('made', done.stdout)
            self.assertFalse((place / 'build' / 'old').exists())
            self.assertNotIn('afresh', self.build(place).stdout)

    @unittest.skipIf(os.getuid() != 0 or not os.stat('/').st_mode & stat.S_IXOTH,
                     'only root can play two users, and where / is open to others')
    def test_the_build_folder_of_another_user(self):
        tree = self.copy_scripts('tree')
        done = self.build(tree, preexec_fn=lambda: os.setuid(NOBODY))
        self.assertEqual(done.returncode, 1)
        self.assertIn(f"'{tree}' belongs to another user, root: make a copy of your own\n", done.stderr)

        self.assertEqual(self.build(tree).returncode, 0)
        as_nobody = self.build(tree, preexec_fn=lambda: os.setuid(NOBODY))
        self.assertEqual((as_nobody.returncode, as_nobody.stderr), (0, ''))  # up to date: may be run

        (tree / 'src' / 'new.cpp').touch()
        done = self.build(tree, preexec_fn=lambda: os.setuid(NOBODY))
        self.assertEqual(done.returncode, 1)
        self.assertRegex(done.stderr, r"^check: error: '.*/build' belongs to another user, root: remove the folder .*\n$")

    def test_who_may_not_install_is_told_what_to_ask_for(self):
        tree = self.copy_scripts('tree')
        done = self.bash(tree, 'missing_packages() { printf "%s\\n" g++ libpcl-dev; }\nid() { echo 1000; }\n'
                         'can_use_sudo() { false; }\napt-get() { echo "apt-get was called"; }\ninstall_dependencies with_ros')
        self.assertEqual((done.returncode, done.stdout), (1, ''))
        self.assertEqual(done.stderr, 'check: error: 2 packages are missing, and this user can install none. Ask for:\n'
                         '  apt-get update && apt-get install -y --no-install-recommends g++ libpcl-dev\n')

    def test_further_packages_stand_in_the_same_list(self):
        tree = self.copy_scripts('tree')
        done = self.bash(tree, 'missing_packages() { printf "%s\\n" "$@"; }\nid() { echo 1000; }\n'
                         'can_use_sudo() { false; }\ninstall_dependencies with_ros catkin-lint')
        self.assertEqual(done.stderr.count('Ask for:'), 1)
        self.assertRegex(done.stderr, r'recommends g\+\+ .* catkin-lint\n$')

    def test_a_system_without_packages_of_ros_is_told_where_they_come_from(self):
        tree = self.copy_scripts('tree')
        done = self.bash(tree, 'missing_packages() { printf "%s\\n" catkin libpcl-ros-dev; }\nid() { echo 0; }\n'
                         'apt-get() { [ "$1" = update ] || { echo "E: Unable to locate package libpcl-ros-dev"; false; }; }\n'
                         'env() { shift; "$@"; }\ninstall_dependencies with_ros')
        self.assertEqual(done.returncode, 1)
        self.assertRegex(done.stderr, r'^check: error: apt knows no package libpcl-ros-dev here\. .*Ubuntu 20\.04.*\n'
                         r'.*/opt/ros/noetic.* ./check --without-ros\n$')

    def test_without_ros_no_package_of_ros_is_asked_for(self):
        tree = self.copy_scripts('tree')
        core = self.bash(tree, 'required_packages without_ros').stdout.split()
        self.assertIn('libpcl-dev', core)
        self.assertFalse([name for name in core if 'ros' in name or 'catkin' in name or 'nodelet' in name])
        self.assertIn('catkin', self.bash(tree, 'required_packages with_ros').stdout.split())

    def test_nothing_is_asked_for_where_all_is_there(self):
        tree = self.copy_scripts('tree')
        done = self.bash(tree, 'missing_packages() { :; }\nsudo() { echo "sudo was called"; }\ninstall_dependencies with_ros')
        self.assertEqual((done.returncode, done.stdout, done.stderr), (0, '', ''))

    def test_a_system_that_does_not_know_localhost_is_left_as_it_is(self):
        tree = self.copy_scripts('tree')
        (tree / 'setup.bash').touch()
        hosts = pathlib.Path('/etc/hosts')
        before = hosts.read_bytes() if hosts.exists() else None
        environment = {name: value for name, value in os.environ.items() if name not in ('ROS_HOSTNAME', 'ROS_IP')}
        done = subprocess.run(
            ['bash', '-c', 'set -eu; getent() { return 2; }; source scripts/environment.sh; load_ros ./setup.bash\n'
             'echo $ROS_HOSTNAME; python3 -c "import socket; print(socket.getaddrinfo(\'localhost\', 80)[0][4])"'],
            cwd=tree, env=environment, stdout=subprocess.PIPE, text=True, check=True)
        self.assertEqual(done.stdout, "127.0.0.1\n('127.0.0.1', 80)\n")
        self.assertEqual(hosts.read_bytes() if hosts.exists() else None, before)


if __name__ == '__main__':
    unittest.main()
