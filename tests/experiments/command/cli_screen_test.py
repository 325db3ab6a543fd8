"""What a new user sees: text for people fits 100 columns where it goes into a file, whatever COLUMNS says, and the terminal
where there is one; it has no words that read as a failure."""
import re

from cli_lab import ERR, OUT, case, launch, read, rows

rows('a.obj << v 0 0 0; v 1 0 0; v 0 1 0; v 0 0 1; f 1 2 3; f 1 2 4; f 1 3 4; f 2 3 4\n$ cp a.obj b.obj')
NAMES = 'run verify plan compare distance clash bench doctor check experiment merge picture report scenes suite completion'.split()
COMMANDS = [
    '--help', *(f'{name} --help' for name in NAMES), 'help terms', 'help methods', 'help pairs', 'help scene-file',
    'experiment accuracy --help', 'scenes', 'doctor --device native', 'doctor --device software', 'run two-tori -v',
    'run a.obj b.obj', 'run two-tori --method far --device native -v', 'run crowd --method cullide --resolution 64 -v',
    'run crowd --method quick-cullide --resolution 64 --rounds 2 --device software -v', 'run two-spheres --self -v',
    'run two-spheres --method far --frames 2 --resolution 64', 'run crowd --frames 2 --self', 'verify two-tori --method far',
    'verify two-spheres --frames 2', 'plan two-tori', 'plan two-tori --method far', 'plan a.obj b.obj',
    'plan crowd --method cullide --resolution 64', 'plan two-spheres --self --method far', 'compare a.obj b.obj --resolutions 64',
    'compare two-tori --resolutions 64 --radius budget,published --offsets obb,exact --repeat 1',
    'compare two-spheres --self --resolutions 64 --repeat 1', 'compare two-tori --methods far,cullide --rounds 1 --clear all '
    '--resolutions 64 --repeat 1', 'bench two-spheres --repeat 1', 'bench two-spheres --repeat 1 --distances objects',
    'distance two-tori', 'distance a.obj b.obj', 'distance crowd:20', 'clash two-tori', 'clash crowd:20 --depth']
# Words that a reader without the pages takes for a failure, in what is printed without an option.
ALARMING = r'\b(no view|hardware device|untested|not tested|runs +pairs|none: )'


def longest(text):
    return max(text.split('\n'), key=len)


for words in COMMANDS:
    for columns in ('COLUMNS=300', 'COLUMNS='):
        launch([columns, *words.split()])
        said = read(OUT) + read(ERR)
        line = longest(said)
        case(f'{words} fits', said and len(line) <= 100, f'{len(line)}: {line}')
        if '--help' not in words and not words.startswith('help'):
            alarm = re.search(ALARMING, said)
            case(f'{words} does not alarm', not alarm, alarm and alarm[0])
        if columns == 'COLUMNS=300' and words.startswith(('bench', 'doctor', 'clash', 'compare')):
            break  # they take a second

# A message is wrapped as well, below its text; and a terminal has its own width.
launch(['run', 'a.obj', 'there-is-no-such-mesh.obj', 'b.obj', '--method', 'nothing-that-is-known'])
case('a message fits', len(longest(read(ERR))) <= 100 and re.match('farcull: .*\n( {9}[^ ].*\n)*$', read(ERR)), read(ERR))
rows(r"""
$ script -qec "stty cols 60; env TERM=xterm '$farcull' plan two-tori --method far" /dev/null </dev/null >shown 2>&1
$ (($(tr -d '\r' <shown | wc -L) <= 60)) && grep -q '^stage ' shown
$ script -qec "stty cols 140; env TERM=xterm '$farcull' plan two-tori" /dev/null </dev/null >shown 2>&1
$ (($(tr -d '\r' <shown | wc -L) > 100))
""")
