#!/usr/bin/env python3
"""Mutation testing: applies small random changes to the cores, one at a time, and sees whether unit tests notice.

    tests/mutation/mutate.py CLONE --count 300 --results tests/mutation/results.jsonl
    tests/mutation/mutate.py CLONE --again --results tests/mutation/results.jsonl    # survivors, against the tests of today
    tests/mutation/mutate.py CLONE --doubted --results tests/mutation/results.jsonl  # kills that may be another mutant's
    tests/mutation/mutate.py --report tests/mutation/results.jsonl

CLONE is a clean clone of its own, built in CLONE/build; its sources are changed and put back. Each mutant is one line
of the results: started again, the program does only what is missing. A mutant is killed where a unit test of its room
fails, crashes or takes more than TIMES_AS_LONG times what it takes without it. Mutants that do not compile are not
counted. A survivor that tests written since have killed keeps its first verdict, too (`at_first`).
"""
import argparse
import collections
import json
import pathlib
import random
import re
import subprocess
import sys
import time

# Unit tests by room: what a change there may be noticed by.
ROOMS = {
    'tensegric': r'^tensegric_|^control_mesh_garments_',
    'tffd': r'^tffd_',
    'control_mesh': r'^control_mesh_',
    'landmarks': r'^landmarks_',
}
SWAPS = {
    ' + ': [' - '], ' - ': [' + '], ' * ': [' / '], ' / ': [' * '],
    ' < ': [' <= ', ' > '], ' <= ': [' < ', ' > '], ' > ': [' >= ', ' < '], ' >= ': [' > ', ' < '],
    ' == ': [' != '], ' != ': [' == '], ' && ': [' || '], ' || ': [' && '],
    ' += ': [' -= '], ' -= ': [' += '],
    'std::min(': ['std::max('], 'std::max(': ['std::min('],
}
NUMBER = re.compile(r'(?<![\w.])(\d+\.\d*(?:e-?\d+)?|\d+)(?![\w.])')
STATEMENT = re.compile(r'^\s+[\w.\[\]()>-]+ [-+*/]?= [^;]*;$|^\s+[\w.>-]+\([^;]*\);$')
TIMES_AS_LONG, AT_LEAST = 5, 10  # seconds
FIRST_COMMIT = 'e1bcfde'  # of results that do not name theirs


def code_of(line):
    """The line without its comment and with its strings blanked, in the same columns."""
    line = re.sub(r'"(?:[^"\\]|\\.)*"', lambda m: '"' + ' ' * (len(m.group()) - 2) + '"', line)
    return line.split('//')[0].rstrip()


def changed_number(text):
    if '.' in text or 'e' in text:
        return repr(float(text) * 1.5 if float(text) != 0 else 0.5)
    return str(int(text) + 1)


def mutants_of(path, text):
    """(line, column, old, new) of every change that may be made in a file."""
    mutants = []
    for number, line in enumerate(text.split('\n'), 1):
        code = code_of(line)
        stripped = code.strip()
        if not stripped or stripped.startswith(('#', 'namespace', 'using', 'template', 'static_assert')):
            continue
        for old, news in SWAPS.items():
            for match in re.finditer(re.escape(old), code):
                mutants += [(number, match.start(), old, new) for new in news]
        for match in NUMBER.finditer(code):
            mutants.append((number, match.start(), match.group(), changed_number(match.group())))
        if STATEMENT.match(code) and 'throw' not in code:
            mutants.append((number, 0, code, ';'))
    return mutants


def drawn(clone, count, seed):
    """Mutants at random: rooms by their number of lines, places evenly. More than are asked for, as some do not compile."""
    places = []
    for room in ROOMS:
        for path in sorted((clone / 'nodes' / room).glob('*.cpp')):
            if path.stem.endswith(('_node', '_handler', '_message', '_messages')):
                continue
            text = path.read_text()
            by_line = collections.defaultdict(list)
            for mutant in mutants_of(path, text):
                by_line[mutant[0]].append(mutant)
            places += [(room, path.name, changes) for _, changes in sorted(by_line.items())]
    chance = random.Random(seed)
    chance.shuffle(places)
    for room, name, changes in places[:2 * count]:
        number, column, old, new = chance.choice(changes)
        yield {'room': room, 'file': name, 'line': number, 'column': column, 'old': old, 'new': new}


def run(command, limit=None):
    try:
        return subprocess.run(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, timeout=limit).returncode
    except subprocess.TimeoutExpired:
        return -1


def build_of(clone, room):
    return ['cmake', '--build', clone / 'build', '--target', f'tensegric_fit_{room}']


def baseline(clone, room):
    """Seconds, name and command of the unit tests of each file of a room, the quickest first."""
    listed = json.loads(subprocess.check_output(['ctest', '--test-dir', clone / 'build', '--show-only=json-v1']))
    tests = []
    for test in listed['tests']:
        name = test['name'].split('_gtest_')[-1]
        if re.match(ROOMS[room], name) and name != test['name']:
            command = test['command'][-1].split()  # catkin hands it over as one word
            start = time.monotonic()
            if run(command) != 0:
                sys.exit(f'{name} fails without any change')
            tests.append((time.monotonic() - start, name, command))
    return sorted(tests)


def verdict_on(clone, mutant, tests):
    path = clone / 'nodes' / mutant['room'] / mutant['file']
    text = path.read_text()
    lines = text.split('\n')
    line = lines[mutant['line'] - 1]
    column, old = mutant['column'], mutant['old']
    lines[mutant['line'] - 1] = line[:column] + mutant['new'] + line[column + len(old):]
    try:
        path.write_text('\n'.join(lines))
        if run(build_of(clone, mutant['room'])) != 0:
            return 'does not compile'
        for seconds, name, command in tests:
            code = run([*command, '--gtest_fail_fast'], max(AT_LEAST, TIMES_AS_LONG * seconds))
            if code != 0:
                return f"killed by {name}" + (' (time)' if code == -1 else '')
        return 'survived'
    finally:
        path.write_text(text)


