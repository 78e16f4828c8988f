#!/usr/bin/python3
"""count_constants.py FILES OR FOLDERS... [--most N] - numeric literals in C++ sources, wherever they stand.

0, 1 and 2 are not counted, nor are units (10, 100, 1000, 180 degrees, 1e3 and the like), dimensions of types
(Vector3d, block<3, 3>) and what stands in comments and strings. A line a folder: literals, different named constants (kName = ...), lines. With --most: exit status 1 where a folder
has more literals.
"""
import argparse
import glob
import os
import re
import sys

UNITS = {0., 1., 2., 10., 100., 180., 1e3, 1e-3, 1e6, 1e-6}
NUMBER = re.compile(r'(?<![\w.])(?:0[xX][0-9a-fA-F]+|(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)[fFuUlL]*(?![\w.])')


def code_of(text):
    """Without comments, strings, includes."""
    text = re.sub(r'R"(\w*)\((?:.|\n)*?\)\1"', '""', text)
    text = re.sub(r'//[^\n]*|/\*(?:.|\n)*?\*/|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])\'', ' ', text)
    text = re.sub(r'^\s*#.*$', '', text, flags=re.M)
    return re.sub(r'<[^<>;(){}]*>', '<>', text)


def value_of(literal):
    literal = literal.rstrip('uUlL') if literal.lower().startswith('0x') else literal.rstrip('fFuUlL')
    return float(int(literal, 16)) if literal.lower().startswith('0x') else float(literal)


def count(path):
    text = open(path).read()
    code = code_of(text)
    literals = [m.group() for m in NUMBER.finditer(code) if value_of(m.group()) not in UNITS]
    return len(literals), len(re.findall(r'\bk[A-Z]\w*\s*(?:=|\{)', code)), text.count('\n')


def main():
    a = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    a.add_argument('places', nargs='+')
    a.add_argument('--most', type=int)
    o = a.parse_args()
    worst = 0
    for place in o.places:
        files = sorted(glob.glob(os.path.join(place, '*.[ch]pp'))) if os.path.isdir(place) else [place]
        sums = [sum(v) for v in zip(*map(count, files))] if files else [0, 0, 0]
        worst = max(worst, sums[0])
        print('%-30s %5d literals, %4d named constants, %5d lines' % (place, *sums))
    return 1 if o.most is not None and worst > o.most else 0


if __name__ == '__main__':
    sys.exit(main())
