"""See layout_test.sh. The rules are the tables at the top; the self-test is a table of changes that break them."""
import itertools
import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

# Folder, and the folders that it includes. A folder may include itself, what its row names, and whatever those may include;
# a * stands for every folder. A file belongs to the longest folder of the table that its path begins with.
MAY_INCLUDE = {row.split(':')[0].strip(): row.split(':')[1].split() for row in '''
core/base:;  core/scene: core/base;  core/boxes: core/scene;  core/view: core/boxes;  core/canvas: core/view;
core/cull: core/canvas;  core/sweep: core/boxes;  core/proximity: core/boxes;
core/voronoi: core/scene;  core/native: core/canvas;  core/gl: core/cull core/sweep core/proximity;
offsets: core/native;  verify/certificate: core/scene;  verify: core/canvas verify/certificate;  experiments/system: core/base;
experiments/scenes/mesh: experiments/system core/gl;  experiments/scenes/cloth: experiments/scenes/mesh;
experiments/scenes/builtin: experiments/scenes/mesh experiments/scenes/cloth;  experiments/scenes: experiments/scenes/builtin;
experiments/method: core/gl core/proximity offsets verify;  experiments/library: experiments/record;
experiments/record: experiments/method experiments/system;  experiments/tiles: experiments/scenes experiments/record;
experiments/generators: experiments/scenes;  experiments/suite: experiments/generators verify;
experiments/peers: experiments/suite experiments/library;  experiments/measure: experiments/record experiments/peers core/voronoi;
experiments/lemma: experiments/generators experiments/record;  experiments/studies: experiments/measure experiments/lemma;
experiments/picture: experiments/measure;
experiments/command: experiments/studies experiments/picture experiments/library experiments/tiles;
experiments/python: experiments/library experiments/picture;  tests: *'''.split(';')}
# The verification shares no code with the culling that it checks: neither the boxes, with their joins and trees, nor the plan
# nor the error budget, although the table lets it. One file is no check, but the method `exact`.
UNSHARED = ['core/boxes', 'core/view/budget', 'core/view/plan', 'core/view/regions']
NO_CHECK = 'verify/all_pairs.cpp'
# Library, a regular expression for its headers, and who may include them: folders of the table, or with a * all files whose
# path begins so.
LIBRARIES = [('EGL/OpenGL', r'^(epoxy|EGL|GL|GLES[0-9]*|KHR)/', 'core/gl tests/faults/*'),
             ('CGAL', '^CGAL/', 'verify experiments/peers/cgal* experiments/peers/contest_cgal* tests'),
             ('GMP/MPFR', r'^(gmp|gmpxx|mpfr)\.h$', 'verify verify/certificate tests'),
             ('zlib', r'^zlib\.h$', 'experiments/scenes/mesh experiments/picture/sheet* tests')]
# Who may include headers under the GPL (docs/LICENSE): with CGAL, the SPDX line of the installed header says whether it is one.
GPL_USERS = ('experiments/peers/', 'tests/')
INSTALLED = Path('/usr/include')
MOST_FOLDERS = 20  # in experiments/
OURS = ['core', 'offsets', 'verify', 'experiments', 'tests']
OUR = re.compile(f"({'|'.join(OURS)})/")
STEM = re.compile(r'\.(h|cpp)$')
TOP = ['CMakeLists.txt', 'README.md', 'docs', *OURS]
SOURCES = ['.h', '.cpp', '.glsl', '.vert', '.frag', '.comp']  # shaders too, since C++ includes some of them
COMMANDS = 'bench|check|clash|compare|distance|doctor|help|lemma|picture|plan|report|run|savings|scenes|studies|suite|verify'
# Where text must not be in .h and .cpp: folders, exception, pattern, message.
LINES = [
    (OURS[:4], 'core/base/parallel.cpp', r'std::(jthread|async|thread)([^:_\w]|$)|pthread_create',
     'starts a thread: only core/base/parallel.cpp does, which sets the arithmetic of each'),
    (OURS[:3], '', rf'"[^"]*(--[a-z]|\bfarcull ({COMMANDS})\b)',
     'names an option or a command of the command line: write {name} (core/base/error.h)'),
    (OURS[:3], '', r'\bprogress_?\([^)]*"|case (StageKind|Reason)::|std::string(_view)? \w+\((const )?(Stage|StageKind|Reason)\b',
     'has words of a stage: only experiments/record/stage_words.cpp does')]


