"""Completion in bash, against the help of every command."""
import functools
import os
import re
import subprocess

from cli_lab import case, program, read, rows

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


def missing(script):
    """Each option of the help that the script does not have."""
    return [f'{command} {option}' for command in commands
            for options in re.findall('^  (-[^ ]+)', help_of(command), re.MULTILINE) for option in options.split(',')
            if not has_in_table(script, f'farcull {command}'.strip(), option)]


commands = commands_below()
case('commands', len(commands) > 20, f'only {commands} are found in the help')
rows(r"""
0 completion | completion bash >script.bash
""")
lost = missing(read('script.bash'))
case('script.bash', not lost, f'it lacks {lost}')
# The twin: one option is taken out, and noticed.
lost = missing(re.sub(' --clearance(?= )', '', read('script.bash')))
case('script.bash without an option', any('--clearance' in text for text in lost), 'it is not noticed')

rows(r"""
mesh.obj << {T}; f 1 2 3
$ gzip -k mesh.obj && echo text >notes.txt && mkdir meshes
""")


def offered(line):
    child = subprocess.run(['bash', '--noprofile', '--norc', '-c', '''set -eu
        source script.bash
        [[ $(complete -p farcull) == "complete -F _farcull farcull" ]]
        COMP_LINE=$1 COMP_POINT=${#1}
        _farcull
        echo "${COMPREPLY[*]-}"''', 'bash', line], capture_output=True, check=False, text=True, stdin=subprocess.DEVNULL)
    case(line, not child.stderr, child.stderr)
    return child.stdout.split()


for line, wanted, unwanted in (
        ('farcull ru', 'run', 'compare'),
        ('farcull run --method ', 'far cullide boxes exact', 'native two-spheres'),
        ('farcull run --self two-sph', 'two-spheres', 'run'),
        ('farcull experiment ', 'accuracy all lemma', 'run two-spheres'),
        ('farcull experiment all --qui', '--quick', '--query'),
        ('farcull run --query=o', 'occlusion', 'flags'),
        ('farcull run me', 'mesh.obj mesh.obj.gz meshes', 'notes.txt'),
        ('farcull check notes.txt me', 'mesh.obj', 'notes.txt')):
    words = offered(line)
    case(line, set(wanted.split()) <= set(words) and not set(unwanted.split()) & set(words), f'it offers {words}')
