#!/usr/bin/env python3
"""Holds the links of all *.md files to what is there, and README.md to its length."""
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parent.parent
README_LINES = 150
OF_DRIVERS = {'pcap', 'organize_cloud', 'destagger'}  # arguments of their launch files, not of ours
LINK = re.compile(r'!?\[(?:[^\]\[]|\[[^\]]*\])*\]\(([^()\s]*(?:\([^()\s]*\))?[^()\s]*)(?:\s+"[^"]*")?\)')
HEADING = re.compile(r'^(#{1,6})\s+(.*?)\s*#*\s*$', re.MULTILINE)


def without_code(text):
    """The text without fenced and indented code blocks, and without code spans that look like links."""
    text = re.sub(r'^```.*?^```\s*$', '', text, flags=re.MULTILINE | re.DOTALL)
    return re.sub(r'^(?: {4}|\t).*$', '', text, flags=re.MULTILINE)


def anchors(text):
    """The anchors of a page's headings, as GitHub makes them; the second of a name ends with -1."""
    text = re.sub(r'^```.*?^```\s*$', '', text, flags=re.MULTILINE | re.DOTALL)
    found = set()
    counts = {}
    for _, heading in HEADING.findall(text):
        plain = re.sub(r'\[([^\]]*)\]\([^)]*\)', r'\1', heading)
        anchor = re.sub(r'[^\w\- ]', '', plain.lower()).replace(' ', '-')
        count = counts.get(anchor, 0)
        counts[anchor] = count + 1
        found.add(anchor if count == 0 else f'{anchor}-{count}')
    return found


def broken_links(path, root):
    """What the links of a page point to that is not there, as lines to be read."""
    broken = []
    for target in LINK.findall(without_code(path.read_text())):
        if re.match(r'[a-z]+:', target):
            continue
        name, _, anchor = target.partition('#')
        page = (path.parent / name).resolve() if name else path
        if not page.exists():
            broken.append(f'{path.relative_to(root)}: there is no {target}')
        elif root not in page.parents and page != root:
            broken.append(f'{path.relative_to(root)}: {target} lies outside of the repository')
        elif anchor and anchor not in anchors(page.read_text()):
            broken.append(f'{path.relative_to(root)}: {name or "this page"} has no heading #{anchor}')
    return broken


def pages(root):
    """All *.md files of the repository but those of build folders."""
    return sorted(p for p in root.rglob('*.md')
                  if not any(part.startswith(('build', 'devel', 'install', '.git')) and part != '.github'
                             for part in p.relative_to(root).parts[:-1]))


class Documentation(unittest.TestCase):
    def test_links_lead_somewhere(self):
        found = pages(ROOT)
        self.assertGreater(len(found), 5)
        self.assertEqual([line for page in found for line in broken_links(page, ROOT)], [])

    def test_readme_fits(self):
        self.assertLessEqual(len((ROOT / 'README.md').read_text().splitlines()), README_LINES)

    def test_every_page_is_reached_from_the_readme(self):
        reached, open_pages = set(), [ROOT / 'README.md']
        while open_pages:
            page = open_pages.pop()
            if page in reached or page.suffix != '.md' or not page.exists():
                continue
            reached.add(page)
            for target in LINK.findall(without_code(page.read_text())):
                if not re.match(r'[a-z]+:', target):
                    open_pages.append((page.parent / target.partition('#')[0]).resolve())
        self.assertEqual([str(p.relative_to(ROOT)) for p in pages(ROOT) if p not in reached], [])

    def test_every_page_begins_with_what_one_can_do_after_it(self):
        for page in sorted((ROOT / 'doc').glob('*.md')):
            after_title = page.read_text().split('\n\n')[1]
            self.assertTrue(after_title.startswith('After this page you can '), page.name)

    def test_scripts_that_pages_call_have_the_options(self):
        options = {name: subprocess.run([ROOT / name, '--help'], check=True, capture_output=True, text=True).stdout
                   for name in ('demo', 'check')}
        for page in pages(ROOT):
            for name, arguments in re.findall(r'\./(demo|check)\b([^\n`#]*)', page.read_text()):
                for option in re.findall(r'--[a-z]+', arguments):
                    self.assertIn(option, options[name], f'{page.name}: ./{name}{arguments}')

    def test_arguments_of_launch_files_exist(self):
        known = {name for path in (ROOT / 'launch').glob('*.launch')
                 for name in re.findall(r'<arg name="(\w+)"', path.read_text())}
        for page in pages(ROOT):
            for argument in re.findall(r'(?<![\w/~])([a-z]\w*):=', page.read_text()):
                self.assertIn(argument, known | OF_DRIVERS, page.name)

    def test_every_parameter_is_documented(self):
        page = (ROOT / 'doc' / 'topics_and_parameters.md').read_text()
        documented = set(re.findall(r'`(\w+)`', page))
        # an algorithm that the page does not name is somebody's own
        files = [path for base in ('include', 'src') for path in sorted((ROOT / base).rglob('*.[hc]*'))
                 if path.parent.name != 'clusterers' or path.name in page]
        missing = {f'{name} of {path.name}' for path in files
                   for name in re.findall(r'visitor\("(\w+)"', path.read_text()) if name not in documented}
        self.assertEqual(missing, set())

    def test_wrong_links_are_found(self):
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder).resolve()
            (root / 'doc').mkdir()
            (root / 'doc' / 'a.md').write_text('# A `b` c\n\n## Two\n## Two\n[up](../page.md#page), [out](../../x.md)\n')
            (root / 'page.md').write_text('# Page\n[1](doc/none.md), [2](doc/a.md#none), [3](#none), ![4](none.png)\n'
                                          '[5](doc/a.md#a-b-c), [6](doc/a.md#two-1), [7](#page), [8](https://x.y/z)\n'
                                          '```\n[9](in/code)\n```\n    [10](in/code)\n')
            self.assertEqual(broken_links(root / 'page.md', root), [
                'page.md: there is no doc/none.md', 'page.md: doc/a.md has no heading #none',
                'page.md: this page has no heading #none', 'page.md: there is no none.png'])
            self.assertEqual(broken_links(root / 'doc' / 'a.md', root), ['doc/a.md: there is no ../../x.md'])


if __name__ == '__main__':
    sys.exit(unittest.main())
