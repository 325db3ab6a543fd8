"""See docs_test.sh."""
import glob
import json
import os
import re
import shutil
import sys
import tempfile

PARTS = ['docs/reliability.md', 'docs/budget.md']
KIND = '(?:[Ll]emma|[Tt]heorem|[Cc]orollar|[Dd]efinition)'


def read(path):
    with open(path, encoding='utf-8', errors='replace') as file:
        return file.read()


def paper(pattern):
    """The matches in the paper, with file and line."""
    for part in PARTS:
        for number, line in enumerate(read(part).split('\n'), 1):
            yield from ((f'{part}:{number}', found) for found in re.findall(pattern, line))


def labels():
    """The numbered statements of the paper, in its order: "lemma 3"."""
    return [f'{kind.lower()} {number}' for _, (kind, number) in
            paper(r'^\*\*(Definition|Lemma|Theorem|Corollary) ([0-9]+) \(')]


def referring():
    """Files that may refer to the paper, each as one line without comment marks, so that a reference may go on in the next."""
    paths = ['README.md'] + [os.path.join(folder, name) for top in ('core', 'offsets', 'verify', 'tests', 'experiments', 'docs')
                             for folder, _, names in os.walk(top) for name in names]
    for path in sorted(paths):
        if path.endswith(('.h', '.cpp', '.inl', '.glsl', '.md', '.sh', '.py', '.txt', '.obj')) and \
                not path.startswith(('tests/fuzz/', 'tests/docs_test')):
            yield path, ' '.join(re.sub(r'^[ \t]*(///?|#)?[ \t]*', '', line) for line in read(path).split('\n'))


def check_labels():
    """Labels are numbered 1, 2, 3, ... for each kind, over both parts."""
    last = {}
    for kind, number in (label.split() for label in labels()):
        last[kind] = last.get(kind, 0) + 1
        if last[kind] != int(number):
            yield f'the paper: {kind} {number} stands where {kind} {last[kind]} should'
    if not {'lemma', 'theorem'} <= set(last):
        yield 'the paper: it has no lemmas, or the test reads it wrongly'


def check_references(texts):
    """Every "lemma 3", "lemmas 1 and 2", "theorems 5 to 8" names labels of the paper."""
    known = set(labels())
    pattern = re.compile(rf'(?<![A-Za-z0-9_])({KIND})(?:y|ies|s)? ([0-9]+(?:(?: to |, | and )[0-9]+)*)(?![0-9a-z]|[.][0-9])')
    for path, text in texts:
        for found in pattern.finditer(text):
            kind = found[1].lower().replace('corollar', 'corollary')
            if not re.search('Higham, ?$', text[:found.start()]):
                yield from (f'{path}: names {kind} {number}, which the paper does not have'
                            for number in re.findall('[0-9]+', found[2]) if f'{kind} {number}' not in known)


def check_sections(texts):
    """Sections named in quotes after the page, as in budget.md, "double", are headings of that page."""
    headings = {}
    for page in glob.glob('docs/*.md') + glob.glob('docs/results/*.md'):  # of which two may have the same name
        headings.setdefault(os.path.basename(page), set()).update(re.findall('^#+ +(.*)', read(page), re.MULTILINE))
    for path, text in texts:
        for page, quoted in re.findall(r'([a-z_]+[.]md)[)]?, ("[^"]+"(?:,? and "[^"]+")?)', text):
            yield from (f'{path}: names the section "{name}", which {page} does not have' for name in quoted.split('"')[1::2]
                        if page in headings and name not in headings[page])


def check_tests():
    """Every `Suite.Name` of the paper is a test; * stands for any text."""
    tests = {f'{suite}.{name}' for path in glob.glob('tests/**/*.cpp', recursive=True) for suite, name in
             re.findall(r'(?:TEST|TEST_F|TEST_P|RC_GTEST_PROP)\((\w+),\s*(\w+)', read(path))}
    for place, name in paper(r'`([A-Z][A-Za-z0-9]+\.[A-Z*][A-Za-z0-9*]*)`'):
        pattern = name.replace('.', '[.]').replace('*', r'\w*')
        if name not in tests and not ('*' in name and any(re.fullmatch(pattern, test) for test in tests)):
            yield f'{place}:{name}: no such test'


