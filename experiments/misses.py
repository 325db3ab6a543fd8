"""Compares the misses that `farcull plan` predicts with the misses of runs. Uses families of scenes that were not used to
make the model. Writes the table to docs/results/misses.md and docs/results/misses.csv. Takes minutes.
   experiments/misses.py FARCULL"""
import csv
import json
import math
import os
import random
import subprocess
import sys
import tempfile
from pathlib import Path


def plus(a, b, factor=1):
    return [p + factor * q for p, q in zip(a, b)]


def unit(a):
    return [p / math.hypot(*a) for p in a]


def direction():
    return unit([random.gauss(0, 1) for _ in range(3)])


def cross(a, b):
    return [a[i - 2] * b[i - 1] - a[i - 1] * b[i - 2] for i in range(3)]


def bar(start, end, width, sides, pieces=1, faces=None):
    """Returns a prism whose long faces are cut into pieces. faces: the number of long faces, without ends; None: closed."""
    axis = unit([q - p for p, q in zip(start, end)])
    across = unit(cross(axis, direction()))
    other, rings, turn = cross(axis, across), [], random.random()
    for i in range(pieces + 1):
        middle = [p + (q - p) * i / pieces for p, q in zip(start, end)]
        rings += [plus(plus(middle, across, width / 2 * math.cos(2 * math.pi * (j / sides + turn))), other,
                       width / 2 * math.sin(2 * math.pi * (j / sides + turn))) for j in range(sides)]
    corners = [t for i in range(pieces) for j in range(faces or sides) for a, b in [(i * sides + j, i * sides + (j + 1) % sides)]
               for t in [(a, b, a + sides), (b, b + sides, a + sides)]]
    last = pieces * sides
    caps = [t for j in range(1, sides - 1) for t in [(0, j + 1, j), (last, last + j, last + j + 1)]]
    return rings, corners + ([] if faces else caps)


