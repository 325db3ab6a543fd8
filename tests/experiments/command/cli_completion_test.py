"""Completion and the manual, against the help of every command; in bash, zsh and fish, and by the readers of manuals, where
these are installed."""
import functools
import os
import re
import shutil
import subprocess

from cli_lab import case, program, read, rows, write

os.environ['PATH'] = os.path.dirname(program) + ':' + os.environ['PATH']


@functools.cache
def help_of(command):
    return subprocess.run([program, *command.split(), '--help'], stdout=subprocess.PIPE, check=True, text=True).stdout


def commands_below(command=''):
    """The command, and those below it: "experiment all". From the help alone."""
    listed = re.search('^Subcommands:\n.*?(^$|\\Z)', help_of(command), re.MULTILINE | re.DOTALL)
    names = re.findall('^  ([a-z][a-z-]*)', listed[0], re.MULTILINE) if listed else []
    return [command, *(word for name in names for word in commands_below(f'{command} {name}'.strip()))]


def has_in_table(script, command, option):
    """In the branch of _farcull_words for the command."""
    words = re.search('^_farcull_words.*?^}', script, re.MULTILINE | re.DOTALL)[0]
    branches = re.findall(f"^    '?{command}'?\\).*\n.*", words, re.MULTILINE)
    return re.search(f"[' =]{option}( |'|$)", '\n'.join(branches), re.MULTILINE)


def has_in_fish(script, command, option):
    lines = re.findall(rf".*__farcull_at (?:'\\'')?{command}(?:'\\'')?'.*", script)
    flag = f' -l {option[2:]} ' if option.startswith('--') else f' -s {option[1:]} '
    return any(flag in line for line in lines)


def has_in_manual(page, command, option):
    head = 'SS ' + command if ' ' in command else 'SH DESCRIPTION'
    sections = re.split(r'^\.(?=S[SH] )', page.replace('\\-', '-'), flags=re.MULTILINE)
    return any(f'\\fB{option}\\fR' in text for text in sections if text.startswith(head + '\n'))


def missing(has, text):
    """Each option of the help that the text, a script or the manual, does not have."""
    return [f'{command} {option}' for command in commands
            for options in re.findall('^  (-[^ ]+)', help_of(command), re.MULTILINE) for option in options.split(',')
            if not has(text, f'farcull {command}'.strip(), option)]


commands = commands_below()
case('commands', len(commands) > 20, f'only {commands} are found in the help')
rows(r"""
0 completion {shell} | completion {shell} >script.{shell}
0 the manual | man >farcull.1
""", shell=['bash', 'zsh', 'fish'])
for has, file in (has_in_table, 'script.bash'), (has_in_table, 'script.zsh'), (has_in_fish, 'script.fish'), \
        (has_in_manual, 'farcull.1'):
    lost = missing(has, read(file))
    case(file, not lost, f'it lacks {lost}')
# The twins: one option is taken out, and noticed.
for has, file, option in (has_in_table, 'script.bash', ' --clearance(?= )'), \
        (has_in_fish, 'script.fish', '.* -l clearance .*\n'), (has_in_manual, 'farcull.1', '.*clearance.*\n'):
    lost = missing(has, re.sub(option, '', read(file)))
    case(f'{file} without an option', any('--clearance' in text for text in lost), 'it is not noticed')

# ---- readers of manuals

write('broken.1', '.TH X 1\n.SH NAME\nx \\- y\n.TS\nbroken\n')
for tool, good, command in (
        ('mandoc', True, 'mandoc -T lint -W error farcull.1'), ('mandoc', False, 'mandoc -T lint -W error broken.1'),
        ('groff', True, 'groff -ww -man -Tascii farcull.1 >page 2>said; [[ ! -s said ]]'),
        ('groff', True, "grep -q 'collision culling that never misses' page"),
        ('man', True, "man -l farcull.1 | grep 'farcull'")):
    if shutil.which(tool):
        child = subprocess.run(['bash', '-c', command], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, check=False)
        case(command, (child.returncode == 0) == good, f'status {child.returncode}')
    else:
        print('not run:', tool)

# ---- shells: what each offers at the end of a line

OFFER = {
    'bash': ['bash', '--noprofile', '--norc', '-c', '''set -eu
        source script.bash
        [[ $(complete -p farcull) == "complete -F _farcull farcull" ]]
        COMP_LINE=$1 COMP_POINT=${#1}
        _farcull
        echo "${COMPREPLY[*]-}"''', 'bash'],
    'zsh': ['zsh', '-f', '-c', '''compdef() { : }
        compadd() { shift; offered+=("$@") }
        compset() { current=${current#*=} }
        _files() { offered+=(FILES) }
        offered=()
        source ./script.zsh
        words=(${(z)1}) CURRENT=${#words}
        [[ $1 == *" " ]] && { words+=(""); CURRENT=${#words} }
        _farcull
        print -r -- "${(@M)offered:#${words[CURRENT]#*=}*}" ${(M)offered:#FILES}''', 'zsh'],
    'fish': ['fish', '--no-config', '-c',
             'source script.fish; complete -C $argv[1] | string replace -r "\\t.*" ""; true', '--']}
rows(r"""
mesh.obj << {T}; f 1 2 3
$ gzip -k mesh.obj && echo text >notes.txt && mkdir meshes fish
""")


def offered(shell, line):
    child = subprocess.run([*OFFER[shell], line], env=dict(os.environ, XDG_CONFIG_HOME='fish'), capture_output=True,
                           check=False, text=True, stdin=subprocess.DEVNULL)
    case(f'{shell}: {line}', not child.stderr, child.stderr)
    return child.stdout.split()


for shells, line, wanted, unwanted in (
        ('bash zsh fish', 'farcull ru', 'run', 'compare'),
        ('bash zsh fish', 'farcull run --method ', 'far cullide boxes exact', 'native two-spheres'),
        ('bash zsh fish', 'farcull run --self two-sph', 'two-spheres', 'run'),
        ('bash zsh fish', 'farcull experiment ', 'accuracy all lemma', 'run two-spheres'),
        ('bash zsh fish', 'farcull experiment all --qui', '--quick', '--query'),
        ('bash', 'farcull run --query=o', 'occlusion', 'flags'),
        ('bash', 'farcull run me', 'mesh.obj mesh.obj.gz meshes', 'notes.txt'),
        ('bash', 'farcull check notes.txt me', 'mesh.obj', 'notes.txt')):
    for shell in filter(shutil.which, shells.split()):
        words = offered(shell, line)
        case(f'{shell}: {line}', set(wanted.split()) <= set(words) and not set(unwanted.split()) & set(words),
             f'it offers {words}')
for shell in OFFER:
    if not shutil.which(shell):
        print('not run:', shell)
