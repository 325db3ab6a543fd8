#!/usr/bin/env python3
"""What the study `libraries` keeps of one contestant and one part of a suite. ask.py, which lies beside this file, asks.

It reads calls, and prints a line with an object of JSON for each. Arguments of a call end with a zero byte, and a call with
one more; a path may have any other bytes.
    --suite DIR --question KIND --family NAME COMMAND    in the names of LibraryCounts (experiments/studies/counts.h), and
                                                         examples of faults
    --question card COMMAND                              the card
If it cannot be done, the object has the reason as its `error`.

A mesh NAME stands for all meshes NAME-1, NAME-2 .. of the suite, which one process is asked about. `self`, `inside`,
`clash` and `distance` need no family: all of a suite are asked.
"""
import argparse
import contextlib
import gc
import json
import math
import os
import re
import shlex
import sys

import ask

DEATHS = ['crashed', 'hung', 'no memory']
SCORE = ['asked', 'answered', 'missed', 'wrong', 'own asked', 'own missed', 'own wrong', 'refused', 'unanswered', 'crashed',
         'hung', 'no memory', 'not asked', 'twice', 'differs']  # of a part of the rows, as the report reads it
DISTANCES = ['zero', 'not zero', 'negative', 'off', 'points', 'points off']  # faults of distances and of their points
ROUNDS = 4  # of a search for a simpler pair


# ---- rows

def listed_rows(card, listed, answers, differs):
    """A row for each parameter and kind of label, in the order of the questions."""
    rows = {}
    for one, answer, again in zip(listed, answers, differs):
        kind = one.label if one.question.kind == 'pair' else one.question.kind
        row = rows.setdefault((one.parameter, kind), ask.Row())
        row.take(answer, again)
        row['timed'] += answer.outcome == 'answered'
        if answer.outcome == 'answered' and ask.is_scored(card, one):
            ask.score(card, one, answer.value, row)
        row['answered'] -= answer.outcome == 'answered' and not ask.is_scored(card, one)
    return rows


def of_lists(command, card, suite, kind, family, options):
    """The rows of that list of pairs, or of all lists of questions of that kind; and the examples of faults of pairs."""
    rows, more = {}, {}
    for _, listed in ask.lists_of(card, suite, [kind], family if kind == 'pair' else None):
        answers, differs = ask.ask_twice(command, [one.question for one in listed], options)
        for key, row in listed_rows(card, listed, answers, differs).items():
            rows.setdefault(key, ask.Row()).add(row)
        if kind == 'pair':
            more = examples(command, card, listed, answers, options)
    for row in rows.values() if kind == 'distance' else []:
        row['wrong'] = sum(row[name] for name in ('zero', 'not zero', 'negative', 'off'))
        row['wrong'] += row['points off'] * (card['promises'] == 'yes')  # points are no part of the answer of others
    return rows, more


def of_meshes(command, card, suite, family, options):
    """A row for each mesh of the family. What a mesh counts are its colliding pairs."""
    rows = {}
    names = sorted((name for of in suite.meshes().values() for name in of if
                    re.sub('-[0-9]+$', '', name.rpartition('/')[2]) == family),
                   key=lambda name: [int(n) for n in re.findall('[0-9]+$', name)])
    for name, row in zip(names, ask.ask_family(command, card, suite, names, options)):
        row['asked'] = row['answered'] = row['colliding']
        rows[suite.properties(name)['parameter'], 'mesh', name] = row  # frames may have the same parameter
    return rows


def scores_text(rows):
    """The rows as one line: PARAMETER KIND COUNTS NS|REASON, with `;` between them."""
    return ';'.join(' '.join([parameter, kind, *(str(row[name]) for name in SCORE), repr(row['ns'])]) + '|' +
                    re.sub('[;|\\s]+', ' ', row.reason) for (parameter, kind, *_), row in rows.items())


# ---- the smallest pair of each kind of fault

def decimal(x):
    text = repr(x + 0.0)
    return text[:-2] if text[-2:] == '.0' else text.replace('.0e', 'e')


def cost(numbers):
    return sum(len(decimal(x)) for x in numbers)


def to_bits(x, bits):
    fraction, exponent = math.frexp(x)
    return math.ldexp(round(math.ldexp(fraction, bits)), exponent - bits)


def to_digits(x, digits):
    return float(f'{x:.{digits - 1}e}') if digits else 0.0


def simpler(numbers):
    """Pairs with fewer characters: rounded to bits, digits and whole numbers, moved to a corner, with one coordinate rounded."""
    most = math.frexp(max(map(abs, numbers)))[1]
    changes = [lambda x, n=n: to_bits(x, n) for n in (1, 2, 3, 4, 6, 8, 12, 16, 24, 32)]
    changes += [lambda x, n=n: to_digits(x, n) for n in range(1, 17)]
    changes += [lambda x, n=n: float(round(math.ldexp(x, n - most))) for n in range(1, 31)]
    changes += [lambda x: math.ldexp(x, -most)]
    found = [[change(x) for x in numbers] for change in changes]
    found += [[x - numbers[3 * corner + i % 3] for i, x in enumerate(numbers)] for corner in range(6)]
    found += [[*numbers[:i], to_digits(numbers[i], n), *numbers[i + 1:]] for i in range(18) for n in (0, 1, 2, 3, 5, 8)]
    found = {tuple(x + 0.0 for x in one) for one in found if all(map(math.isfinite, one))}
    return sorted((one for one in found if cost(one) < cost(numbers)), key=lambda one: (cost(one), one))


