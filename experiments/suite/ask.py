#!/usr/bin/env python3
"""Asks a program about a suite of labelled triangles and meshes, and prints what it gets wrong.

docs/ask.md has the protocol, docs/suite.md the files. This file needs Python 3.8 alone. `farcull suite DIR` writes it
into the folder of the suite, and `farcull suite DIR --ask COMMAND` runs it.
"""
import argparse
import collections
import contextlib
import csv
import hashlib
import json
import math
import os
import queue
import re
import shlex
import signal
import subprocess
import sys
import tempfile
import threading
import time
from fractions import Fraction

KINDS = ['pair', 'mesh', 'distance', 'self', 'inside', 'clash']
QUICK = ('pair', 'distance')  # questions that name no file
AHEAD = 32  # at most so many quick questions are sent but not yet answered
LONGEST = 1 << 16  # bytes; longer lines of output may be refused
MOST = 1 << 28  # limit for the length of an answer; an endless answer would fill the memory
AGAIN = 16  # in each family, every 16th question is asked a second time
OFF = 1e-6  # relative errors of distances and points are counted if they are larger than this
ROUNDED = 2.0 ** -48  # permitted rounding error of a distance, relative to the largest coordinate


class Wrong(Exception):
    """The suite or the command cannot be used."""


# ---- a process and its answers

class Child:
    """A process with limits. `lines` is a queue of its output: lists of lines, then an empty list at the end."""

    def __init__(self, command, options):
        def limit():
            import resource  # pylint: disable=import-outside-toplevel  # Windows has no such module
            resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
            resource.setrlimit(resource.RLIMIT_CPU, (3600, 3605))  # seconds; the child ends even if this program is killed
            resource.setrlimit(resource.RLIMIT_DATA, (options.memory << 20,) * 2)
        self.errors = tempfile.TemporaryFile()
        posix = os.name == 'posix'
        self.process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=self.errors,
                                        start_new_session=posix, preexec_fn=limit if posix else None)
        self.lines, self.texts = queue.Queue(1 << 12), queue.SimpleQueue()
        threading.Thread(target=self.read, daemon=True).start()
        threading.Thread(target=self.write, daemon=True).start()

    def read(self):
        """Puts lists of lines into the queue, since single lines are slow. A line that is too long is split into parts."""
        with self.process.stdout as file:
            part = b''
            for bytes_ in iter(lambda: file.read1(LONGEST), b''):
                *lines, part = (part + bytes_).split(b'\n')
                lines = [line.decode('utf-8', 'replace') + '\n' for line in lines]
                if len(part) >= LONGEST:
                    lines, part = [*lines, part.decode('utf-8', 'replace')], b''
                if lines:
                    self.lines.put(lines)
                if self.errors.closed:
                    return
        if part:
            self.lines.put([part.decode('utf-8', 'replace')])
        self.lines.put([])

    def write(self):
        """Writes the texts of send() to the process. Runs in its own thread, which waits if the process does not read."""
        with contextlib.suppress(OSError), self.process.stdin as file:
            for text in iter(self.texts.get, b''):
                file.write(text)
                file.flush()

    def send(self, text):
        self.texts.put(text.encode('utf-8', 'surrogateescape'))  # restores the bytes of a path that is not UTF-8

    def end_input(self):
        self.texts.put(b'')

    def end(self, seconds):
        """Waits for the end of the process. Returns an outcome and a reason: how it ended, and why."""
        try:
            status = self.process.wait(seconds)
        except subprocess.TimeoutExpired:
            return HUNG
        size = self.errors.seek(0, os.SEEK_END)
        self.errors.seek(max(0, size - 16384))
        words = ' '.join(self.errors.read().decode('utf-8', 'replace').split())
        if status == 0:
            return ENDED
        reason = (signal.Signals(-status).name if status < 0 else f'exit status {status}') + f' {words[-300:]}'.rstrip()
        memory = re.search('bad_alloc|out of memory|failed to allocate|heap limit|MemoryError', words, re.IGNORECASE)
        return 'no memory' if memory or status == -9 else 'crashed', reason

    def close(self):
        """Ends the process and the processes that it started."""
        with contextlib.suppress(OSError):
            os.killpg(self.process.pid, signal.SIGKILL) if os.name == 'posix' else self.process.kill()
        self.process.wait()
        self.end_input()
        self.errors.close()
        while not self.lines.empty():  # the thread of read() may be waiting for room in the queue
            self.lines.get()


