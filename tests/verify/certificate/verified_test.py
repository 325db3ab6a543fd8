"""Compares the verdicts of farcull check and of farcull-check-verified, on certificates and on forged ones, and changes
inequalities of the proved checker, or rules of the passes (tests/proofs/coq), which must break their proofs. tests/coq.sh calls it.
  verified_test.py compare FARCULL CHECKER FOLDER RANDOM   about RANDOM scenes on a small grid, besides those that are built in;
                                                           with 20 or fewer also without those that take long
  verified_test.py mutants SOURCES FOLDER"""
import base64
import hashlib
import json
import os
import random
import re
import shutil
import struct
import subprocess
import sys
import tarfile

BUILT_IN = ['two-spheres', 'degenerate', 'needles:60', 'mixed:10', 'gap:216', 'gap:100:0', 'gap:100:-1', 'stack:4', 'slivers:40',
            'shells:4', 'ground', 'cad-cut:2000', 'cloth:8', 'crumpled:1000', 'crowd:60', 'two-spheres@far', 'degenerate@tiny']
SPOILED = ['degenerate', 'cloth:8']  # small, so that every change of their certificates is tried
SLOW = ['shells:4', 'cad-cut:2000', 'crumpled:1000', 'crowd:60']  # 100 s: not in ctest
VERDICT = re.compile(r'(?:verified +)?(proved|refuted|not proved|undecided)\b')


def output(words):
    done = subprocess.run(words, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, stdin=subprocess.DEVNULL, check=False)
    return done.returncode, done.stdout.decode('utf-8', 'replace')


def verdict(words):
    """What a checker says: its exit status and the word of its verdict; no word if it cannot read the file."""
    status, text = output(words)
    words = [found[1] for line in text.split('\n') if (found := VERDICT.match(line))]
    return status, words[-1] if status < 2 and words else '', text


def write(path, text):
    with open(path, 'wb') as file:
        file.write(text if isinstance(text, bytes) else text.encode())


def meshes(folder):
    """The objects of a scene that farcull has written: whether it is tested against itself, and its triangles."""
    for one in json.load(open(f'{folder}/scene.json', encoding='utf-8'))['objects']:
        words = open(f"{folder}/{one['mesh']}", encoding='utf-8').read().split()
        vertices, faces = int(words[1]), int(words[2])
        points = [tuple(map(float, words[4 + 3 * i:7 + 3 * i])) for i in range(vertices)]
        start = 4 + 3 * vertices
        yield one.get('self', False), [[points[int(words[start + 4 * f + k])] for k in (1, 2, 3)] for f in range(faces)]


def write_words(path, objects):
    """The scene as the words that farcull check --verified writes: docs/verified.md."""
    with open(path, 'wb') as file:
        file.write(struct.pack('<Q', len(objects)))
        file.write(b''.join(struct.pack('<Q', len(triangles) | inner << 32) for inner, triangles in objects))
        for _, triangles in objects:
            file.write(b''.join(struct.pack('<3d', *point) for triangle in triangles for point in triangle))


def write_scene(folder, objects, ending='', meshes=True):
    os.makedirs(folder, exist_ok=True)
    for index, (_, triangles) in enumerate(objects if meshes else []):
        with open(f'{folder}/o{index}{ending}.off', 'w', encoding='utf-8') as file:
            file.write(f'OFF\n{3 * len(triangles)} {len(triangles)} 0\n')
            file.writelines('%.17g %.17g %.17g\n' % tuple(point) for triangle in triangles for point in triangle)
            file.writelines(f'3 {3 * t} {3 * t + 1} {3 * t + 2}\n' for t in range(len(triangles)))
    with open(f'{folder}/scene.json', 'w', encoding='utf-8') as file:
        json.dump({'objects': [{'name': f'o{i}', 'mesh': f'o{i}{ending}.off', **({'self': True} if inner else {})}
                               for i, (inner, _) in enumerate(objects)]}, file)