def check_citations():
    """Citations are keys of docs/references.bib."""
    keys = re.findall(r'^@[a-z]+\{([a-z0-9]+),', read('docs/references.bib'), re.MULTILINE)
    yield from (f'docs/references.bib: two entries {key}' for key in sorted(set(keys)) if keys.count(key) > 1)
    for place, cited in paper(r'\[@[^]]*\]'):
        yield from (f'{place}:{cited}: docs/references.bib has no {key}' for key in re.findall('@([a-z0-9]+)', cited)
                    if key not in keys)


def check_symbols():
    """Each symbol stands once in the table of notation."""
    table = re.search('^## Notation.*?(?=^## |\\Z)', read(PARTS[0]), re.MULTILINE | re.DOTALL)
    rows = [row for row in re.findall(r'^\|(.*?)\|', table[0] if table else '', re.MULTILINE)
            if row.strip() != 'symbol' and row.strip('- :')]
    symbols = [symbol for row in rows for symbol in row.strip().split(', ')]
    yield from (f'docs/reliability.md: the symbol {symbol} is defined twice' for symbol in sorted(set(symbols))
                if symbols.count(symbol) > 1)
    if len(rows) < 20:
        yield f'docs/reliability.md: the table of notation has {len(rows)} rows, or the test reads it wrongly'


def check_proofs():
    """Each lemma, theorem and corollary says what it assumes, has tests and twins, and a proof that ends."""
    for part in PARTS:
        for statement in re.split(r'^(?=\*\*(?:Lemma|Theorem|Corollary) [0-9]+ |##)', read(part), flags=re.MULTILINE):
            if label := re.match(r'\*\*(\w+ [0-9]+) ', statement):
                yield from (f'{part}: {label[1]} {why}' for pattern, why in (
                    ('[*]Assumes[:* ]', 'does not say what it assumes'), ('[*]Tests[:* ]', 'names no tests'),
                    ('[*][Tt]wins[:*]', 'names no twins'), ('[*]Proof[.][*]', 'has no proof')) if not re.search(pattern, statement))
                if statement.count('∎') != 1:
                    yield f'{part}: the proof of {label[1]} does not end once'


def check_map():
    """Every page is linked from the map of pages, docs/README.md, or from that of results."""
    maps = [read('docs/README.md'), read('docs/results/README.md')]
    for page in sorted(glob.glob('docs/*.md') + glob.glob('docs/results/*.md')):
        if page != 'docs/README.md' and f"]({page.removeprefix('docs/')})" not in maps[0] and \
                f"]({page.removeprefix('docs/results/')})" not in maps[1]:
            yield f'{page}: docs/README.md and docs/results/README.md do not link to it'


KIT = {'docs/CITATION.cff': 'cff-version message title authors version date-released license',
       'docs/codemeta.json': '@context @type name description version datePublished license author',
       'docs/.zenodo.json': 'title upload_type description version publication_date license creators'}


def metadata():
    """The files that tools read about a release, as dictionaries. Of the CFF, which is YAML, the lines at the top level are
    enough, and the names of its authors."""
    for path in KIT:
        text = read(path)
        if path.endswith('.json'):
            yield path, json.loads(text)
            continue
        lines = re.match(r'(?:[a-z-]+:.*\n|(?:  +|- ).*\n)+\Z', text)
        fields = dict(re.findall(r'^([a-z-]+): *"?(.*?)"?(?: *#.*)?$', text if lines else '', re.MULTILINE))
        authors = re.search(r'^authors:.*\n((?:  .*\n)+)', text, re.MULTILINE)
        yield path, fields | {'authors': re.findall('name: (.*)', authors[1]) if authors else []}