def pierces(edge, t):
    """Whether an edge crosses the inside of a triangle."""
    edge, t = ask.whole(edge, t)
    p, along = edge[0], ask.minus(edge[1], edge[0])
    side = [ask.dot(ask.normal(t), ask.minus(q, t[0])) for q in edge]
    turns = [ask.dot(along, ask.cross(ask.minus(a, p), ask.minus(b, p))) for a, b in ask.edges(t)]
    return min(side) < 0 < max(side) and (min(turns) > 0 or max(turns) < 0)


def meets(a, b):
    """Whether two closed triangles have a point in common, exactly."""
    return any(pierces(edge, t) for s, t in ((a, b), (b, a)) for edge in ask.edges(s)) or ask.within(a, b, 0)


def is_like(card, label, numbers):
    """Whether a simpler pair meets if the first one does, and the documentation promises the answer about it too."""
    a, b = ask.corners_of(numbers), ask.corners_of(numbers[9:])
    return meets(a, b) == label and ask.promised(card, a, b, label)


def simplest(command, card, faults, options):
    """Of each fault a pair with the same fault and fewer characters, which is the only one that a process is asked about; none
    if the fault depends on what was asked before. Each round asks about all simpler pairs in one process. A fault is a pair,
    whether it meets, and the outcome and the value that the contestant gave."""
    def err(tried):
        questions = [ask.Question('pair', ['-', *map(repr, pair)], name) for name, pair in tried]
        return [(answer.outcome, answer.value) == faults[name][2]
                for (name, _), answer in zip(tried, ask.ask(command, questions, options)[0])]

    found = {name: pair for name, (pair, _, _) in faults.items()}
    better = found
    for _ in range(ROUNDS):  # each death costs a process, a hang its whole limit
        tried = [(name, pair) for name, from_ in better.items()
                 for pair in simpler(from_)[:4 if faults[name][2][0] in DEATHS else None]]
        better = {}
        for (name, pair), errs in zip(tried, err(tried)):
            if errs and name not in better and is_like(card, faults[name][1], pair):
                better[name] = pair
        found = {**found, **better}
    alone = {name: next((pair for pair in (found[name], faults[name][0]) if all(err([(name, pair)])[0] for _ in range(2))), None)
             for name in faults}
    return {name: pair for name, pair in alone.items() if pair}


def examples(command, card, listed, answers, options):
    """For each fault the pair with the fewest characters at which the contestant has it, of those of which its
    documentation promises the answer, made simpler. Triangles that share corners are left out."""
    first, faults = {}, []
    for one, answer in zip(listed, answers):
        right = one.label not in ('apart', 'neighbours-apart')
        if one.label != '?' and one.question.fields[0] == '-' and (answer.outcome, answer.value) not in (
                ('answered', right), ('refused', None), ('unanswered', None), ('not asked', None)):
            name = 'death' if answer.outcome in DEATHS else 'missed' if right else 'wrong'
            faults.append((cost(one.numbers), len(faults), name, right, one, answer))
    for _, _, name, right, one, answer in sorted(faults, key=lambda fault: fault[:2]):
        if name not in first and ask.promised(card, ask.corners_of(one.numbers), ask.corners_of(one.numbers[9:]), right, one.label):
            first[name] = one, right, (answer.outcome, answer.value)
    pairs = simplest(command, card, {name: (one.numbers, *fault) for name, (one, *fault) in first.items()}, options)
    return {name: {'parameter': float(first[name][0].parameter), 'numbers': list(pair)} for name, pair in pairs.items()}


# ---- the command

def found(command, card, suite, options):
    """What is kept of one family of one kind of question."""
    more = {}
    if options.question == 'mesh':
        rows = of_meshes(command, card, suite, options.family, options)
    else:
        rows, more = of_lists(command, card, suite, options.question, options.family, options)
    total = ask.Row()
    for row in rows.values():
        total.add(row)
    names = [*SCORE, 'timed', *(DISTANCES if options.question == 'distance' else [])]
    return {'counts': {name.replace(' ', '_').replace('differs', 'differing'): total[name] for name in names},
            'ns': total['ns'], 'worst': total.worst, 'reason': total.reason, 'scores': scores_text(rows),
            'card': card, 'examples': more}


def calls():
    """The arguments of each call."""
    text = b''
    for part in iter(lambda: sys.stdin.buffer.read1(1 << 16), b''):
        text += part
        if text.endswith(b'\0\0'):
            yield [os.fsdecode(word) for word in text[:-2].split(b'\0')]
            text = b''


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument('command', metavar='COMMAND')
    parser.add_argument('--suite', metavar='DIR')
    parser.add_argument('--question', required=True, choices=['card', *ask.KINDS])
    parser.add_argument('--family', metavar='NAME')
    parser.add_argument('--limit', type=float, default=5)
    parser.add_argument('--memory', type=int, default=4096)
    parser.add_argument('--deaths', type=int, default=20)
    gc.disable()  # it would look through millions of objects, none of which hold each other in a circle
    cards, suites = {}, {}  # by command, by folder
    for call in calls():
        options = parser.parse_args(call)
        command = shlex.split(options.command)
        try:
            if options.command not in cards:
                answer = ask.ask(command, [ask.Question('card', [])], options)[0][0]
                cards[options.command] = ask.card_of(command, answer)
            card = cards[options.command]
            if options.question != 'card' and options.suite not in suites:
                suites[options.suite] = ask.Suite(options.suite)
            out = card if options.question == 'card' else found(command, card, suites[options.suite], options)
        except (ask.Wrong, ValueError, OSError) as error:
            out = {'error': os.fsencode(str(error)).decode('utf-8', 'replace')}
        print(json.dumps(out), flush=True)


if __name__ == '__main__':
    with contextlib.suppress(KeyboardInterrupt):  # the program that asks says so
        main()
