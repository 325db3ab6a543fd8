"""Makes parts of the pages of docs/results again and compares them with what the pages say:
    /usr/bin/python3 tests/results_test.py [PAGE...]
Each page names a command that makes it. Here it runs with its smallest grid, from a build in build/. A page that a command writes
must have the same columns; where the small grid has scenes of the page, also the same counts. A row that somebody typed must have
the counts that the command prints. Times are not compared. Last comes how often the code that a page measures has changed since
its commit. A quarter of an hour on two cores. Exit status: 0, or 1 if something differs."""
import json
import os
import re
import subprocess
import sys
import tempfile

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
FARCULL = os.path.join(ROOT, 'build', 'farcull')
METHODS = ['core', 'offsets', 'verify', 'experiments/method']


def read(path):
    with open(path, encoding='utf-8') as file:
        return file.read()


def page_text(page):
    return read(f'{ROOT}/docs/results/{page}.md')


def call(*words, statuses=(0,)):
    """What the command prints; an error if it fails."""
    ran = subprocess.run(words, cwd=ROOT, capture_output=True, text=True, env={**os.environ, 'FARCULL_BUILT': '1'})
    if ran.returncode not in statuses:
        raise RuntimeError(f'{" ".join(words)}: status {ran.returncode}\n{ran.stdout[-500:]}{ran.stderr[-1500:]}')
    return ran.stdout


def record(*words, missing=False):
    """The JSON of a command. missing: it may end with 1, since pairs are missed on purpose."""
    with tempfile.TemporaryDirectory() as folder:
        call(FARCULL, *words, '--json', f'{folder}/r.json', statuses=(0, 1) if missing else (0,))
        return json.loads(read(f'{folder}/r.json'))


def tables(text):
    """Each table of a page: its columns, and its rows as lists of cells."""
    out = []
    for block in re.findall(r'(?:^\|.*\|\n)+', text, re.MULTILINE):
        cells = [[cell.strip() for cell in line.strip('|\n').split('|')] for line in block.strip().split('\n')]
        if len(cells) > 2:
            out.append((cells[0], cells[2:]))
    return out


def columns_differ(page, made):
    known = [head for head, _ in tables(page_text(page))]
    return [f'the page has no table with the columns {head}' for head, _ in tables(made) if head not in known]


def counts_differ(page, made, columns, keys):
    """Cells of these columns in the tables that both have. The first `keys` cells name a row."""
    old = {(tuple(head), *row[:keys]): row for head, rows in tables(page_text(page)) for row in rows}
    heads = {key[0] for key in old}
    out, compared = [], 0
    for head, rows in tables(made):
        counts = [k for k, name in enumerate(head) if re.fullmatch(columns, name)]
        for row in rows if tuple(head) in heads and counts else []:
            words, of = ', '.join(row[:keys]), old.get((tuple(head), *row[:keys]))
            if not of:
                out.append(f'the page has no row {words}')
                continue
            compared += len(counts)
            out += [f'{words}, {head[k]}: {of[k]} on the page, now {row[k]}' for k in counts if row[k] != of[k]]
    return out if compared else [*out, 'no count was compared']


def lacks_row(page, *cells):
    """Whether no row of the page begins with these cells, numbers with commas in thousands."""
    wanted = [cell if isinstance(cell, str) else f'{cell:,}' for cell in cells]
    if any(row[:len(wanted)] == wanted for _, rows in tables(page_text(page)) for row in rows):
        return []
    return [f'no row begins with {" | ".join(wanted)}']


def written(study, *words):
    """The report of a study."""
    with tempfile.TemporaryDirectory() as folder:
        call(FARCULL, 'experiment', study, '--out', folder, *words)
        call(FARCULL, 'report', folder)
        return read(f'{folder}/report/results.md')


def headline():
    made = written('headline')
    return columns_differ('headline', made) + counts_differ('headline', made, '.*missed', 1)


def stages():
    with tempfile.TemporaryDirectory() as folder:
        call('/usr/bin/python3', 'experiments/report/stages.py', FARCULL, f'{folder}/page.md', f'{folder}/stages.svg', 'two-bunnies',
             'torii')
        made = read(f'{folder}/page.md')
    return columns_differ('stages', made) + counts_differ('stages', made, 'triangles|boxes leave|view 1|2|pairs tested', 2)


def libraries():
    with tempfile.TemporaryDirectory() as folder:
        call('bash', 'experiments/libraries.sh', '--quick', folder)
        return columns_differ('libraries', read(f'{folder}/report/results.md'))


def bench():
    out = []
    for scene, of in ('two-bunnies', '{:,}'), ('spheres', '{:,} in 458 spheres'), ('cad-cut', '{:,}'):
        one = record('run', scene, '--method', 'exact')
        out += lacks_row('bench', f'`{scene}`', of.format(one['scene']['triangles']), one['candidate_pairs'], one['colliding_pairs'])
    names = [row['name'] for row in record('bench', 'two-bunnies', '--threads', '1', '--repeat', '1', '--device', 'cpu', '--methods',
                                           'boxes,exact', '--peers', 'embree-low,cgal-boxes,fcl-obb')['rows']]
    return out + [f'bench has no row {name}' for name in ('boxes', 'exact', 'embree-low', 'cgal-boxes') if name not in names]