def check_kit():
    """The files of a release are valid, have what their readers require, agree, and name no file that is not there."""
    try:
        files = dict(metadata())
    except ValueError as error:
        yield f'docs: a file of the release is no JSON: {error}'
        return
    for path, keys in KIT.items():
        yield from (f'{path}: has no {key}' for key in keys.split() if not files[path].get(key))
    cff, meta, zenodo = files.values()
    for what, *values in (('version', *(of.get('version') for of in files.values())),
                          ('date', cff.get('date-released'), meta.get('datePublished'), zenodo.get('publication_date')),
                          ('licence', cff.get('license'), str(meta.get('license')).split('/')[-1], zenodo.get('license')),
                          ('authors', *([name for name in cff['authors']], [of.get('name') for of in meta.get('author', [])],
                                        [of.get('name') for of in zenodo.get('creators', [])]))):
        if any(value != values[0] for value in values):
            yield f'docs/CITATION.cff, codemeta.json and .zenodo.json: they differ in the {what}'
    for key in ('softwareRequirements', 'buildInstructions', 'readme', 'softwareHelp'):
        if not os.path.exists(str(meta.get(key))):
            yield f'docs/codemeta.json: {key} names {meta.get(key)}, which is not there'
    recipe = read('docs/Containerfile')
    yield from (f'docs/Containerfile: {path} is not there' for path in re.findall(r'(?:experiments|docs)/[\w./-]+', recipe)
                if not os.path.exists(path))
    setup = read('experiments/setup.sh')
    yield from (f'docs/Containerfile: setup.sh has no {name}' for name in re.findall(r'\bfarcull_\w+', recipe)
                if f'\n{name}() {{' not in setup)
    yield from (f'docs/Containerfile: has no {word}' for word in ('FROM', 'RUN', 'ENTRYPOINT')
                if not re.search(f'^{word} ', recipe, re.MULTILINE))


def check_claims():
    """Each claim has all its cells, its figures and tables are those of a chapter, and no other page has a table of claims."""
    chapters = ''.join(map(read, glob.glob('experiments/report/chapters/*.py')))
    for line in re.findall(r'^\| (?!claim ).*', read('docs/claims.md').split('\n## ')[0], re.MULTILINE):
        cells = [cell.strip() for cell in line.strip('|').split('|')]
        if len(cells) != 6 or not all(cells) or not cells[2].isdigit():
            yield f'docs/claims.md: a claim lacks a cell: {cells[0]}'
        yield from (f'docs/claims.md: no chapter has {name}' for name in re.findall(r'[a-z-]+', re.sub(r'\(?\[.*?\)+', '', cells[4]))
                    if name not in 'figures tables and its output' and f'"{name}"' not in chapters)
    yield from (f'{page}: has claims of its own' for page in glob.glob('docs/**/*.md', recursive=True)
                if page != 'docs/claims.md' and '| claim |' in read(page))


def check_first_screens():
    """Licence and contribution stand at the top of the README; the page on contributing is one screen."""
    top = ' '.join(read('README.md').split('\n')[:12])
    yield from (f'README.md: does not name {word} in its first lines' for word in (
        'LGPL-3.0-or-later', '(docs/LICENSE)', '(docs/CONTRIBUTING.md)') if word not in top)
    if (lines := read('docs/CONTRIBUTING.md').count('\n')) > 45:
        yield f'docs/CONTRIBUTING.md: has {lines} lines, more than a screen'


def check_headline():
    """README and the paper have the table of docs/results/headline.md."""
    table = re.search(r'^\| method.*\n(\|.*\n)+', read('docs/results/headline.md'), re.MULTILINE)[0]
    yield from (f'{page}: its table is not that of docs/results/headline.md (bash experiments/results.sh headline)'
                for page in ('README.md', 'docs/paper.md') if table not in read(page))


def check():
    texts = list(referring())
    said = [*check_labels(), *check_references(texts), *check_sections(texts), *check_tests(), *check_citations(),
            *check_symbols(), *check_proofs(), *check_map(), *check_kit(), *check_claims(), *check_first_screens(),
            *check_headline()]
    return '\n'.join(said) or f'docs: {len(labels())} numbered statements, and what refers to them', bool(said)


# ---- self-test: case, file, text and what replaces it (regular expressions), and what is said then