Answer = collections.namedtuple('Answer', 'outcome value ns reason')
LINE_END = re.compile('\r?\n$')
NOT_ASKED, UNANSWERED = (Answer(outcome, None, 0, '') for outcome in ('not asked', 'unanswered'))
HUNG, ENDED = ('hung', 'no answer within the limit'), ('unanswered', '')  # outcome and reason: how a process ended
# kind: one of KINDS, or 'card'. fields: the fields after the kind. family: ask() counts, per family, how many processes died.
Question = collections.namedtuple('Question', 'kind fields family', defaults=[''])

FOUR = re.compile('[0-9]{1,18}(\t[0-9]{1,18}){3}')
GRAMMAR = {int: re.compile('[0-9]{1,18}'), float: re.compile('-?([0-9]+([.][0-9]*)?|[.][0-9]+)([eE][-+]?[0-9]+)?')}


def number(text, kind=float):
    """Reads a number of the grammar. Python's own readers also take blanks, underscores and more."""
    if not GRAMMAR[kind].fullmatch(text) or not math.isfinite(kind(text)):
        raise ValueError(text)
    return kind(text)


def parse(kind, fields, so_far):
    """Reads the fields of one line of an answer. Returns the Answer if this is its last line; `ns` is empty if the line has
    no time. Adds other lines to `so_far`. Raises ValueError for a line that the grammar does not have."""
    word, *rest = fields
    if word == 'refused' and rest:
        return Answer('refused', None, 0, ' '.join(rest)[:160])
    if kind == 'card' and word == 'card' and len(rest) == 2:
        key, words = rest[0], rest[1].split() or [''] if rest[0] == 'answers' else rest[1:]
        if key not in CARD or not {*words} <= {*VALUES.get(key, words)} or (key == 'margin' and number(rest[1]) < 0):
            raise ValueError(rest)
        so_far.append(rest)
        return None
    if kind == 'mesh' and word == 'pair':
        if not FOUR.fullmatch('\t'.join(rest)):  # one match is faster than four; lists are long
            raise ValueError(rest)
        so_far.append(tuple(map(int, rest)))
        return None
    if kind == 'distance' and len(fields) in (1, 7):
        return Answer('answered', [number(field) for field in fields], None, '')
    last = {'mesh': ['done'], 'card': ['done'], 'distance': []}.get(kind, ['0', '1'])
    if word not in last or len(rest) > (kind != 'card') or (rest and number(rest[0]) < 0):
        raise ValueError(word)
    return Answer('answered', so_far if word == 'done' else word == '1', number(rest[0]) if rest else None, '')


def ask_from(child, questions, first, answers, limit, start):
    """Asks one process the questions from `first` on, and fills `answers`. Returns the index of the first question without an
    answer, and how the process ended."""
    following, sent, so_far, size, since, lines = first, first, [], 0, time.monotonic(), collections.deque()
    while True:
        quick = sent < len(questions) and not so_far and questions[sent].kind in QUICK
        ahead = AHEAD if quick else 2
        if sent < len(questions) and not so_far and sent <= following + ahead // 2:  # at most half is unanswered
            until = min(following + ahead, len(questions))
            until = next((i for i in range(sent, until) if (questions[i].kind in QUICK) != quick), until)
            child.send(''.join('\t'.join([str(i), questions[i].kind, *questions[i].fields]) + '\n' for i in range(sent, until)))
            sent = until
            if sent == len(questions):
                child.end_input()
        try:
            if not lines:
                slow = following < len(questions) and questions[following].kind not in QUICK
                left = since + max(start, limit * (10 if slow else 1)) - time.monotonic()
                lines.extend(child.lines.get(timeout=max(0, left)))
        except queue.Empty:
            return following, HUNG
        if not lines:
            return following, child.end(limit)
        line = lines.popleft()
        at, *fields = LINE_END.sub('', line).split('\t')
        size += len(line)
        try:
            if line[-1] != '\n' or not fields or size > MOST:
                raise ValueError(at)
            at = number(at, int)
            if not following <= at < sent or (at > following and so_far):
                raise ValueError(at)
            answer = parse(questions[at].kind, fields, so_far)
        except ValueError:
            what = 'too long an answer' if size > MOST else 'what docs/ask.md does not have'
            return following, ('crashed', f'wrote {what}: {line.rstrip()[:80]}')
        answers[following:at] = [UNANSWERED] * (at - following)
        following = at
        if answer:
            now = time.monotonic()
            answers[at] = answer if answer.ns is not None else answer._replace(ns=(now - since) * 1e9)
            following, so_far, since, size, start, left = at + 1, [], now, 0, 0, 0
        elif left < 0:  # all lines of an answer share one time limit
            return following, HUNG