ULP = 2.0 ** -52
# The scene of tests/fuzz/fuzz_check.cpp.
FUZZ_SCENE = [(False, triangles) for triangles in (
    [[(0, 0, 0), (4, 0, 0), (0, 4, 0)], [(4, 0, 0), (4, 4, 0), (0, 4, 0)]],
    [[(1, 1, -1), (1, 1, 1), (2, 1, 1)], [(0, 0, 0), (-1, 0, 2), (0, -1, 2)], [(1, 0, 0), (3, 0, 0), (2, -1, 1)],
     [(3, 3, 0), (3.5, 3, 0), (3, 3.5, 0)], [(1, 1, ULP), (2, 1, 1), (1, 2, 1)]],
    [[(2, 2, -1), (2, 2, 1), (2, 2, 3)], [(1, 1, 0), (1, 1, 0), (1, 1, 0)], [(3.9, 3.9, -1), (4.5, 3.9, 1), (4.5, 4.5, 1)],
     [(2, 1 + ULP, 1), (1, 2 + 2 * ULP, 1), (2, 2, 1.5)]])]


def random_triangles(draw, count, scale, most):
    """Objects of triangles whose corners lie on a small grid: most pairs touch, and many lie in one plane or on one line."""
    side, flat = draw.choice([2, 2, 3, 4]), draw.random() < 0.3
    for _ in range(count):
        corners = [tuple(scale * (0 if flat and axis == 2 else draw.randrange(side)) for axis in range(3))
                   for _ in range(draw.choice([4, 6, 10, 3 * most]))]
        yield [[draw.choice(corners) for _ in range(3)] for _ in range(draw.randrange(2, most))]


def recount(root, data):
    kinds = [byte & 0xbf for byte in data]
    counts = {'box_pairs': len(data), 'kept': sum(byte >> 6 & 1 for byte in data), 'meeting': kinds.count(38),
              'neighbours': kinds.count(39)}
    counts['culled'] = len(data) - counts['kept']
    counts['separated'] = len(data) - counts['meeting'] - counts['neighbours']
    root['claims'].update(counts)


def forged(text, number):
    """Changes of the certificate that tests/verify/certificate/certificate_test.cpp makes, and some of its text."""
    draw = random.Random(number)
    root = json.loads(text)
    data = bytearray(base64.b64decode(root['evidence']))

    def made(change, recounted=False):
        other, bytes_ = json.loads(text), bytearray(data)
        change(other, bytes_)
        if recounted:
            recount(other, bytes_)
        other['evidence'] = base64.b64encode(bytes(bytes_)).decode()
        return json.dumps(other)

    def set_byte(i, byte):
        return lambda _, bytes_: bytes_.__setitem__(i, byte)

    def add(part, key, by):
        return lambda other, _: other[part].__setitem__(key, (other[part][key] + by) % 2 ** 64)

    if data:
        for byte in (*draw.sample(range(40), 3), 38, 39, 0x40 | draw.randrange(38), 0x40 | 38, 0x40 | 39, 45, 63, 128 + 38, 255):
            yield made(set_byte(draw.randrange(len(data)), byte), draw.random() < 0.5)
        yield made(lambda _, bytes_: bytes_.pop(draw.randrange(len(bytes_))), True)
        yield made(lambda _, bytes_: bytes_.reverse(), True)
        yield made(lambda _, bytes_: bytes_.__setitem__(slice(None), bytes(byte | 0x40 for byte in bytes_)), True)
        yield made(lambda _, bytes_: bytes_.__setitem__(slice(None), bytes(byte & 0xbf for byte in bytes_)), True)
        yield made(lambda _, bytes_: bytes_.clear())
    yield made(lambda _, bytes_: bytes_.append(0x40 | 38), True)
    for part, key in (('claims', draw.choice(sorted(root['claims']))), ('not_asked', 'objects'), ('not_asked', 'pairs'),
                      ('scene', 'objects'), ('scene', 'triangles')):
        yield made(add(part, key, draw.choice([1, -1, 2 ** 63])))
    yield made(lambda other, _: other.update(list_sha256='0' * 64))
    yield made(lambda other, _: other['scene'].update(hash='0' * 16))


