"""Tables of command lines and their answers, for the tests cli_*_test.py.
   cli_NAME_test.py FARCULL [ANOTHER_FILE]
Importing this module launches the program once for each GL method and goes to an empty folder. At the end it prints the
number of cases; the exit status is 1 if any failed. With FARCULL_VERBOSE set, command lines are printed as they run.

rows(TABLE, NAME=VALUE...) runs a table, a case per line. A line that begins with a space goes on with the line
before it; # begins a comment. Fields are between " | ":
   bad CASE | MESSAGE | ARGUMENTS          a bad input: status 2 within five seconds of CPU time, nothing on
                                           stdout, one message on stderr, "farcull: ", what matches MESSAGE, and a
                                           remedy after a semicolon; all files stay as they are
   each MESSAGE | ARGUMENTS | MORE | ...   a bad input for each MORE, which are further arguments; {0} in MESSAGE is
                                           their first word
   STATUS CASE | ARGUMENTS | CHECK...      an answer: this status; as many messages on stderr as there are checks @err;
                                           no control characters
   FILE << TEXT                            writes a file, with a line end for each "; "
   $ COMMAND                               a command of bash that has to succeed; $farcull is the program
A CHECK is one of
   REGEX           a line of stdout matches        @FILE REGEX   a line of the file (err: of stderr) does
   #N REGEX        line N does; N may be negative  ~ REGEX       all lines, without blanks, as one do
   ! REGEX         no line matches                 $ COMMAND     bash; $out and $err are files
@FILE may stand before the others. A MESSAGE or REGEX that ends in a colon has a space after it.
ARGUMENTS are words of the shell. Before them there may be VARIABLE=VALUE, after them >FILE for stdout (or >>FILE
to append), which may be >closed, or >broken for a pipe that nobody reads.
{NAME} stands for the VALUE. If that is a list, the line is run for each: in ARGUMENTS as one word, with {*NAME} as
several; {NAME0} is the first word. {T} is always the vertices of a tetrahedron.
"""
import atexit
import itertools
import os
import re
import resource
import shlex
import shutil
import signal
import subprocess
import sys
import tempfile

if len(sys.argv) < 2 or not all(os.path.exists(path) for path in sys.argv[1:]):
    sys.exit(f'usage: {sys.argv[0]} FARCULL [ANOTHER_FILE]')
program, *others = map(os.path.realpath, sys.argv[1:])
root = os.path.realpath(os.path.dirname(__file__) + '/../../..')
work = tempfile.mkdtemp()
here, OUT, ERR = work + '/here', work + '/stdout', work + '/stderr'
os.mkdir(here)
os.chdir(here)

# What the caller has set must not decide; few malloc arenas, since each thread's takes address space that is
# counted below. Verdicts about devices lie beside the program, made once, since a run says so when it makes one.
for name in '''FARCULL_MESHES EGL_LOG_LEVEL LIBGL_ALWAYS_SOFTWARE GALLIUM_DRIVER MESA_GL_VERSION_OVERRIDE NO_COLOR
    MESA_GLSL_VERSION_OVERRIDE __EGL_VENDOR_LIBRARY_DIRS __EGL_VENDOR_LIBRARY_FILENAMES LP_NUM_THREADS'''.split():
    os.environ.pop(name, None)
os.environ.update(LC_ALL='C', MALLOC_ARENA_MAX='2', farcull=program, out=OUT, err=ERR,
                  XDG_CACHE_HOME=os.path.dirname(program) + '/test-cache')
# A run that takes a minute is taken for one that hangs. A billion vertices are 12 GB as floats, a billion triangles
# as much in indices; good runs pass with a tenth of this address space (KiB).
SECONDS, CPU_SECONDS, ADDRESS_SPACE = 60, 5, 4_000_000

cases, failed = 0, 0
status, out = 0, OUT  # of the last launch; out is the file that stdout went to


def read(path):
    with open(path, encoding='utf-8', errors='surrogateescape', newline='\n') as file:
        return file.read()