def crossed(count, families, width, **shape):
    """Returns families of count x count parallel bars. Each family is an object."""
    objects = [([], []) for _ in range(families)]
    for axis, (points, triangles) in enumerate(objects):
        for k in range(count * count):
            start = [(at + 0.5) / count + width * random.uniform(-0.5, 0.5) for at in (k % count, k // count)]
            start.insert(axis, 0)
            more, corners = bar(start, plus(start, [axis == i for i in range(3)]), width, **shape)
            triangles += [[at + len(points) for at in corner] for corner in corners]
            points += more
    return objects


def scattered(count, length, width, **shape):
    """Returns bars at random places in a unit cube. Each bar is an object."""
    places = (([random.random() for _ in range(3)], direction()) for _ in range(count))
    ends = [(plus(at, way, -length / 2), plus(at, way, length / 2)) for at, way in places]
    return [bar(*both, width, **shape) for both in ends]


def terrain(cells, height):
    phase = [random.uniform(0, 6) for _ in range(4)]
    points = [[i / cells, j / cells, 0.5 + height * (math.sin(7 * i / cells + phase[0]) + math.sin(11 * j / cells + phase[1]) +
                                                    math.sin(13 * (i + j) / cells + phase[2]))]
              for i in range(cells + 1) for j in range(cells + 1)]
    row = cells + 1
    return points, [t for i in range(cells) for j in range(cells) for a in [i * row + j]
                    for t in [(a, a + row, a + 1), (a + 1, a + row, a + row + 1)]]


def confetti(count, size):
    corners = [plus(at, direction(), size) for at in ([random.random() for _ in range(3)] for _ in range(count)) for _ in range(3)]
    return corners, [(3 * i, 3 * i + 1, 3 * i + 2) for i in range(count)]


FAMILIES = {
    'crossed: 8 x 8 triangular bars in 3 directions, 0.006 wide': lambda: crossed(8, 3, 0.006, sides=3),
    'crossed: 7 x 7 hexagonal bars in 3 directions, 0.012 wide': lambda: crossed(7, 3, 0.012, sides=6),
    'crossed: 9 x 9 square bars in 2 directions, 0.02 wide': lambda: crossed(9, 2, 0.02, sides=4),
    'crossed: 5 x 5 tubes of 16 faces in 3 directions, 0.03 wide': lambda: crossed(5, 3, 0.03, sides=16),
    'crossed: 8 x 8 open angles (2 faces) in 2 directions, 0.014 wide': lambda: crossed(8, 2, 0.014, sides=4, faces=2),
    'scattered: 250 pentagonal bars, 0.4 x 0.02': lambda: scattered(250, 0.4, 0.02, sides=5),
    'scattered: 200 triangular bars, 1 x 0.005': lambda: scattered(200, 1, 0.005, sides=3),
    'scattered: 120 square bars, 1 x 0.012, cut into 12 pieces': lambda: scattered(120, 1, 0.012, sides=4, pieces=12),
    'scattered: 400 short square bars, 0.08 x 0.06': lambda: scattered(400, 0.08, 0.06, sides=4),
    'bars and a terrain: 9 x 9 square bars, 0.01 wide; 40 x 40 cells':
        lambda: crossed(9, 1, 0.01, sides=4) + [terrain(40, 0.05)],
    'two terrains: 50 x 50 cells': lambda: [terrain(50, 0.03), terrain(50, 0.03)],
    'confetti: two objects of 700 triangles, radius 0.05': lambda: [confetti(700, 0.05), confetti(700, 0.05)],
}


def rows(program):
    for family, make in FAMILIES.items():
        for seed in range(1, 9):
            random.seed(seed)
            turn = {'axis': direction(), 'angle': random.uniform(0, 6)}
            with tempfile.TemporaryDirectory() as folder:
                scene = []
                for k, (points, corners) in enumerate(make()):
                    scene.append({'mesh': f'{k}.off', 'rotate': turn})
                    text = ''.join(f'{x!r} {y!r} {z!r}\n' for x, y, z in points) + ''.join(f'3 {a} {b} {c}\n' for a, b, c in corners)
                    Path(folder, f'{k}.off').write_text(f'OFF\n{len(points)} {len(corners)} 0\n{text}', 'utf-8')
                Path(folder, 'scene.json').write_text(json.dumps({'name': 'family', 'objects': scene}), 'utf-8')
                for resolution in 128, 512:
                    def record(command, *more):
                        words = [program, command, f'{folder}/scene.json', '--method', 'cullide', '--resolution', str(resolution)]
                        subprocess.run([*words, '--json', f'{folder}/out', *more], stdout=subprocess.DEVNULL, check=True)
                        return json.loads(Path(folder, 'out').read_text('utf-8'))
                    of = record('plan')['misses']
                    missed = record('run', '--device', 'native')['verification']['false_negatives']
                    low, high = math.floor(of['low']), math.ceil(of['high'])
                    yield [family, seed, resolution, of['colliding'], round(of['expected']), low, high, missed,
                           *('yes' if yes else 'no' for yes in (low <= missed <= high, of['judged']))]


def inside(runs):
    return f'{sum(row[8] == "yes" for row in runs)} of {len(runs)}'


HEAD = ['family', 'seed', 'resolution', 'colliding', 'predicted', 'low', 'high', 'missed', 'inside', 'judged']
results = Path(__file__).resolve().parents[1] / 'docs/results'
table = list(rows(os.path.abspath(sys.argv[1])))
with open(results / 'misses.csv', 'w', encoding='utf-8', newline='') as csv_file:
    csv.writer(csv_file, lineterminator='\n').writerows([HEAD, *table])
lines = ['| family | inside, of all runs | inside, of those judged | missed over predicted at 512 px |', '|---|---:|---:|---:|']
for name in [*FAMILIES, 'all, seeds 1 to 4', 'all, seeds 5 to 8']:
    runs = [row for row in table if name == row[0] or name[-6:] == ('1 to 4' if row[1] < 5 else '5 to 8')]
    ratios = [row[7] / row[4] for row in runs if row[2] == 512]
    judged = inside([row for row in runs if row[9] == 'yes'])
    lines.append(f'| {name} | {inside(runs)} | {judged} | {min(ratios):.2f} to {max(ratios):.2f} |')
page = results / 'misses.md'
page.write_text('\n'.join([page.read_text('utf-8').split('\n## Table')[0], '## Table', *lines, '']), 'utf-8')