def forged_lists(text, rows, counts):
    """Certificates of lists that are not right: one row is there twice, names nothing, is out of range, is the other way round, or
    is about a triangle and itself. Of each one with the old evidence, and one with a byte more. rows: the list that is right;
    counts: how many triangles each object has."""
    root = json.loads(text)
    data = base64.b64decode(root['evidence'])
    lines = rows.splitlines(keepends=True)
    if len(lines) == 1:
        return
    at = len(lines) // 2 + 1
    meeting = [k for k, byte in enumerate(data) if byte & 0xbf == 38]
    cells = lines[at - 1].rstrip('\n').split(',')
    one, other, rest = cells[:2], cells[2:4], cells[4:]
    for row in (cells, ['', '', '', '', *rest], ['-1', *cells[1:]], [str(len(counts)), *cells[1:]],
                [one[0], str(counts[int(one[0])]), *cells[2:]], [*other, *one, *rest], [*one, *one, *rest]):
        changed = ''.join(lines[:at] + [','.join(row) + '\n'] + lines[at:]).encode()
        made = json.loads(text)
        made['list_sha256'] = hashlib.sha256(changed).hexdigest()
        yield json.dumps(made)
        place = meeting[at - 2]
        bytes_ = data[:place] + data[place:place + 1] + data[place:]
        made['evidence'] = base64.b64encode(bytes_).decode()
        recount(made, bytes_)
        yield json.dumps(made)


def spoiled(text):
    """Files that are no certificates, and unusual ones that are."""
    root = json.loads(text)
    evidence = root['evidence']

    def made(**changes):
        return json.dumps({**root, **changes})

    yield from ('', '{}', '[]', 'null', text[:-3], text + 'x', text + ' \n\t', '\ufeff' + text, text.replace('"format"', '"Format"'),
                text.replace('{', '{"format": "farcull-certificate",', 1), text.replace(',', ',,', 1), text.replace(':', ' : '))
    yield from (made(version=2), made(version='3'), made(version=3.0), made(more=1), made(scene=None), made(claims={}),
                made(list_sha256=root['list_sha256'].upper() + '0'), made(evidence=evidence + '='), made(evidence=evidence + 'A'),
                made(evidence=evidence + '\n'), made(evidence=None), made(format='farcull'), made(unattested=[]))
    for change in ({'device': {}}, {'device': dict.fromkeys(['vendor', 'renderer', 'version', 'glsl'], 'Ü\n"')}, {'views': [1]},
                   {'radius_px': -1}, {'radius_px': 1e308}, {'resolution': 1.5}, {'resolution': 2 ** 64}, {'assumptions': ['é']},
                   {'views': [{'name': '', 'width': 1, 'height': 1, 'radius_px': 0}]}, {'assumptions': [[[[[[[[1]]]]]]]]},
                   {'assumptions': ['a'] * 10000}):
        yield made(unattested={**root['unattested'], **change})
    for old, new in (('"radius_px": 0.0', '"radius_px": 1e999'), ('"radius_px": 0.0', '"radius_px": 01'),
                     ('"resolution": 0', '"resolution": -0'), ('"none"', '"\\ud83d\\ude00"'), ('"none"', '"\\ud83d"'),
                     ('"none"', '"\t"'), ('"none"', '"\\x"'), ('"none"', "'none'"), ('null', 'nul'), ('"device": null', '"device": true')):
        yield text.replace(old, new, 1)