def read_err():
    """stderr, with the lines of each message joined again."""
    return re.sub(r'\n {9}(?=\S)', ' ', read(ERR))


def write(path, text):
    with open(path, 'wb') as file:
        file.write(text if isinstance(text, bytes) else text.encode('utf-8', 'surrogateescape'))


def case(name, good=True, why=''):
    """Counts a case, and prints it if it failed."""
    global cases, failed
    cases += 1
    if not good:
        failed += 1
        print(f'FAILED {name}: {why}; stderr: {read(ERR)[:300] if os.path.exists(ERR) else ""!r}')
    return good


@atexit.register
def finish():
    os.chdir('/')
    subprocess.run(['chmod', '-R', 'u+w', work], check=False)
    shutil.rmtree(work)
    print(f'{os.path.basename(sys.argv[0])}: {cases} cases, {failed or "none"} failed', flush=True)
    if failed or not cases:
        os._exit(1)


def snapshot():
    """Names, sizes, times and targets of all that lies in the folder."""
    found = {}
    for folder, folders, files in os.walk('.'):
        for name in folders + files:
            path = os.path.join(folder, name)
            stat = os.lstat(path)
            found[path] = (stat.st_mode, stat.st_size, stat.st_mtime_ns, stat.st_ino)
    return found


def start(words, cpu=None, memory=ADDRESS_SPACE, file_size=None):
    """Starts the program with these arguments; stdout goes to `out`."""
    global out
    words, environment, out = list(words), dict(os.environ), OUT
    if os.environ.get('FARCULL_VERBOSE'):
        print(shlex.join(words), file=sys.stderr)
    while words and re.match('[A-Z_]+=', words[0]):
        key, _, environment[key] = words.pop(0).partition('=')
    if words and words[-1].startswith('>'):
        out = words.pop()[1:]
    to, mode = out.removeprefix('>'), 'ab' if out.startswith('>') else 'wb'
    if mode == 'ab' or to in ('closed', 'broken', '/dev/full', '/dev/null'):
        out = OUT
    write(OUT, '')

    def limit():
        signal.signal(signal.SIGINT, signal.SIG_DFL)  # which a shell has its background ignore
        for what, most in (resource.RLIMIT_AS, memory and memory * 1024), (resource.RLIMIT_CPU, cpu), \
                (resource.RLIMIT_FSIZE, file_size):
            if most:
                resource.setrlimit(what, (most, most))
        if to == 'closed':
            os.close(1)

    reader, writer = os.pipe()
    os.close(reader)
    with open(OUT if to in ('closed', 'broken') else to, mode) as stdout, open(ERR, 'wb') as stderr:
        child = subprocess.Popen([program, *words], env=environment, preexec_fn=limit, stdin=subprocess.DEVNULL,
                                 stdout=writer if to == 'broken' else stdout, stderr=stderr)
    os.close(writer)
    return child


def ended(child, seconds=SECONDS):
    """The status: 124 after so many seconds, the negative signal if one ended it."""
    try:
        return child.wait(seconds)
    except subprocess.TimeoutExpired:
        child.kill()
        child.wait()
        return 124


def launch(words, seconds=SECONDS, **limits):
    global status
    status = ended(start(words, **limits), seconds)
    return status


def bash(command):
    environment = dict(os.environ, out=os.path.realpath(out))
    return subprocess.run(['bash', '-c', command], env=environment, check=False).returncode


def spaced(pattern):
    return pattern + ' ' * pattern.endswith(':')


def bad(name, message, words, **limits):
    """A bad input, which also leaves the folder as it was."""
    before = snapshot()
    launch(words, **{'cpu': CPU_SECONDS, **limits})
    said, after = read_err(), snapshot()
    changed = sorted(path for path in {*before, *after} if before.get(path) != after.get(path))
    why = (f'not done after {SECONDS} s' if status == 124
           else f'not done after {CPU_SECONDS} s of CPU time' if status in (-9, -24)
           else f'status {status} instead of 2' if status != 2
           else 'something on stdout' if read(out)
           else 'not one line on stderr' if said.count('\n') != 1 or said[-1] != '\n'
           else f"the message does not match '{message}'" if not re.match(f'farcull: (?:{spaced(message)})', said)
           else 'no remedy' if not re.search('[^ ]; [^ ]', said)
           else 'control characters on stderr' if re.search(r'[\0-\x1f\x7f]', said[:-1])
           else f'the folder changed: {changed}' if changed else '')
    case(name, not why, why)