def reached(start, edges):
    """The start, and what the edges lead to from there."""
    found = new = {start}
    while new := {to for at in new for to in edges.get(at, ())} - found:
        found = found | new
    return found


ALLOWED = {folder: set(MAY_INCLUDE) if '*' in row else reached(folder, MAY_INCLUDE) for folder, row in MAY_INCLUDE.items()}


def files_of(folders, endings):
    return sorted(str(path) for folder in folders for path in Path(folder).rglob('*') if path.suffix in endings)


def lines_of(path):
    return enumerate(Path(path).read_text('utf-8', 'replace').split('\n'), 1)


def folder_of(path):
    return next((str(folder) for folder in Path(path).parents if str(folder) in MAY_INCLUDE), '')


def includes(files):
    """File, line, included file. An include relative to its own folder is the file that it means, however spelled."""
    known = set(files)
    for file in files:
        for number, line in lines_of(file):
            if found := re.match(r'\s*#\s*include\s*[<"]([^>"]*)', line):
                beside = os.path.normpath(os.path.join(os.path.dirname(file), found[1]))
                yield file, number, beside if beside in known else found[1]


def is_under_gpl(header):
    return (INSTALLED / header).is_file() and any('SPDX-License-Identifier: GPL' in line for _, line in lines_of(INSTALLED / header))


def why_not(file, included):
    """Why the file must not include the other."""
    here, there = folder_of(file), folder_of(included)
    for name, _, users in (row for row in LIBRARIES if re.search(row[1], included)):
        may = any(file.startswith(user[:-1]) if user[-1] == '*' else user == here for user in users.split())
        return (f'only {users} may use {name}' if not may
                else 'it is under the GPL, and the library is under the LGPL'
                if not file.startswith(GPL_USERS) and is_under_gpl(included) else '')
    return ('' if not here or not OUR.match(included)
            else 'it lies in no folder of the table' if not there
            else 'the verification shares no code with the culling that it checks'
            if here.startswith('verify') and file != NO_CHECK and {STEM.sub('', included), there} & set(UNSHARED)
            else '' if there in ALLOWED[here] else f'the table does not let {here} include {there}')


def cycles(found):
    """Files that include each other, where .h and .cpp of one name are one file."""
    below = {}
    for file, _, included in found:
        if OUR.match(included) and STEM.sub('', file) != STEM.sub('', included):
            below.setdefault(STEM.sub('', file), set()).add(STEM.sub('', included))
    reach = {file: reached(file, below) for file in below}
    groups = {tuple(sorted(other for other in reach[file] if file in reach.get(other, ()))) for file in below}
    for group in sorted(group for group in groups if len(group) > 1):
        yield f"{group[0]}: a cycle of includes, with .h and .cpp of one name as one file: {', '.join(group)}"


# Strings, characters, comments and directives.
BLANKED = re.compile('|'.join([
    r'R"([^ ()\\"]*)\(.*?\)\1"', r'"(?:[^"\\\n]|\\.)*"', r"(?<![0-9A-Za-z])'(?:[^'\\\n]|\\.)+'", r'//[^\n]*', r'/\*.*?\*/',
    r'^[ \t]*#(?:\\\n|[^\n])*']), re.DOTALL | re.MULTILINE)
TYPE = re.compile(r'(?:^| )(?:enum class|enum struct|struct|class|union|enum) (\w+)(?: final)?(?: :[^:].*)?$')


def types():
    """Types that two files define in one namespace: to a linker they are one, and which functions a program gets is chance
    (tests/odr.sh asks the linker). A name that one file defines twice stands in the branches of an #if."""
    place = {}
    for file in files_of(OURS, ['.h', '.cpp', '.inl']):
        text = BLANKED.sub(lambda found: ('""' if '"' in found[0][:2] else ' ') + '\n' * found[0].count('\n'),
                           Path(file).read_text('utf-8', 'replace'))
        scopes, blocks = [], 0
        for piece in re.finditer('([^{};]*)([{};])', text):
            words = ' '.join(re.sub(r'\[\[[^\]]*\]\]|alignas *\([^)]*\)', ' ', piece[1]).split())
            if blocks:
                blocks += {'{': 1, '}': -1, ';': 0}[piece[2]]
            elif piece[2] != '{':
                del scopes[len(scopes) - (piece[2] == '}'):]
            elif named := re.fullmatch(r'(?:inline )?namespace ?([\w:]*)|extern ""', words):
                scopes.append('' if named[1] is None else named[1] + '::' if named[1] else '<anonymous>')
            else:
                blocks = 1
                found = TYPE.search(words)
                if found and '<anonymous>' not in scopes and (words.startswith('template') or not re.search('[(=]', words)):
                    line = f'{file}:{text.count(chr(10), 0, piece.start(2)) + 1}'
                    first = place.setdefault(''.join(scopes) + found[1], line)
                    if first.split(':')[0] != file:
                        yield f"{line}: defines {''.join(scopes)}{found[1]}, and so does {first}: a type name once a namespace"