class Comparison:
    def __init__(self, farcull, checker):
        self.farcull, self.checker, self.seen, self.wrong = farcull, checker, {}, []

    def both(self, certificate, scene, words, why, tiles=0):
        """tiles: how many certificates there are, with a number in their name; 0: one without."""
        files = [certificate % k for k in range(1, tiles + 1)] if tiles else [certificate]
        one = verdict([self.farcull, 'check', certificate, scene, *(['--tiles', str(tiles)] if tiles else [])])
        two = verdict([self.checker, *(['--tiles'] if tiles else []), *files, words])
        self.seen[one[1] or f'status {one[0]}'] = self.seen.get(one[1] or f'status {one[0]}', 0) + 1
        if one[:2] != two[:2]:
            kept = f'{files[0]}.{len(self.wrong)}'
            for k, file in enumerate(files):
                shutil.copy(file, f'{kept}{k or ""}')
            self.wrong.append(f'{why} ({kept}, {scene}, {words})\n  farcull: {one[2][:300]}\n  verified: {two[2][:600]}')
        return two[1]

    def fuzzed(self, archive, folder):
        """The inputs of the fuzzer of certificates."""
        write_scene(folder, FUZZ_SCENE)
        write_words(f'{folder}/words', FUZZ_SCENE)
        with tarfile.open(archive) as inputs:
            for member in filter(tarfile.TarInfo.isfile, inputs.getmembers()):
                write(f'{folder}/certificate.json', inputs.extractfile(member).read())
                self.both(f'{folder}/certificate.json', f'{folder}/scene.json', f'{folder}/words', f'fuzz input {member.name}')

    def called(self, certificate, scene, folder):
        """farcull check --verified calls the program beside it, and fails if that disagrees."""
        said = output([self.farcull, 'check', certificate, scene, '--verified'])
        if said[0] or not re.search('^verified +proved: ', said[1], re.MULTILINE):
            self.wrong.append(f'check --verified: {said}')
        program, other = f'{folder}/farcull', f'{folder}/farcull-check-verified'
        shutil.copy(self.farcull, program)
        write(other, '#!/bin/sh\n' + ''.join(f'echo "verified   {name} sha256 $(sha256sum <"{argument}" | cut -c1-64)"\n' for name, argument in (
            ('certificate', '$1'), ('scene      ', '$2'))) + 'echo "verified   refuted"\nexit 1\n')
        os.chmod(other, 0o755)
        said = output([program, 'check', certificate, scene, '--verified'])
        if said[0] != 2 or 'the two checkers disagree' not in said[1]:
            self.wrong.append(f'check --verified with a checker that disagrees: {said}')
        os.remove(program)

    def tiles(self, name, folder, objects, number, clearance):
        """Certificates of tiles, one by one and together; and forged ones: one is missing or there twice, a border is moved, one
        runs backwards, a pair is left out, one is of another scene."""
        scene, words, file, draw = f'{folder}/scene.json', f'{folder}/words', f'{folder}/t%d.json', random.Random(number)
        write_words(words, objects)
        count = draw.randrange(2, 5)
        for k in range(1, count + 1):
            status, text = output([self.farcull, 'run', scene, '--no-verify', '--clearance', repr(clearance),
                                   '--tiles', f'{k}/{count}', '--certificate', file % k])
            if status:
                if 'nothing to test' not in text:
                    self.wrong.append(f'{name}: no certificate of a tile: {text[:300]}')
                return
        texts = [open(file % k, encoding='utf-8').read() for k in range(1, count + 1)]

        def together(others, why, proved=False):
            for k, text in enumerate(others, 1):
                write(file % k, text)
            seen = self.both(file, scene, words, f'{name}, tiles, {why}', len(others))
            if (seen == 'proved') != proved:
                self.wrong.append(f'{name}, tiles, {why}: {seen} ({scene}, {file})')

        together(texts, 'all', True)
        roots = [json.loads(text) for text in texts]
        which = draw.choice([k for k, root in enumerate(roots) if root['tile']['from'] != root['tile']['to']])  # one that is not empty
        self.both(file % (which + 1), scene, words, f'{name}, tile {which + 1} of {count}')
        write(file % (which + 1), draw.choice(list(forged(texts[which], number))))
        self.both(file % (which + 1), scene, words, f'{name}, a tile that is changed')
        together(texts[:which] + texts[which + 1:], 'one is missing')
        together(texts[:which] + [texts[which]] + texts[which:], 'one is there twice')
        border = draw.randrange(count - 1)
        moved = roots[border]['tile']['to'] + draw.choice([-1, 1]) * 2.0 ** -20 * (abs(roots[border]['tile']['to']) + 1)
        roots[border]['tile']['to'] = moved
        together([json.dumps(root) for root in roots], 'a border is moved')
        backwards = json.loads(texts[which])
        tile = backwards['tile']
        if None not in (tile['from'], tile['to']):
            tile['from'], tile['to'] = tile['to'], tile['from']
            together(texts[:which] + [json.dumps(backwards)] + texts[which + 1:], 'one runs backwards')
        if data := base64.b64decode(roots[which]['evidence']):
            at = draw.randrange(len(data))
            root, fewer = json.loads(texts[which]), data[:at] + data[at + 1:]
            root['evidence'] = base64.b64encode(fewer).decode()
            recount(root, fewer)
            together(texts[:which] + [json.dumps(root)] + texts[which + 1:], 'a pair is left out')
        root = json.loads(texts[which])
        root['scene']['hash'] = 'f' * 16
        together(texts[:which] + [json.dumps(root)] + texts[which + 1:], 'one is of another scene')

    def batch(self, number, size, folder):
        """Random scenes, without and with a clearance, as the frames of one scene: farcull then checks all of them at once.
        The first one is also divided into tiles."""
        draw = random.Random(number)
        count = draw.choice([1, 2, 2, 3])
        inner = [count == 1 or draw.random() < 0.7 for _ in range(count)]
        scale = draw.choice([1.0, 0.1, 3e-5, 1e10])
        clearance = scale * draw.choice([1, 1, 0.5, 2, 2 ** 0.5, 3 ** 0.5, 1e-3])
        most = 40 if number % 25 == 0 else 12  # the time grows with the square
        frames = [list(zip(inner, random_triangles(random.Random(f'{number} {k}'), count, scale, most))) for k in range(size)]
        scene, texts = f'{folder}/scene.json', []
        for k, objects in enumerate(frames):
            write_scene(folder, objects, f'_{k}')
            write_words(f'{folder}/words_{k}', objects)
        write_scene(folder, frames[0], '_%d', False)
        for how in (['--method', 'exact'], ['--method', 'boxes', '--clearance', repr(clearance)]):
            name = f'random scenes {number} {how[1]}'
            status, text = output([self.farcull, 'run', scene, '--frames', f'0:{size - 1}', '--no-verify', *how, '--certificate', f'{folder}/c_%d.json'])
            if status:
                self.wrong.append(f'{name}: no certificates: {text[:300]}')
                continue
            texts = [open(f'{folder}/c_{k}.json', encoding='utf-8').read() for k in range(size)]
            changed = [random.Random(number).sample(list(forged(text, f'{number} {k}')), 3) for k, text in enumerate(texts)]
            self.frames(name, folder, size)
            for n in range(3):
                for k in range(size):
                    write(f'{folder}/c_{k}.json', changed[k][n])
                self.frames(f'{name}, changed', folder, size)
        write_scene(folder, frames[0])
        self.tiles(f'random scene {number}', folder, frames[0], number, clearance if number % 2 == 0 else 0)

    def frames(self, name, folder, size):
        """Both verdicts about the certificate of each frame."""
        text = output([self.farcull, 'check', f'{folder}/c_%d.json', f'{folder}/scene.json', '--frames', f'0:{size - 1}', '--json', '-'])[1]
        try:
            said = [frame['verdict'] for frame in json.loads(text)['frames']]
        except ValueError:
            said = []
        if len(said) != size:
            self.wrong.append(f'{name}: not checked: {text[:300]}')
            return
        text = output([self.checker, *(f'{folder}/{name}' for k in range(size) for name in (f'c_{k}.json', f'words_{k}'))])[1]
        proved = [found[1] for line in text.split('\n') if (found := VERDICT.match(line))]
        if len(proved) != size:
            self.wrong.append(f'{name}: not verified: {text[-300:]}')
            return
        for k, (one, two) in enumerate(zip(said, proved)):
            self.seen[two] = self.seen.get(two, 0) + 1
            if one != two:
                kept = f'{folder}/c_{k}.json.{len(self.wrong)}'
                shutil.copy(f'{folder}/c_{k}.json', kept)
                self.wrong.append(f'{name}, frame {k} ({kept})\n  farcull: {one}\n  verified: {two}')

    def scene(self, name, folder, objects, number, spoil=False, clearance=None):
        scene, words, certificate, pairs = (f'{folder}/{file}' for file in ('scene.json', 'words', 'certificate.json', 'pairs.csv'))
        write_words(words, objects)
        how = ['--method', 'exact'] if clearance is None else ['--method', 'boxes', '--clearance', repr(clearance)]
        status, text = output([self.farcull, 'run', scene, *how, '--certificate', certificate, '--pairs', pairs])
        if status:
            self.wrong.append(f'{name}: no certificate: {text[:300]}')
            return
        text = open(certificate, encoding='utf-8').read()
        self.both(certificate, scene, words, name)
        lists = list(forged_lists(text, open(pairs, encoding='utf-8').read(), [len(triangles) for _, triangles in objects]))
        for index, other in enumerate(lists if spoil else random.Random(number).sample(lists, min(2, len(lists)))):
            write(certificate, other)
            if (seen := self.both(certificate, scene, words, f'{name}, list {index}')) != 'not proved':
                self.wrong.append(f'{name}, list {index}: {seen}')
        write(certificate, text)
        if spoil:
            self.called(certificate, scene, folder)
        changed = list(forged(text, number))
        if not spoil:
            changed = random.Random(number).sample(changed, min(3, len(changed)))
        for index, other in enumerate(changed + (list(spoiled(text)) if spoil else [])):
            write(certificate, other)
            self.both(certificate, scene, words, f'{name}, change {index}')