def ask(command, questions, options):
    """Returns an Answer to each question, and how the process ended after the last question. If a process dies, its unanswered
    question gets the outcome of the process, and a new process gets the next question."""
    answers = [NOT_ASKED] * len(questions)
    following, deaths, start = 0, collections.Counter(), max(30, 6 * options.limit)
    while following < len(questions):
        first = following
        if deaths[questions[first].family] >= options.deaths:
            following += 1
            continue
        with contextlib.closing(Child(command, options)) as child:  # closing() ends the child, which Ctrl-C does not reach
            following, (outcome, reason) = ask_from(child, questions, first, answers, options.limit, start)
        start = 2 * options.limit
        if following == len(questions):
            return answers, (outcome, reason)
        if (outcome == 'no memory' or reason.startswith('SIGXCPU')) and following > first:
            continue  # earlier questions may have used up memory or time: asks again in a new process
        answers[following] = Answer(outcome, None, 0, reason)
        deaths[questions[following].family] += 1
        following += 1
    return answers, None


def ask_twice(command, questions, options):
    """Returns the answers, and for each question whether a second answer differed (None: it was not asked again)."""
    answers = ask(command, questions, options)[0]
    step = AGAIN if questions and questions[0].kind != 'mesh' else 1
    at = collections.Counter()  # number of earlier questions, per family
    again = []
    for i, question in enumerate(questions):
        if at[question.family] % step == 0 and answers[i].outcome in ('answered', 'refused'):
            again.insert(0, i)
        at[question.family] += 1
    differs = [None] * len(questions)
    for i, second in zip(again, ask(command, [questions[i] for i in again], options)[0]):
        if second.outcome != 'not asked':
            first = answers[i]
            if questions[i].kind == 'mesh':  # the pairs of a mesh may be listed in any order
                first, second = (one._replace(value=sorted(one.value or [])) for one in (first, second))
            differs[i] = (second.outcome, second.value) != (first.outcome, first.value)
    return answers, differs


# ---- the card

CARD = {'name': '', 'library': '', 'answers': ' '.join(KINDS), 'means': 'closed', 'degenerate': 'yes', 'neighbours': 'no',
        'margin': '0', 'promises': 'no', 'call': '', 'says': '', 'source': '', 'use': ''}
VALUES = {'answers': KINDS, 'means': ('closed', 'crossing'), **dict.fromkeys(('degenerate', 'neighbours', 'promises'), ('yes', 'no'))}


def card_of(command, answer):
    """Returns the program's card. A program without a card is asked everything."""
    if answer.outcome not in ('answered', 'refused'):
        raise Wrong(f'{command[0]}: has no answer to the first question, `card`: {answer.outcome} {answer.reason}')
    return {**CARD, 'name': ' '.join(command), **dict(answer.value or [])}


# ---- exact geometry: for promises of a library's documentation, and for points that a library returns