def good(name, wanted, words, checks=(), **limits):
    """An answer of this status, and what it says."""
    launch(words, **limits)
    said = read_err()
    lines = sum(check.startswith('@err') for check in checks)
    why = (f'status {status} instead of {wanted}' if status != wanted
           else f'not {lines} lines on stderr' if said.count('\n') != lines
           else 'control characters on stderr' if re.search(r'[\0-\x09\x0b-\x1f\x7f]', said) else '')
    case(name, not why, why)
    for check in checks:
        expect(name, check)


def expect(name, check):
    """The last answer passes the check."""
    if check.startswith('$ '):
        case(name, bash(check[2:]) == 0, check)
        return
    file, how, pattern = re.fullmatch(r'(?:@(\S+) )?(! |~ |#-?\d+ )?(.*)', check).groups()
    path = ERR if file == 'err' else file or out
    lines = (read_err() if path == ERR else read(path)).split('\n')[:-1] if os.path.exists(path) else []
    if how == '~ ':
        lines = [re.sub(r'\s', '', ''.join(lines))]
    elif how and how[0] == '#':
        at = int(how[1:])
        lines = lines[at:at + 1 or None]
    matches = any(re.search(spaced(pattern), line) for line in lines)
    case(name, matches != (how == '! '), f"{file or 'stdout'} does not pass '{how or ''}{pattern}': {lines[:3]}")


def fill(text, values, quoted):
    def value_of(match):
        star, name, first = match.groups()
        if name not in values:
            return match[0]
        value = values[name].split()[0] if first else values[name]
        return shlex.quote(value) if quoted and not star else value
    return re.sub(r'\{(\*?)([a-zA-Z]+)(0?)\}', value_of, text)


def row(line, chosen, limits):
    if line.startswith('$ '):
        command = fill(line[2:], chosen, False)
        case(command, bash(command) == 0, 'the command failed')
        return
    if re.match(r'\S+ << ', line):
        path, _, text = fill(line, chosen, False).partition(' << ')
        write(path, text.replace('; ', '\n') + '\n')
        return
    kind, rest = line.split(' ', 1)
    fields = [field.strip() for field in re.split(r' \|(?= |$)', rest)]
    plain, quoted = ([fill(field, chosen, how) for field in fields] for how in (False, True))
    if kind == 'each':
        for more in quoted[2:]:
            words = shlex.split(quoted[1] + ' ' + more)
            bad(' '.join(words), plain[0].replace('{0}', (more.split() or [''])[0]), words, **limits)
    elif kind == 'bad':
        bad(*plain[:2], shlex.split(quoted[2]), **limits)
    else:
        good(plain[0], int(kind), shlex.split(quoted[1]), plain[2:], **limits)


def rows(table, limits=None, **values):
    lists = {name: [one.replace('{PWD}', here) for one in value]
             for name, value in values.items() if not isinstance(value, str)}
    fixed = {'T': 'v 0 0 0; v 1 0 0; v 0 1 0; v 0 0 1', 'PWD': here,
             **{name: value for name, value in values.items() if name not in lists}}
    for line in re.sub(r'\n[ \t]+', ' ', '\n' + table).split('\n'):
        if not line or line[0] == '#':
            continue
        for name in (*fixed, *fixed):  # twice, since values may name others
            line = line.replace('{' + name + '}', fixed[name])
        used = [name for name in lists if re.search(r'\{\*?' + name + r'0?\}', line)]
        for choice in itertools.product(*(lists[name] for name in used)):
            row(line, dict(zip(used, choice)), limits or {})


launch(['run', 'two-spheres', '--method', 'far', '--device', 'software', '--no-verify'])