def page_paths():
    """Paths in backticks and in indented blocks that begin with one of our folders, and targets of links, that do not exist.
    NAME and * stand for any text, a path without an ending for files with any. A page may tell the reader to make a file, "the
    new file `PATH`", and name it there and below."""
    there = {str(path) for top in [*OURS, 'docs'] for path in Path(top).rglob('*')} | {'README.md', 'CMakeLists.txt', *OURS, 'docs'}
    there |= {re.sub(r'[.][^./]*$', '', path) for path in there}
    for page in (page for page in [*Path().glob('README.md'), *files_of(['docs'], ['.md'])] if str(page).count('/') < 3):
        made, inside = set(), False  # a span in backticks may go on in the next line, but not further

        def known(path):
            pattern = re.sub(r'NAME|\\\*', '[^/]*', re.escape(path))
            return path in there or path in made or pattern != re.escape(path) and any(re.fullmatch(pattern, one) for one in there)

        for number, line in lines_of(page):
            made |= set(re.findall('new file `([^`]*)`', line))
            inside = inside and line != ''
            spans = line.split('`')
            block = line.startswith('    ') and not inside
            words = [word.rstrip('.').rstrip('/') for text in ([line] if block else spans[1 - inside::2])
                     for word in re.split(r'[^\w./*@%-]+', text)]
            yield from (f'{page}:{number}: names {path}, which does not exist' for path in words
                        if re.match(OUR.pattern + '|docs/', path) and not known(path))
            targets = [] if block else [target.split('#')[0] for target in re.findall(r'\]\(([^)]*)\)', line)]
            yield from (f'{page}:{number}: links to {target}, which does not exist' for target in targets
                        if target and not re.match('[a-z]+:', target)
                        and not known(os.path.normpath(os.path.join(os.path.dirname(page), target))))
            inside ^= not block and len(spans) % 2 == 0


def top_level():
    """The names at the top, without dot files: those that git has or would add, or all but build folders without git."""
    names = {name for name in os.listdir() if not name.startswith(('build', '.'))}
    if os.path.exists('.git'):
        listed = subprocess.run(['git', 'ls-files', '--cached', '--others', '--exclude-standard'], capture_output=True,
                                check=False, text=True)
        if listed.returncode == 0:  # Git still lists a file whose removal is not committed yet
            names = {path.split('/')[0] for path in listed.stdout.split('\n') if path[:1] != '.'} & {*os.listdir()}
    yield from (f'{name}: missing at the top level' for name in TOP if name not in names)
    yield from (f"{name}: the top level holds nothing but {' '.join(TOP)}" for name in sorted(names - set(TOP)))


def check():
    files = files_of(OURS, SOURCES)
    found = list(includes(files))
    said = [f'{file}:{line}: includes {included}: {why}'
            for file, line, included in found if (why := why_not(file, included))]
    said += [f'{file}: lies directly in {os.path.dirname(file)}, which is no folder of the table'
             for file in files if not folder_of(file)]
    count = len({os.path.dirname(file) for file in files if re.match('experiments/.*/', file)})
    if count > MOST_FOLDERS:
        said.append(f'experiments: {count} folders hold source files; at most {MOST_FOLDERS} may')
    said += [*cycles(found), *types(), *page_paths(), *top_level()]
    for folders, exception, pattern, message in LINES:
        said += [f'{file}:{number}: {message}' for file in files_of(folders, ['.h', '.cpp']) if file != exception
                 for number, line in lines_of(file) if re.search(pattern, line)]
    if not found:
        said.append('no #include found: this is not the repository, or the test reads it wrongly')
    return '\n'.join(said) or f'layout: {len(found)} includes obey the table', len(said)