ONE, TWO = PARTS
BROKEN = [
    ('a number left out', TWO, r'^\*\*Lemma 17 ', '**Lemma 77 ', 'lemma 77 stands where'),
    ('a number used twice', ONE, r'^\*\*Theorem 3 ', '**Theorem 2 ', 'theorem 2 stands where'),
    ('a lemma that is none, in a page', 'docs/extending.md', 'lemmas 1 and 2', 'lemmas 91 and 2', 'extending.md: names lemma 91'),
    ('a theorem that is none, in a source', 'core/cull/cull.h', 'theorem 2', 'theorem 92', 'cull.h: names theorem 92'),
    ('a section that is gone', TWO, '^###+ One normal', '#### One value', 'names the section "One normal"'),
    ('a section in the next line', ONE, '^## Quick-CULLIDE', '## Quick', 'quick_test.cpp: names the section "Quick-CULLIDE"'),
    ('a test that is none', ONE, '`Cull.ALostStoreMisses`', '`Cull.ALostStore`', 'Cull.ALostStore: no such test'),
    ('a pattern without a test', ONE, r'`Oriented.\*`', '`Straight.*`', r'Straight.\*: no such test'),
    ('a citation without an entry', TWO, '@higham2002', '@higham1996', 'has no higham1996'),
    ('a symbol with two meanings', ONE, r'^\| K \| a clearance', '| M | a clearance', 'symbol M is defined twice'),
    ('a proof without an end', TWO, ' ∎$', '', 'does not end once'),
    ('a lemma without a twin', ONE, r'\*Twins:\* `CullQuick', '`CullQuick', 'names no twins'),
    ('a page that no map names', 'docs/README.md', r'\(tiles\.md\)', '(proofs.md)', 'docs/tiles.md: docs/README.md'),
    ('a result that no map names', 'docs/results/README.md', r'\(clusters\.md\)', '(tiles.md)', 'clusters.md: docs/README.md'),
    ('a citation without authors', 'docs/CITATION.cff', '^  - name: .*\n(?=version)', '', 'CITATION.cff: has no authors'),
    ('no JSON', 'docs/codemeta.json', '"0.1",', '"0.1"', 'is no JSON'),
    ('no creators', 'docs/.zenodo.json', '"creators"', '"makers"', 'zenodo.json: has no creators'),
    ('another version', 'docs/.zenodo.json', '"0.1"', '"0.2"', 'differ in the version'),
    ('a page that is gone, in codemeta', 'docs/codemeta.json', 'docs/building.md', 'docs/build.md', 'buildInstructions names'),
    ('a script that is gone, in the recipe', 'docs/Containerfile', 'experiments/meshes.sh', 'experiments/mesh.sh',
     'mesh.sh is not there'),
    ('a function that is gone, in the recipe', 'docs/Containerfile', 'farcull_setup', 'farcull_packages', 'setup.sh has no farcull_p'),
    ('another count in the table of README', 'README.md', r'\| 3,219 \|', '| 3,218 |', 'README.md: its table is not that'),
    ('a claim without minutes', 'docs/claims.md', r'\| 110 \|', '| hours |', 'lacks a cell: The tests notice faults'),
    ('a figure that no chapter draws', 'docs/claims.md', 'figure error-time,', 'figure errors,', 'no chapter has errors'),
    ('a second table of claims', 'docs/results/README.md', r'^\| page \|', '| claim |', 'has claims of its own'),
    ('a licence that nobody finds', 'README.md', 'LGPL-3.0-or-later', 'a licence', 'does not name LGPL'),
    ('a lemma without assumptions', TWO, r'\*Assumes:\* lemmas 13 and 14\.', '', 'does not say what it assumes')]


def self_test(source):
    for name in 'docs', 'core', 'offsets', 'verify', 'tests', 'experiments':
        shutil.copytree(f'{source}/{name}', name)
    shutil.copy(f'{source}/README.md', '.')
    failed = [check()[0]] if check()[1] else []
    for name, path, text, instead, wanted in BROKEN:
        kept = read(path)
        with open(path, 'w', encoding='utf-8') as file:
            file.write(re.sub(text, instead.replace('\\', r'\\'), kept, flags=re.MULTILINE))
        said, status = check()
        if kept == read(path) or not status or not re.search(wanted, said):
            failed.append(f"self-test: {name}: {'the file was not changed' if kept == read(path) else said}")
        with open(path, 'w', encoding='utf-8') as file:
            file.write(kept)
    return '\n'.join(failed) or 'docs: every rule is caught when it is broken', bool(failed)


repository = os.path.dirname(os.path.realpath(__file__)) + '/..'
argument = sys.argv[1] if sys.argv[1:] else repository
with tempfile.TemporaryDirectory() as tree:
    os.chdir(tree if argument == '--self-test' else argument)
    message, result = self_test(repository) if argument == '--self-test' else check()
    os.chdir('/')
print(message)
sys.exit(result)
