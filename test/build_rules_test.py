#!/usr/bin/env python3
"""Flags that would crash are refused when configuring, and an older C++ standard in the first line of any header."""
import pathlib
import re
import shutil
import subprocess
import unittest

ROOT = pathlib.Path(__file__).resolve().parent.parent
HEADERS = sorted((ROOT / 'include').rglob('*.h'))
LANGUAGE = 'lidar_panoptic_clustering/core/language.h'
COMPILER = shutil.which('c++') or shutil.which('g++') or 'c++'


def configure(flags, build_type='Release', variable='CMAKE_CXX_FLAGS'):
    return subprocess.run(['cmake', f'-D{variable}={flags}', f'-DCMAKE_BUILD_TYPE={build_type}',
                           f'-DCMAKE_CXX_COMPILER={COMPILER}', '-P', str(ROOT / 'cmake' / 'vector_width.cmake')],
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT, universal_newlines=True, check=False)


class VectorWidth(unittest.TestCase):
    def test_avx_is_refused_with_the_reason(self):
        for flags in ('-march=native', '-O3 -mavx2', '-mavx', '-mavx512f -g'):
            result = configure(flags)
            self.assertNotEqual(result.returncode, 0, flags)
            self.assertIn('align memory to 32 bytes', ' '.join(result.stdout.split()), flags)
        self.assertNotEqual(configure('-mavx', variable='CMAKE_CXX_FLAGS_RELEASE').returncode, 0)

    def test_other_flags_pass(self):
        for flags in ('', '-O2 -g1', '-msse4.2', '-mtune=native'):
            self.assertEqual(configure(flags).returncode, 0, flags)

    def test_a_processor_by_name_is_looked_up(self):
        macros = subprocess.run([COMPILER, '-march=haswell', '-dM', '-E', '-x', 'c++', '/dev/null'],
                                stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, universal_newlines=True, check=False)
        if '__AVX__' not in macros.stdout:
            self.skipTest('the compiler knows no haswell')
        self.assertIn("'-march=haswell'", configure('-march=haswell').stdout)
        self.assertEqual(configure('-march=x86-64').returncode, 0)


class Language(unittest.TestCase):
    def test_every_header_says_first_which_standard_it_needs(self):
        for header in HEADERS:
            first = re.search(r'^#include ["<]([^">]+)[">]', header.read_text(), re.MULTILINE)
            if not str(header).endswith(LANGUAGE):
                self.assertIsNotNone(first, header)
                self.assertTrue(first.group(1).startswith('lidar_panoptic_clustering/'), header)

    def test_the_message_names_the_remedy(self):
        def compile_as(standard):
            return subprocess.run([COMPILER, f'-std=c++{standard}', '-E', '-x', 'c++', '-I', str(ROOT / 'include'),
                                   str(ROOT / 'include' / LANGUAGE)], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                                  universal_newlines=True, check=False)
        self.assertEqual(compile_as(17).returncode, 0)
        result = compile_as(14)
        self.assertNotEqual(result.returncode, 0)
        self.assertIn('set(CMAKE_CXX_STANDARD 17)', result.stderr)


if __name__ == '__main__':
    unittest.main()