def compare(farcull, checker, folder, count):
    comparison = Comparison(os.path.realpath(farcull), os.path.realpath(checker))
    for index, name in enumerate(BUILT_IN):
        if count <= 20 and name in SLOW:
            continue
        place = f"{folder}/{re.sub('[^a-z0-9]', '-', name)}"
        os.makedirs(place, exist_ok=True)
        status, text = output([comparison.farcull, 'scenes', name, '--write', place])
        if status:
            comparison.wrong.append(f'{name}: {text[:300]}')
            continue
        objects = list(meshes(place))
        comparison.scene(name, place, objects, index, spoil=name in SPOILED)
        points = [point for _, triangles in objects for triangle in triangles for point in triangle]
        size = max(max(axis) - min(axis) for axis in zip(*points))
        comparison.tiles(name, place, objects, index, 0)
        comparison.scene(f'{name} with a clearance', place, objects, index, spoil=name == SPOILED[0], clearance=size * 10 ** -(3 + index % 4))
    comparison.fuzzed('tests/fuzz/corpus/check.tar.gz', f'{folder}/fuzz')
    place = f'{folder}/random'
    first = int(os.environ.get('FARCULL_SEED', '0')) * 1000000
    size = 40 if count > 100 else 10
    wanted = {'proved', 'refuted', 'not proved', 'status 2'}
    for number in range(first, first + 20 * count // size):
        if number >= first + count // size and wanted <= set(comparison.seen):
            break
        comparison.batch(number, size, place)
    print('verified: ' + ', '.join(f'{n} {said}' for said, n in sorted(comparison.seen.items())) +
          f'; the two checkers disagree about {len(comparison.wrong)}')
    print('\n'.join(comparison.wrong[:5]))
    return bool(comparison.wrong or wanted - set(comparison.seen))


# Changes of the checker.
MUTANTS = [
    ('clearance * clearance * dot d d <? gap * gap', 'clearance * clearance * dot d d <=? gap * gap'),
    ('(0 <=? y w) && (0 <=? z w)', '(y w <=? 0) && (0 <=? z w)'),
    ('(0 <? total w)', '(0 <=? total w)'),
    ('clearance * clearance * dot d d <? gap * gap', 'gap * gap <=? clearance * clearance * dot d d'),
    ('(d <=? r)', '(r <=? d)'),
    ('(dot e r <? 0)', '(dot e r <=? 0)'),
    ('(m * dot e e <? dot e r)', '(m * dot e e <=? dot e r)'),
    ('(0 <=? n) && (n <=? l)', '(n <=? 0) && (n <=? l)'),
    ('(0 <=? n) && (n <=? l)', '(0 <=? n) && (l <=? n)'),
    ('dot d (corner a j) <=? h) la', 'h <=? dot d (corner a j)) la'),
    ('h <=? dot d (corner b j)) lb', 'dot d (corner b j) <=? h) lb'),
    ('(x l <=? x h\')', '(x l <? x h\')'),
    ('(obj a <? obj b) || ((obj a =? obj b)', '(obj a <=? obj b) || ((obj a =? obj b)'),
    ('own a && (num a <? num b)', 'own a && (num a <=? num b)'),
    ('((obj a <? last b) ||', '((last b <? obj a) ||'),
    ('scaled e d <? scaled e place', 'scaled e d <=? scaled e place'),
    ('scaled e place <=? scaled e d + scaled e reach', 'scaled e place <? scaled e d + scaled e reach'),
    ('(coordinate k (lo a) <? p)', '(coordinate k (lo a) <=? p)'),
    ('negb (both_before e (tile_axis t) p a b)', 'both_before e (tile_axis t) p a b'),
    ('m * dot w w <=? n * (r * r)', 'n * (r * r) <=? m * dot w w'),
    # A row twice, a row that names nothing, a pair in two tiles.
    ('if mine a b then (a, b) :: done else done', 'if mine a b then (a, b) :: (a, b) :: done else done'),
    ('if is_kind k Meeting then r :: rows t else rows t', 'if is_kind k Meeting then r :: r :: rows t else rows t'),
    ('(Tally [] None None', '(Tally [Row (-1) 0 0 0 false] None None'),
    (' && negb (is_backwards b) then', ' then')]
FILES = ['Checker', 'Geometry', 'Points', 'Descent', 'Pairs', 'Scaling', 'Proofs']

# Of the passes, and of the statements about one view. Each file, and the files that prove things of it.
CULLING = {
    'Passes': (['Passes', 'PassProofs'], [
        ('if second p then rev (seq 0 (owners w)) else', 'if second p then seq 0 (owners w) else'),
        ('asks p t && negb (undrawable (along p) t)', 'asks p t'),
        ('undrawable v u || behind v t u.', 'behind v t u.'),
        ('existsb (hides (along p) t) stored) asked\n', 'existsb (hides (along p) t) stored) (firstn 1 asked)\n'),
        ('(fun u => negb (mem u (bit (negb second) b)))', '(fun u => negb (mem u (bit second b)))'),
        ('mem t (f b) && mem t (l b)', 'mem t (f b) || mem t (l b)'),
        ('Bits (f b) (cleared w p ++ l b)', 'Bits (cleared w p ++ f b) (l b)'),
        ('(owner w u =? o) && stores p u', '(owner w u <? o) && stores p u'),
        ('(negb (mem u (l b)) && negb (mem t (f b)))', '(negb (mem t (l b)) && negb (mem u (f b)))'),
        ('negb (drawn u t) || (owner w u =? owner w t) ||', '(owner w u =? owner w t) ||'),
        ('negb (drawn u t) || (owner w u =? owner w t) ||', 'negb (drawn u t) ||'),
        ('if drawn u t then [u; t] else', 'if drawn u t then [u] else'),
        ('sees v u t /\\ sees v t u.', 'sees v u t.'),
        ('In t g -> owner w t = o.', 'In t g -> owner w t <= o.'),
        ('~ In u (l b) /\\ ~ In t (f b).', '~ In u (f b) /\\ ~ In t (l b).')]),
    'Fan': (['Fan'], [
        ('(small : E < 1)', '(small : E < 2)'),
        ('bound + 1 <= s * Q i', 'bound <= s * Q i'),
        ('s * computed c i <= bound', 'bound <= s * computed c i'),
        ('if Rlt_dec 0 (side p q) then 1%Z', 'if Rlt_dec (side p q) 0 then 1%Z')]),
    'View': (['View'], [
        ('sqrt 2 / 2 + sqrt 2 * E', '1 / 2 + sqrt 2 * E'),
        ('sqrt 2 / 2 + sqrt 2 * E', 'sqrt 2 / 2 + E'),
        ('Definition double (E : R) : R := E ^ 2', 'Definition double (E : R) : R := E ^ 4'),
        ('d + w < r ->', 'd < r ->'),
        ('squared p Q\' <= r ^ 2 -> solid p', 'solid p -> squared p Q\' <= r ^ 2')])}


def mutants(sources, folder):
    """Each change compiles as a program, and its proof does not. Of the view, whose files have their statements beside the proofs,
    only that the file is refused, and not for its syntax."""
    os.makedirs(folder, exist_ok=True)
    tables = CULLING if os.path.exists(f'{sources}/Passes.v') else {'Checker': (FILES, MUTANTS)}
    failed, number = [], 0
    for changed, files, old, new in ((name, files, *row) for name, (files, table) in tables.items() for row in table):
        number += 1
        text = open(f'{sources}/{changed}.v', encoding='utf-8').read()
        if text.count(old) != 1:
            failed.append(f'{old!r} does not occur once')
            continue
        for name in os.listdir(sources):
            if name.endswith(('.v', '.vo')):
                shutil.copy(f'{sources}/{name}', folder)
        write(f'{folder}/{changed}.v', text.replace(old, new))
        broken, why = 'none', ''
        for name in files:
            status, why = output(['timeout', '300', 'sh', '-c', f'cd {folder} && exec coqc -q {name}.v'])
            if status:
                broken = name
                break
        print(f'mutant {number}: {old.strip()}  ->  {new.strip()}: breaks {broken}', flush=True)
        if broken == 'none' or (broken == changed and len(files) > 1) or 'Syntax error' in why:
            failed.append(f'{new!r} breaks {broken}')
    print('\n'.join(failed) or f'mutants: each of the {number} changes breaks the proof')
    return bool(failed)


command, *rest = sys.argv[1:]
sys.exit(compare(*rest[:3], int(rest[3])) if command == 'compare' else mutants(*rest))