def graph():
    """The folders by level, and the arrows between them."""
    files = files_of(OURS, SOURCES)
    folders = [folder for folder in MAY_INCLUDE if folder != 'tests' and folder in map(folder_of, files)]
    arrows = {folder: set() for folder in MAY_INCLUDE}
    for here, there in ((folder_of(file), folder_of(included)) for file, _, included in includes(files)):
        if here and there and here != there:
            arrows[here].add(there)
    good = {folder: arrows[folder] & ALLOWED[folder] for folder in folders}

    def level(folder):
        return 1 + max(map(level, good.get(folder, ())), default=-1)

    drawn = {folder: [to for to in MAY_INCLUDE if to in good[folder] and
                      not any(to in reached(via, good) for via in good[folder] - {to})] for folder in folders}
    against = {folder: [to for to in MAY_INCLUDE if to in arrows[folder] - good[folder]] for folder in folders}
    upward = sum(level(to) >= level(folder) for folder in folders for to in against[folder])
    levels = range(max(map(level, folders)), -1, -1)
    texts = {folder: drawn[folder] + [f'{to} (against the table)' for to in against[folder]] for folder in folders}
    count = len({os.path.dirname(file) for file in files if file.startswith('experiments/')})
    return '\n'.join([
        'Folders by level. A folder includes only folders of lower levels.',
        *(f"{at:5}  {', '.join(folder for folder in folders if level(folder) == at)}" for at in levels),
        '\nArrows: a folder, and those that it includes directly. Left out are the arrows to folders',
        'that it also reaches through another folder.',
        *(f"  {folder:27} -> {', '.join(texts[folder])}" for folder in folders if texts[folder]),
        f'\n{len(folders)} folders ({count} in experiments, at most {MOST_FOLDERS}), {len(levels)} levels, '
        f'{sum(len(arrows[folder]) for folder in folders)} arrows ({sum(map(len, drawn.values()))} drawn), '
        f'{sum(map(len, against.values()))} against the table, {upward} upward'])


# ---- self-test: each change of a small tree that obeys every rule, and the violation that it gives (none: '')

TREE = {'CMakeLists.txt': 'top', 'README.md': 'top', 'docs/index.md': 'page', 'build/junk': 'junk', '.gitignore': '/build*/',
        **{f'core/{name}.h': '#include <vector>' for name in 'base/error scene/scene view/view view/budget canvas/canvas cull/cull '
           'gl/canvas'.split()}, 'offsets/obb.glsl': '#include "core/base/shim.h"', 'offsets/obb.h': '#include <vector>',
        'verify/exact.h': '#include <CGAL/Kernel.h>', 'experiments/method/run.cpp': '#include "offsets/obb.h"',
        'tests/all_test.cpp': '#include "verify/exact.h"'}
