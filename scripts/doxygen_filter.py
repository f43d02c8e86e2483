#!/usr/bin/env python3
"""Prints a file for Doxygen: in headers one member a comment, where "float x, y;  ///< [m]" would count for y alone; in
pages no anchors, which it makes in another way than GitHub."""
import re
import sys

MEMBERS = re.compile(r'^ *((?:static |constexpr |const )*[\w:<>]+) (\*?\w+(?: = [^,;()]+)?(?:, \*?\w+(?: = [^,;()]+)?)+);'
                     r' *(?:///< (.*))?$')


def split_members(line, comment_before):
    """The members of a declaration of several, each behind its comment, on one line."""
    found = MEMBERS.match(line)
    comment = found and (found.group(3) or comment_before)
    if not comment:
        return line
    return ' '.join(f'/** {comment} */ {found.group(1)} {name};' for name in found.group(2).split(', '))


def without_anchors(text):
    """A page whose links lead to pages alone."""
    text = re.sub(r'(?<!!)\[([^\]]*)\]\(#[^)]*\)', r'\1', text)
    return re.sub(r'\]\(([^)#\s]+)#[^)]*\)', r'](\1)', text)


def filtered(path, text):
    """What Doxygen gets for a file; as many lines as before."""
    if path.endswith('.md'):
        return without_anchors(text)
    lines, comment = [], ''
    for line in text.split('\n'):
        lines.append(split_members(line, comment))
        is_comment = re.match(r' *///(?!<) ?(.*)', line)
        comment = f'{comment} {is_comment.group(1)}'.strip() if is_comment else ''
    return '\n'.join(lines)


if __name__ == '__main__':
    with open(sys.argv[1], encoding='utf-8') as file:
        sys.stdout.write(filtered(sys.argv[1], file.read()))