def campaign(clone, results, count, seed):
    if subprocess.run(['git', '-C', clone, 'status', '--porcelain', '-uno'], capture_output=True).stdout:
        sys.exit(f'{clone} is not clean')
    done = [json.loads(line) for line in results.read_text().splitlines()] if results.exists() else []
    known = {(m['file'], m['line'], m['column'], m['old'], m['new']): m for m in done}
    counted = 0
    tests = {}
    commit = subprocess.check_output(['git', '-C', clone, 'rev-parse', '--short', 'HEAD'], text=True).strip()
    changed = None  # the room whose library is still that of a mutant
    for mutant in drawn(clone, count, seed):
        if counted == count:
            break
        before = known.get((mutant['file'], mutant['line'], mutant['column'], mutant['old'], mutant['new']))
        if before is None:
            room = mutant['room']
            if changed != room:  # tests link other rooms, too
                for other in [changed] if changed else ROOMS:
                    run(build_of(clone, other))
            changed = room
            tests[room] = tests.get(room) or baseline(clone, room)
            start = time.monotonic()
            mutant['verdict'] = verdict_on(clone, mutant, tests[room])
            mutant['commit'] = commit
            mutant['seconds'] = round(time.monotonic() - start, 1)
            with results.open('a') as file:
                file.write(json.dumps(mutant) + '\n')
            before = mutant
        counted += before['verdict'] != 'does not compile'
    for room in tests:  # the libraries as they are without a change
        run(build_of(clone, room))


def place_today(clone, mutant):
    """The mutant where its line stands now; None where there is no such line any more."""
    path = f"nodes/{mutant['room']}/{mutant['file']}"
    then = subprocess.run(['git', '-C', clone, 'show', f"{mutant.get('commit', FIRST_COMMIT)}:{path}"], capture_output=True, text=True)
    if then.returncode != 0 or not (clone / path).exists():
        return None
    line = then.stdout.split('\n')[mutant['line'] - 1]
    same = [number for number, text in enumerate((clone / path).read_text().split('\n'), 1) if text == line]
    return dict(mutant, line=min(same, key=lambda number: abs(number - mutant['line']))) if same else None


def is_doubted(mutant):
    """Killed while another room's library may still have been a mutant's: by the first campaign, whose results name no commit."""
    return mutant['verdict'].startswith('killed') and 'commit' not in mutant


def try_again(clone, results, wanted):
    mutants = [json.loads(line) for line in results.read_text().splitlines()]
    commit = subprocess.check_output(['git', '-C', clone, 'rev-parse', '--short', 'HEAD'], text=True).strip()
    for room in ROOMS:
        chosen = [m for m in mutants if m['room'] == room and wanted(m) and m.get('tried_again') != commit]
        tests = baseline(clone, room) if chosen else []
        for mutant in chosen:
            today = place_today(clone, mutant)
            mutant['tried_again'] = commit
            if today:
                verdict = verdict_on(clone, today, tests)
                if mutant['verdict'] == 'survived' and verdict.startswith('killed'):
                    mutant['at_first'] = 'survived'
                if verdict != 'does not compile':
                    mutant['verdict'] = verdict
            else:
                mutant['note'] = 'its line is gone'
            results.write_text(''.join(json.dumps(m) + '\n' for m in mutants))
        run(build_of(clone, room))


def report(results):
    mutants = [json.loads(line) for line in results.read_text().splitlines()]
    mutants = [m for m in mutants if m['verdict'] != 'does not compile']
    print('| room | mutants | killed at first | killed | share |\n| --- | --- | --- | --- | --- |')
    for room in [*ROOMS, 'all']:
        of_room = [m for m in mutants if room in ('all', m['room'])]
        killed = sum(m['verdict'].startswith('killed') for m in of_room)
        if of_room:
            at_first = killed - sum('at_first' in m for m in of_room)
            print(f'| {room} | {len(of_room)} | {at_first} | {killed} | {100 * killed / len(of_room):.0f} % |')
    print('\nSurvivors:\n')
    for m in sorted(mutants, key=lambda m: (m['room'], m['file'], m['line'])):
        if m['verdict'] == 'survived':
            print(f"- {m['room']}/{m['file']}:{m['line']} `{m['old'].strip()}` -> `{m['new'].strip()}`"
                  + (f": {m['note']}" if 'note' in m else ''))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('clone', nargs='?', type=pathlib.Path)
    parser.add_argument('--results', type=pathlib.Path)
    parser.add_argument('--count', type=int, default=300)
    parser.add_argument('--seed', type=int, default=1)
    parser.add_argument('--again', action='store_true', help='only try survivors again')
    parser.add_argument('--doubted', action='store_true', help='only try those again that may have been killed by another mutant')
    parser.add_argument('--report', type=pathlib.Path, help='results to be summed up')
    asked = parser.parse_args()
    if asked.report:
        report(asked.report)
    elif asked.clone and asked.results:
        clone, results = asked.clone.resolve(), asked.results.resolve()
        if asked.again:
            try_again(clone, results, lambda mutant: mutant['verdict'] == 'survived')
        elif asked.doubted:
            try_again(clone, results, is_doubted)
        else:
            campaign(clone, results, asked.count, asked.seed)
    else:
        parser.error('either CLONE and --results, or --report')


if __name__ == '__main__':
    main()