# Folders or files, what they include, and the reason why not; = stands for: the table does not let them; . for none.
INCLUDING = [row.split(':') for row in r'''
core/base:core/scene tests:= | core/boxes:core/view:= | core/view:core/canvas verify tests ../canvas/canvas.h:=
core/cull:offsets core/sweep experiments/command:= | core/gl/canvas/cull.frag:offsets/obb.glsl:= | offsets:core/gl verify:=
verify:offsets core/gl tests ../offsets/obb.glsl:= | verify/canvas.h verify/deep/canvas.h:<offsets/obb.h> offsets/obb.h:=
experiments/scenes/mesh:experiments/scenes:= | experiments/method:experiments/record:= | experiments/command:tests:=
verify:core/boxes/join.h core/view/budget.h:shares no code | verify/all_pairs.cpp:core/boxes/join.h:.
verify/certificate:core/boxes/join.h:shares no code
verify:<CGAL/box_intersection_d.h> <CGAL/AABB_tree.h>:it is under the GPL
experiments/peers/cgal.cpp tests/core/boxes:<CGAL/box_intersection_d.h>:.
verify:<CGAL/Exact_predicates_inexact_constructions_kernel.h>:. | core/scene:core/other/other.h:in no folder of the table
core/scene core/canvas:core/base/error.h:. | core/gl:core/canvas/canvas.h generated/commit.h <epoxy/egl.h>:.
verify:core/canvas/canvas.h verify/certificate/certificate.h <gmpxx.h>:. | experiments/command:experiments/library/farcull.h:.
tests/verify:offsets/obb.glsl <CGAL/Kernel.h>:. | tests/faults:<epoxy/gl.h>:.
core/scene offsets verify tests/core/gl:<epoxy/gl.h> <EGL/egl.h>:may use EGL/OpenGL
core/scene core/gl verify/certificate experiments/peers:<CGAL/box.h>:may use CGAL
core/scene offsets experiments/command:<gmpxx.h> <mpfr.h>:may use GMP/MPFR
'''.strip().replace('\n', ' | ').split(' | ')]
CYCLE = 'core/view/left: a cycle of includes, with .h and .cpp of one name as one file: core/view/left, core/view/'
LEFT, TO_LEFT = {'core/view/left.h': '#include "core/view/right.h"'}, '#include "core/view/left.h"'
# Files as they are then (None: removed), and the violation.
CHANGED = [
    ({}, ''), ({'verify/odd.h': '  #  include\t"offsets/obb.h" // why\r\n'}, 'verify/odd.h: let verify include offsets'),
    ({**LEFT, 'core/view/right.h': TO_LEFT}, CYCLE + 'right'), ({**LEFT, 'core/view/right.cpp': TO_LEFT}, CYCLE + 'right'),
    ({**LEFT, 'core/view/right.cpp': '#include "middle.h"', 'core/view/middle.h': TO_LEFT}, CYCLE + 'middle, core/view/right'),
    ({**LEFT, 'core/view/right.cpp': '#include "middle.h"', 'core/view/middle.h': ''}, ''),
    ({'core/file.cpp': ''}, 'core/file.cpp: lies directly in core'),
    ({'experiments/file.h': ''}, 'experiments/file.h: lies directly in experiments'),
    ({'experiments/unknown/file.h': ''}, 'experiments/unknown/file.h: no folder of the table'),
    ({f'experiments/measure/more{i}/file.h': '' for i in range(MOST_FOLDERS)}, f'experiments: at most {MOST_FOLDERS} may'),
    *(({'verify/threads.cpp': text}, 'verify/threads.cpp: starts a thread') for text in (
        'std::jthread t(work);', 'auto f = std::async(w);', 'std::vector<std::thread> t;', 'pthread_create(&t, nullptr, w, 0);')),
    ({'verify/threads.cpp': 'unsigned n = std::thread::hardware_concurrency();'}, ''),
    ({'core/base/parallel.cpp': 'std::jthread t(work);'}, ''),
    *(({f'{folder}/words.cpp': f'const char* s = "{text}";'}, f'{folder}/words.cpp: names an option')
      for folder in ('core/view', 'offsets', 'verify', 'verify/certificate') for text in ('use --device cpu', 'see `farcull doctor`')),
    *(({'verify/words.cpp': text}, 'verify/words.cpp: has words of a stage') for text in (
        'if (progress) progress("joining boxes");', 'progress_("round " + round);', 'case StageKind::boxes: return "boxes";',
        'case Reason::full:', 'std::string name_of(const Stage& stage);', 'std::string_view word(StageKind kind);')),
    ({'core/view/words.cpp': 'const char* s = "use {device} cpu, a farcull of {doctor}"; int i = 3; int j = i--;'}, ''),
    ({'core/view/words.cpp': 'progress(StageKind::boxes); if (stage.kind == StageKind::boxes) f("x"); Stage stage_of(int n);'}, ''),
    ({'experiments/record/words.cpp': 'case StageKind::boxes: f("see `farcull doctor` --self"); std::string name_of(const Stage&);'}, ''),
    ({'README.md': 'The file `verify/gone.h`.'}, 'README.md: verify/gone.h, which does not exist'),
    ({'notes.txt': ''}, 'notes.txt: the top level holds nothing but'), ({'extra/note': ''}, 'extra: the top level holds nothing but'),
    ({'CMakeLists.txt': None}, 'CMakeLists.txt: missing at the top'), ({'README.md': None}, 'README.md: missing at the top level'),
    ({'docs/index.md': None}, 'docs: missing at the top level'),
    ({path: None for path in TREE if path[-2:] in ('.h', 'sl', 'pp')} | {f'{name}/none': '' for name in OURS}, 'no #include found: ')]
# Types beside `namespace farcull { struct A {}; }` of another file: the same one, and another one.
SAME_TYPE = ['class A {};', 'struct A final : B<int> {};', 'enum class A : int { x };', 'template <class T = int> struct A {};',
             'struct alignas(64) [[nodiscard]] A {};', r'const char* s = "{\"}"; struct A {};', "char c = '{'; struct A {};",
             '/* { */ struct A {}; // }', "const int n = 1'000; struct A {};", 'int f(int x) { return x; } struct A {};',
             'const char* s = R"(\n{)"; struct A {};', '\n#define X {\\\n{\nstruct A {};']
OTHER_TYPE = ['namespace deep { struct A {}; }', 'namespace { struct A {}; }', 'struct B { struct A {}; };',
              'struct A; struct B::A {}; template <> struct A<int> {};', 'void f() { struct A {}; } struct A* g() {}']