def minus(a, b):
    return [x - y for x, y in zip(a, b)]


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def whole(*triangles):
    """Returns the triangles with integer coordinates. All coordinates are multiplied by one power of two, which changes no
    sign."""
    ratios = [[[x.as_integer_ratio() for x in corner] for corner in t] for t in triangles]
    most = max(below for t in ratios for corner in t for _, below in corner)
    return [[[above * (most // below) for above, below in corner] for corner in t] for t in ratios]


def normal(t):
    return cross(minus(t[1], t[0]), minus(t[2], t[0]))


def proper(t):
    """True if a triangle is no segment and no point. If a component of the normal is far above its rounding error, doubles
    decide."""
    u, v = minus(t[1], t[0]), minus(t[2], t[0])
    for i, k in (0, 1), (1, 2), (2, 0):
        p, q = u[i] * v[k], u[k] * v[i]
        if abs(p - q) > 1e-12 * (abs(p) + abs(q)) and abs(p - q) > 1e-290:
            return True
    return any(normal(whole(t)[0]))


def square(v):
    return dot(v, v)


def edges(t):
    return [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])]


def point_to_segment(p, segment):
    from_start, along = minus(p, segment[0]), minus(segment[1], segment[0])
    t = dot(from_start, along)
    if 0 < t < square(along):
        return Fraction(square(cross(from_start, along)), square(along))
    return square(from_start if t <= 0 else minus(p, segment[1]))


def point_to_triangle(p, t):
    """Returns the square of the distance, for integers or fractions."""
    n = normal(t)
    if any(n) and all(dot(n, cross(minus(b, a), minus(p, a))) >= 0 for a, b in edges(t)):
        return Fraction(dot(n, minus(p, t[0])) ** 2, square(n))
    return min(point_to_segment(p, edge) for edge in edges(t))


def segment_to_segment(e, f):
    """Returns the square of the distance of two segments. The differences of their points form a parallelogram of two
    triangles. The distance of the segments is that of the origin from the parallelogram."""
    d = [[minus(p, q) for q in f] for p in e]
    return min(point_to_triangle([0, 0, 0], [d[0][0], corner, d[1][1]]) for corner in (d[0][1], d[1][0]))


def within(a, b, margin):
    """True if two triangles that do not cross are at most the margin apart."""
    boxes = [[(min(axis), max(axis)) for axis in zip(*t)] for t in (a, b)]
    # Rounding is monotonic and the margin is a double. So an exact gap of at most the margin is never rounded to a larger value.
    if any(max(p[0] - q[1], q[0] - p[1]) > float(margin) for p, q in zip(*boxes)):
        return False
    a, b, ((margin,),) = whole(a, b, [[float(margin)]])
    for n in normal(a), normal(b):  # one of the normals separates most triangles that are far apart
        at_a, at_b = [dot(n, p) for p in a], [dot(n, p) for p in b]
        gap = max(min(at_a) - max(at_b), min(at_b) - max(at_a))
        if gap > 0 and gap ** 2 > margin ** 2 * square(n):
            return False
    return any(point_to_triangle(p, t) <= margin ** 2 for s, t in ((a, b), (b, a)) for p in s) or any(
        segment_to_segment(e, f) <= margin ** 2 for e in edges(a) for f in edges(b))


def interval(t, n, origin, along):
    """Cuts triangle t with the plane through `origin` with the normal n. Returns the cut as values along `along`, or None if t
    is not on both sides of the plane."""
    side = [dot(n, minus(p, origin)) for p in t]
    if not min(side) < 0 < max(side):
        return None
    at = [dot(along, p) for p in t]
    cuts = [at[i] for i in range(3) if side[i] == 0]
    cuts += [Fraction(at[k] * side[i] - at[i] * side[k], side[i] - side[k])
             for i, k in ((0, 1), (1, 2), (2, 0)) if side[i] * side[k] < 0]
    return min(cuts), max(cuts)


def crosses(a, b):
    """True if two triangles cross (docs/suite.md): they share a point that is on no edge of either triangle."""
    a, b = whole(a, b)
    m, n = normal(a), normal(b)
    along = cross(m, n)
    first, second = interval(a, n, b[0], along), interval(b, m, a[0], along)
    return bool(any(along) and first and second and max(first[0], second[0]) < min(first[1], second[1]))


def promised(card, a, b, label, kind=None):
    """True if the documentation promises the right answer about two triangles. label: whether they collide. kind: the kind of
    contact of a pair of the suite."""
    if (card['degenerate'] == 'no' or card['means'] == 'crossing') and not (proper(a) and proper(b)):
        return False
    if label and card['means'] == 'crossing':
        return kind == 'crossing' if kind and not kind.startswith('neighbours') else crosses(a, b)
    return label or float(card['margin']) == 0 or not within(a, b, card['margin'])


# ---- the suite

class Suite:
    """The files that suite.txt names. A file is used only if its sum is the one in suite.txt."""

    def __init__(self, folder):
        self.folder = os.path.abspath(folder)
        lines = self.read('suite.txt').split('\n')
        self.files = {words[1]: words[3] for words in (line.split(' ') for line in lines) if words[0] == 'file'}
        self.sum = lines[-2][4:]
        if hashlib.sha256('\n'.join([*lines[:-2], '']).encode()).hexdigest() != self.sum:
            raise Wrong(f'{folder}/suite.txt: the sum is not that of the lines before it')

    def path(self, name):
        return os.path.join(self.folder, *name.split('/'))

    def read(self, name):
        with open(self.path(name), encoding='utf-8', newline='') as file:
            return file.read()

    def text(self, name):
        """Returns the text of a file. Raises Wrong if suite.txt has another sum."""
        text = self.read(name)
        if hashlib.sha256(text.encode()).hexdigest() != self.files.get(name):
            raise Wrong(f'{name}: its SHA-256 is not the one of suite.txt, so it was changed')
        return text

    def lists(self, folder):
        """Returns the names of the lists in a folder."""
        return [name for name in self.files if re.fullmatch(f'{folder}/[^/]*[.]txt', name)]

    def lines(self, name):
        """Returns the family of a list, and its lines as lists of words."""
        lines = self.text(name).split('\n')
        return lines[0].split(' ')[2], [line.split() for line in lines[1:] if line and line[0] != '#']

    def meshes(self):
        """Returns the folders of each family of meshes, sorted by number."""
        out = {}
        for name in (os.path.dirname(name) for name in self.files if name.endswith('/mesh.txt')):
            out.setdefault(self.properties(name)['family'], []).append(name)
        return {family: sorted(names, key=lambda name: [int(n) for n in re.findall('[0-9]+', name)])
                for family, names in out.items()}

    def properties(self, name):
        return dict(line.split(' ', 1) for line in self.text(name + '/mesh.txt').split('\n') if line)

    def objects(self, name):
        """Returns the objects of a mesh: paths in the suite, and for each triangle its corners by index and by position."""
        paths = sorted((path for path in self.files if os.path.dirname(path) == name and path.endswith('.obj')),
                       key=lambda path: int(os.path.basename(path)[:-4]))
        objects = []
        for path in paths:
            rows = [line.split() for line in self.text(path).split('\n')]
            vertices = [[float(x) for x in row[1:]] for row in rows if row and row[0] == 'v']
            objects.append([[int(word) - 1 for word in row[1:]] for row in rows if row and row[0] == 'f'])
            objects[-1] = [(corners, [vertices[v] for v in corners]) for corners in objects[-1]]
        return paths, objects


# ---- questions, scores

class Row(collections.Counter):
    """The counts of one family for one kind of question."""
    reason, worst = '', 0

    def take(self, answer, differs):
        self['asked'] += answer.outcome != 'not asked'
        self[answer.outcome] += 1
        self['ns'] += answer.ns
        self['twice'] += differs is not None
        self['differs'] += differs is True
        self.reason = self.reason or answer.reason

    def add(self, row):
        self.update(row)
        self.reason, self.worst = self.reason or row.reason, max(self.worst, row.worst)


def corners_of(numbers):
    return [[numbers[3 * i + k] for k in range(3)] for i in range(3)]


# One line of a list. label: a kind of contact, yes, no, LOW,HIGH, or ? if unknown. numbers: the coordinates.
Listed = collections.namedtuple('Listed', 'number parameter question label numbers')


def pairs_of(suite, name):
    family, lines = suite.lines(name)
    for number_, parameter, shared, label, *words in lines:
        numbers = [*map(float.fromhex, words)]
        yield Listed(number_, parameter, Question('pair', [shared, *map(repr, numbers)], family), label, numbers)


def questions_of(kind, family, suite, lines):
    paths = {'self': 1, 'inside': 1, 'clash': 2}.get(kind, 0)
    for number_, parameter, _, label, *words in (words for words in lines if words[2] == kind):
        numbers = [float.fromhex(word) for word in words[paths:]]
        fields = [*map(suite.path, words[:paths]), *map(repr, numbers)]
        yield Listed(number_, parameter, Question(kind, fields, family), label, numbers)


def lists_of(card, suite, kinds):
    """Yields a kind and the lines that one process gets. For pairs, each list has its own process. All questions of any
    other kind share a process: they are few, and starting a process takes longer than most of them."""
    for name in suite.lists('pairs') if 'pair' in kinds else []:
        yield 'pair', [one for one in pairs_of(suite, name) if one.question.fields[0] == '-' or card['neighbours'] == 'yes']
    families = {}  # the lines of all files of questions, by family
    for family, lines in map(suite.lines, suite.lists('questions') if {*kinds} & {*KINDS[2:]} else []):
        families.setdefault(family, []).extend(lines)
    for kind in KINDS[2:]:
        if kind in kinds:
            yield kind, [one for family, lines in families.items() for one in questions_of(kind, family, suite, lines)]


def is_scored(card, one):
    """True if the answer to the question can be scored: its label is known, and the library defines the answer as
    docs/suite.md does. Libraries may call a point of the surface (parameter 2: at a vertex) inside or outside. Such points
    are scored only for methods that promise the answer of docs/suite.md."""
    return one.label != '?' and (one.question.kind != 'inside' or one.parameter != '2' or card['promises'] == 'yes')


def score(card, listed, value, row):
    _, _, question, label, numbers = listed
    right = label not in ('no', 'apart', 'neighbours-apart')
    if question.kind == 'distance':
        score_distance(label, numbers, value, row)
        return
    fault = 'missed' if right else 'wrong'
    own = question.kind == 'pair' and promised(card, corners_of(numbers), corners_of(numbers[9:]), right, label)
    row['own asked'] += own
    if value != right:
        row[fault] += 1
        row['own ' + fault] += own


def score_distance(label, numbers, value, row):
    low, high = (float.fromhex(word) for word in label.split(','))
    distance, points, error = value[0], value[1:], max(low - value[0], value[0] - high, 0)
    if error > ROUNDED * max(map(abs, numbers)):
        row['zero'] += distance == 0
        row['not zero'] += distance > 0 == high
        row['negative'] += distance < 0
        if distance > 0 and high > 0:  # low is 0 if the distance is less than the smallest positive double
            row['off'] += error / (low or high) > OFF
            row.worst = max(row.worst, error / (low or high))
    triangles = [corners_of(numbers), corners_of(numbers[9:])]
    size = max(max(axis) - min(axis) for triangle in triangles for axis in zip(*triangle))
    if points:
        def exact(corners):
            return [[Fraction(x) for x in corner] for corner in corners]

        # near: permitted error of a point, OFF times the size of the triangles, but at least the spacing of doubles.
        near = max(Fraction(OFF) * Fraction(size), Fraction(max(map(abs, numbers))) / 2 ** 52)
        points = exact([points[:3], points[3:]])
        # most: largest permitted distance of the points, if each is off by `near`, and the distance by the factor 1 + OFF.
        most = 2 * near + Fraction(high) * (1 + Fraction(OFF))
        row['points'] += 1
        row['points off'] += square(minus(*points)) > most ** 2 or any(
            point_to_triangle(point, exact(triangle)) > near ** 2 for point, triangle in zip(points, triangles))


def score_mesh(card, objects, rows, reported, row):
    def shared(a, b):
        return len({*objects[a[0]][a[1]][0]} & {*objects[b[0]][b[1]][0]}) if a[0] == b[0] else 0
    counts = card['neighbours'] == 'yes'
    found = {pair for pair in reported if pair[0] != pair[1] and (counts or not shared(*pair))}
    truth = {((a, i), (b, j)) for a, i, b, j, common in rows if counts or common == 0}
    row['colliding'] += len(truth)
    row['reported'] += len(found)
    def own(pairs, label):
        return sum(promised(card, *(objects[o][t][1] for o, t in pair), label) for pair in pairs)
    for fault, pairs in ('missed', truth - found), ('wrong', found - truth):
        row[fault] += len(pairs)
        row['own ' + fault] += own(pairs, fault == 'missed')
    row['own asked'] += row['own missed'] + own(truth & found, True)


def ask_family(command, card, suite, names, options):
    """Returns a row for each mesh of a family. One process is asked about all meshes."""
    objects, questions = [], []
    for name in names:
        paths, of = suite.objects(name)
        objects.append(of)
        questions.append(Question('mesh', ['1' if suite.properties(name)['self'] == 'yes' else '0', *map(suite.path, paths)]))
    for name, of, answer, differs in zip(names, objects, *ask_twice(command, questions, options)):
        pairs, row = [tuple(sorted(((a, i), (b, j)))) for a, i, b, j in answer.value or []], Row()
        if any(not (0 <= o < len(of) and 0 <= t < len(of[o])) for pair in pairs for o, t in pair):
            answer = Answer('crashed', None, 0, 'named a triangle that the mesh does not have')
        row.take(answer, differs)
        if answer.outcome == 'answered' and name + '/pairs.csv' in suite.files:
            lines = suite.text(name + '/pairs.csv').split('\n')[1:-1]
            score_mesh(card, of, [[*map(int, line.split(','))] for line in lines], pairs, row)
        yield row


def rows_of(command, card, suite, kinds, options):
    """Returns a row for each kind of question, family, parameter and label. For meshes, the mesh name replaces the label."""
    rows = {}
    for kind, listed in lists_of(card, suite, kinds):
        answers, differs = ask_twice(command, [one.question for one in listed], options)
        for one, answer, again in zip(listed, answers, differs):
            row = rows.setdefault((kind, one.question.family, one.parameter, one.label if kind == 'pair' else kind), Row())
            row.take(answer, again)
            if answer.outcome == 'answered' and is_scored(card, one):
                row['scored'] += 1
                score(card, one, answer.value, row)
    for family, names in suite.meshes().items() if 'mesh' in kinds else []:
        for name, row in zip(names, ask_family(command, card, suite, names, options)):
            rows['mesh', family, suite.properties(name)['parameter'], name] = row
    return rows


# ---- tables

OUTCOMES = ['refused', 'unanswered', 'crashed', 'hung', 'no memory', 'not asked', 'differs']
COLUMNS = {'pair': ['asked', 'missed', 'wrong', 'own missed', 'own wrong'],
           'mesh': ['asked', 'colliding', 'reported', 'missed', 'wrong', 'own missed', 'own wrong'],
           'distance': ['asked', 'zero', 'not zero', 'negative', 'off', 'points', 'points off'],
           **dict.fromkeys(('self', 'inside', 'clash'), ['asked', 'missed', 'wrong'])}
TITLES = {'pair': 'pairs of triangles: do they meet?', 'mesh': 'meshes: which triangles meet?',
          'distance': 'distances of triangles: wrong zeros, relative errors and points above a millionth',
          'self': 'meshes: do they meet themselves?', 'inside': 'points: are they inside?', 'clash': 'solids: do their insides meet?'}


def table_of(kind, rows):
    """The rows of one kind of question, by family, and their sum, as aligned text."""
    def cells_of(name, row):
        return [name, *(f'{row[column]:,}' for column in COLUMNS[kind]), *([f'{row.worst:.1e}'] if kind == 'distance' else []),
                *(f'{row[word]:,}' for word in OUTCOMES), f"{row['ns'] / max(row['answered'], 1) / 1e3:,.1f}"]

    total = Row()
    for row in rows.values():
        total.add(row)
    head = ['family', *COLUMNS[kind], *(['worst'] if kind == 'distance' else []), *OUTCOMES, 'us each']
    lines = [head] + [cells_of(name, row) for name, row in [*rows.items(), ('all', total)]]
    kept = [i for i, title in enumerate(head) if title not in OUTCOMES or total[title]]  # omits outcomes that did not occur
    widths = [max(len(line[i]) for line in lines) for i in kept]
    text = '\n'.join('  '.join(line[i].rjust(width) if i else line[i].ljust(width) for i, width in zip(kept, widths))
                     for line in lines)
    return f'{TITLES[kind]}\n{text}\n' + (f'the first reason of a refusal or a death: {total.reason}\n' if total.reason else '')


def write_csv(path, name, rows):
    columns = [*dict.fromkeys(column for kind in KINDS for column in COLUMNS[kind]), *OUTCOMES]
    with open(path, 'w', encoding='utf-8', newline='') as file:
        writer = csv.writer(file, lineterminator='\n')
        writer.writerow(['contestant', 'question', 'family', *columns, 'worst', 'ns', 'reason'])
        for kind in KINDS:
            for family, row in rows[kind].items():
                writer.writerow([name, kind, family, *(row[column] for column in columns), row.worst, int(row['ns']), row.reason])


# Maps the names in the output of `--json` to the counts of a Row. `answered` counts only answers that is_scored() accepts.
SCORE = {**{name: name for name in ('asked', 'missed', 'wrong', 'own asked', 'own missed', 'own wrong', 'refused', 'unanswered',
                                    'crashed', 'hung', 'no memory', 'not asked', 'twice')},
         'answered': 'scored', 'differing': 'differs', 'timed': 'answered',
         **{name: name for name in ('zero', 'not zero', 'negative', 'off', 'points', 'points off')}}


def as_json(card, rows):
    """Returns what the study `libraries` (experiments/studies/libraries.cpp) keeps of one kind of question: the card, the sums
    of all rows, and the rows."""
    total, scores = Row(), []
    for (kind, family, parameter, label), row in rows.items():
        if kind == 'mesh':  # for meshes, colliding pairs are counted instead of questions
            row['asked'] = row['scored'] = row['colliding']
        if kind == 'distance':
            row['wrong'] = sum(row[name] for name in ('zero', 'not zero', 'negative', 'off'))
            row['wrong'] += row['points off'] * (card['promises'] == 'yes')  # only some libraries promise correct points
        total.add(row)
        folder = {'pair': 'pairs', 'mesh': 'meshes'}.get(kind, kind)
        scores.append([f'{folder}/{family}', parameter, label if kind == 'pair' else kind,
                       *(row[name] for name in SCORE.values()), row.worst, row['ns'], row.reason])
    out = {'called': card['call'], **{name: card[name] for name in ('library', 'means', 'says', 'source', 'use')}}
    out.update({name.replace(' ', '_'): total[of] for name, of in SCORE.items()}, promises=card['promises'] == 'yes',
               reason=total.reason, scores=json.dumps(scores, separators=(',', ':')))
    return {'counts': out, 'ns': total['ns']}


def measure(command, options):
    suite = None if options.only == ['card'] else Suite(options.suite)
    card = card_of(command, ask(command, [Question('card', [])], options)[0][0])
    kinds = [kind for kind in KINDS if kind in card['answers'].split() and kind in (options.only or KINDS)]
    rows = rows_of(command, card, suite, kinds, options) if suite else {}
    if options.json:
        json.dump(as_json(card, rows), sys.stdout)
        return 0
    families = {kind: {} for kind in KINDS}
    for (kind, family, *_), row in rows.items():
        families[kind].setdefault(family, Row()).add(row)
    print(f"{card['name']}{', ' + card['library'] if card['library'] else ''}, asked about the suite "
          f"{suite.sum[:8] if suite else ''}; own: as its documentation promises, {card['means']}\n")
    print('\n'.join(table_of(kind, families[kind]) for kind in KINDS if families[kind]), end='')
    if options.csv:
        write_csv(options.csv, card['name'], families)
    return 0


# ---- the check of a program's grammar

def check(command, options):
    """Asks a few questions of every kind, and prints each with the answer. Returns 1 if something broke the protocol."""
    near, far = '0 0 0 4 0 0 0 4 0 1 1 -1 1 1 1 2 2 1', '0 0 0 4 0 0 0 4 0 0 0 1 4 0 1 0 4 1'
    faces = '1 3 2 2 3 4 5 6 7 6 8 7 1 2 5 2 6 5 3 7 4 4 7 8 1 5 3 3 5 7 2 4 6 4 8 6'.split()
    with tempfile.TemporaryDirectory() as folder:
        for path, side in (a := f'{folder}/a.obj', 0), (b := f'{folder}/b.obj', 0.5):
            with open(path, 'w', encoding='utf-8') as file:
                file.writelines(f'v {side + i % 2} {side + i // 2 % 2} {side + i // 4}\n' for i in range(8))
                file.writelines('f ' + ' '.join(faces[i:i + 3]) + '\n' for i in range(0, 36, 3))
        asked = [('card', [], None), ('pair', ['-', *near.split()], True), ('pair', ['-', *far.split()], False),
                 ('mesh', ['0', a, b], None), ('mesh', ['1', a], None), ('distance', far.split(), 1.0), ('distance', near.split(), 0.0),
                 ('self', [a], False), ('inside', [a, '0.5', '0.25', '0.75'], True), ('inside', [a, '2', '0.25', '0.75'], False),
                 ('clash', [a, b], True), ('pair', ['-', *far.split()], False)]
        answers, end = ask(command, [Question(kind, fields) for kind, fields, _ in asked], options)
    broken = end not in (ENDED, None) or any(answer.outcome not in ('answered', 'refused') for answer in answers)
    for (kind, fields, right), answer in zip(asked, answers):
        value = answer.value[0] if kind == 'distance' and answer.value else answer.value
        bad = answer.outcome not in ('answered', 'refused')
        said = f'{answer.outcome} {answer.reason}' if answer.outcome != 'answered' else \
            'answered' if right is None or value == right else f'answered {value}, and {right} is right'
        print(f"{'BROKEN' if bad else 'ok':6}  {kind} {' '.join(os.path.basename(field) for field in fields)}: {said}".rstrip())
    if end not in (ENDED, None):
        print('BROKEN  after the last answer:', *end)
    print('the protocol is broken: docs/ask.md has its grammar' if broken else 'every answer obeys the grammar')
    return int(broken)


def main(arguments):
    here = os.path.dirname(os.path.abspath(globals().get('__file__', './ask.py')))
    parser = argparse.ArgumentParser(prog='ask.py', description='Asks a program about a suite and prints what it gets wrong.')
    parser.add_argument('command', metavar='COMMAND', help='starts the program; one argument, as in "python3 my_library.py"')
    parser.add_argument('--suite', metavar='DIR', default=here, help='the folder of the suite; default: that of this file')
    parser.add_argument('--check', action='store_true', help='only compare the answers to a few questions with the grammar')
    parser.add_argument('--only', metavar='KINDS', type=lambda text: text.split(','), help=f"of {','.join(KINDS)}")
    for name, value, what in ('limit', 5.0, 'seconds for an answer, ten times as many for questions with a path'), \
            ('memory', 4096, 'MiB of a process'), ('deaths', 20, 'after so many in a family its rest is not asked'):
        parser.add_argument('--' + name, metavar='N', type=type(value), default=value, help=f'{what}; default {value:g}')
    parser.add_argument('--csv', metavar='FILE', help='also write all rows to this file')
    parser.add_argument('--json', action='store_true', help='print what the study `libraries` keeps in place of tables')
    options = parser.parse_args(arguments)
    try:
        command = shlex.split(options.command)
        if not command or not {*(options.only or [])} <= {*KINDS, 'card'}:
            raise Wrong('COMMAND is empty' if not command else f"--only: choose of {','.join(KINDS)}")
        return check(command, options) if options.check else measure(command, options)
    except KeyboardInterrupt:
        return 130
    except (Wrong, ValueError, OSError) as error:
        print(f'ask.py: {error}', file=sys.stderr)
        return 2


if __name__ == '__main__':
    sys.exit(main(sys.argv[1:]))