def bench_distances():
    rows = {row['name']: row for row in record('bench', 'cylinders', '--distances', 'objects', '--threads', '1', '--repeat', '1')['rows']}
    of = next(row for _, rows_ in tables(page_text('bench-distances')) for row in rows_ if row[0].startswith('`cylinders`'))
    peer = rows[of[4]]
    answers, off = peer['answers'], peer['answers'] - peer['exact']
    return [] if [of[1], of[5]] == [f'{answers:,}', f'{off:,}'] else [f'cylinders: {answers:,} answers, {off:,} off, the page has {of}']


def cloth_solver():
    words = 'verify', 'cloth:800:1e2', '--method', 'far', '--frames', '500'
    rows = [record(*words), record(*words, '--radius', '0', missing=True)]
    counts = [sum(frame['all_colliding_pairs'] for frame in rows[0]['frames']), *(row['summary']['missed'] for row in rows)]
    of = next(row for head, rows_ in tables(page_text('cloth-solver')) for row in rows_ if row[0] == '1e2' and 'at risk' in head)
    return [] if of[-3:] == [f'{count:,}' for count in counts] else [f'1e2: {counts}, the page has {of[-3:]}']


def distances():
    made = call('bash', 'experiments/reliability.sh', 'distances', 'two-tori')
    answers = sum(int(row[3].replace(',', '')) for head, rows in tables(made) for row in rows if row[2] == 'objects')
    unequal = sum(int(row[4].replace(',', '')) for head, rows in tables(made) for row in rows)
    return lacks_row('distances', 'two-tori', 'objects', answers) + ([f'{unequal} unequal'] if unequal else [])


def tiles():
    with tempfile.TemporaryDirectory() as folder:
        fullest = candidates = 0
        for k in 1, 2, 3, 4:
            one = record('run', 'field:1000000', '--tiles', f'{k}/4', '--no-verify', '--pairs', f'{folder}/t{k}.csv')
            with open(f'{folder}/t{k}.json', 'w', encoding='utf-8') as file:
                json.dump(one, file)
            fullest, candidates = max(fullest, one['tile']['triangles']), max(candidates, one['candidate_pairs'])
        call(FARCULL, 'merge', *(f'{folder}/t{k}.json' for k in (1, 2, 3, 4)), '-o', f'{folder}/pairs.csv')
        pairs = read(f'{folder}/pairs.csv').count('\n') - 1
    return lacks_row('tiles', '1,000,000', fullest, candidates, pairs)


def drivers():
    made = call('bash', 'experiments/drivers.sh', 'llvmpipe', '--probes', '--program', FARCULL)
    return [] if tables(made) and re.search(r'llvmpipe', made) else ['no table of llvmpipe']


def misses():
    """The command writes the page and its data, which have to stay as they are."""
    paths = [f'{ROOT}/docs/results/misses.{kind}' for kind in ('md', 'csv')]
    texts = [[read(path) for path in paths]]
    try:
        call(sys.executable, 'experiments/misses.py', FARCULL)
        texts.append([read(path) for path in paths])
    finally:
        for path, text in zip(paths, texts[0]):
            with open(path, 'w', encoding='utf-8') as file:
                file.write(text)
    return [] if texts[0] == texts[1] else ['its table or its data']


PAGES = {'headline': (headline, METHODS), 'stages': (stages, [*METHODS, 'experiments/report/stages.py']),
         'studies': (lambda: columns_differ('studies', written('all', '--quick')), [*METHODS, 'experiments/studies', 'experiments/report']),
         'proximity': (lambda: columns_differ('proximity', written('proximity', '--quick')), ['core', 'verify', 'experiments/studies']),
         'libraries': (libraries, ['core', 'verify', 'experiments/suite', 'experiments/peers']),
         'bench': (bench, ['core/boxes', 'verify', 'experiments/peers']),
         'bench-distances': (bench_distances, ['core/proximity', 'core/boxes', 'verify', 'experiments/peers']),
         'cloth-solver': (cloth_solver, [*METHODS, 'experiments/scenes/cloth']),
         'distances': (distances, ['core/proximity', 'core/boxes', 'verify']), 'tiles': (tiles, ['core/boxes', 'experiments/tiles']),
         'misses': (misses, METHODS),
         'drivers': (drivers, ['core/gl', 'core/view', 'experiments/method'])}


def changes(page, paths):
    """How many commits have changed what the page measures since the newest commit that it names; None: none is known here."""
    newest = []
    for commit in set(re.findall(r'\b[0-9a-f]{7,12}\b', page_text(page)[:4000] + page_text(page)[-4000:])):
        counted = subprocess.run(['git', 'rev-list', '--count', f'{commit}..HEAD', '--', *paths], cwd=ROOT, capture_output=True, text=True)
        if counted.returncode == 0:
            newest.append(int(counted.stdout))
    return min(newest, default=None)


def main():
    failed = False
    for page in sys.argv[1:] or PAGES:
        test, paths = PAGES[page]
        try:
            differs = test()
        except (RuntimeError, OSError, KeyError, StopIteration, ValueError) as error:
            differs = [f'{type(error).__name__}: {error}']
        since = changes(page, paths)
        print(f'{page}: {"DIFFERS" if differs else "as on the page"}; '
              f'{"no known commit" if since is None else f"its code has changed {since} times since"}', flush=True)
        for line in differs:
            print(f'  {line}', flush=True)
        failed |= bool(differs)
    sys.exit(failed)


main()