# What a page says, and the path that is not there.
PAGES = [
    ('The file `core/base/gone.h`.', 'core/base/gone.h'), ('The folder `tests/gone/`.', 'tests/gone'),
    ('Run `bash tests/gone.sh --all` twice.', 'tests/gone.sh'), ('Run `bash\ntests/gone.sh`.', 'tests/gone.sh'),
    ('    bash experiments/gone.sh', 'experiments/gone.sh'), ('Any `offsets/gone_*.glsl`.', 'offsets/gone_*.glsl'),
    ('In the new file `core/base/made.h`: see `core/base/made.h`.', ''), ('See [this](gone.md#part).', 'gone.md'),
    ('See `core/base/made.h`.\n\nIn the new file `core/base/made.h`:', 'core/base/made.h'),
    ('See `core/base/error.h`, `core/base/error`, `core/`, `offsets/NAME.glsl`, `verify/*.h`.', ''),
    ('See [this](index.md), [that](../README.md), [there](https://example.org/gone) and [here](#gone).', ''),
    ('Options `--report`, `{"mesh": "core"}`, `x/core/y`, and core/gone without marks.', '')]


def put(change):
    """Makes the tree, with this change."""
    for name in set(os.listdir()) - {'.git'}:
        (os.remove if os.path.isfile(name) else shutil.rmtree)(name)
    for path, text in {**TREE, **change}.items():
        if text is not None:
            Path(path).parent.mkdir(parents=True, exist_ok=True)
            Path(path).write_text(text + '\n', 'utf-8')


def changes():
    for folders, texts, reason in INCLUDING:
        for folder, text in itertools.product(folders.split(), texts.split()):
            path = folder if '.' in folder else folder + '/f.cpp'
            included = text if text[0] == '<' else f'"{text}"' if '.' in text else f'"{text}/other.h"'
            other = folder_of(os.path.normpath(os.path.join(folder if text[0] == '.' else '', included[1:-1])))
            why = f'the table does not let {folder_of(path)} include {other}' if reason == '=' else reason.strip('.')
            yield {path: f'// a file\n#include {included}'}, why and f'{path}: {why}'
    for text in SAME_TYPE + OTHER_TYPE:
        yield {'verify/a.h': 'namespace farcull { struct A {}; }', 'verify/b.cpp': f'namespace farcull {{ {text} }}'}, \
            'verify/b.cpp: defines farcull::A, and so does verify/a.h:1: a type name once' if text in SAME_TYPE else ''
    yield {'verify/a.h': 'namespace farcull { namespace d { struct A {}; } }', 'verify/b.h': 'namespace farcull::d { class A {}; }'}, \
        'verify/b.h: defines farcull::d::A, and so does verify/a.h:1'
    for text, path in PAGES:
        yield {'docs/page.md': text}, path and f'docs/page.md: {path}, which does not exist'
    yield from CHANGED


def self_test():
    failed = []
    for change, text in ({}, 'experiments/method +-> offsets.*, 0 upward'), \
            ({'core/base/error.h': '#include "core/view/view.h"'}, r'core/view \(against the table\).*, 1 upward'):
        put(change)
        failed += [graph()] if not re.search(text, graph(), re.DOTALL) else []
    for change, expected in itertools.chain(changes(), [({}, 'git')] if shutil.which('git') else [], CHANGED):
        put(change)
        if expected == 'git':  # from here on the top level is that of a git checkout
            subprocess.run(['git', '-c', 'init.defaultBranch=main', 'init', '-q'], check=True)
            continue
        said, count = check()
        place, _, reason = expected.partition(': ')
        if not (count == 1 and said.startswith(place + ':') and reason in said if expected else count == 0):
            failed.append(f'{change}: expected {expected!r}, got {said}')
    return '\n'.join(failed) or 'layout: every rule is caught when it is broken', bool(failed)


option, *root = sys.argv[1:] if sys.argv[1:] and sys.argv[1][0] == '-' else ['--check', *sys.argv[1:]]
for variable in 'GIT_DIR', 'GIT_WORK_TREE', 'GIT_INDEX_FILE':  # a git hook sets these for its own repository
    os.environ.pop(variable, None)
with tempfile.TemporaryDirectory() as scratch:
    os.chdir(scratch if option == '--self-test' else root[0] if root else os.path.dirname(os.path.realpath(__file__)) + '/..')
    message, result = {'--self-test': self_test, '--graph': lambda: (graph(), 0), '--check': check}[option]()
    os.chdir('/')
print(message)
sys.exit(result > 0)
