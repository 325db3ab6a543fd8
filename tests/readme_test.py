"""The commands of README.md and of pages that continue it: those that begin with build/farcull are run in their order, in an
empty folder; of the others the words are held against the help.
   tests/readme_test.py FARCULL [PAGE...]"""
import functools
import os
import re
import subprocess
import sys
import tempfile

program, *pages = map(os.path.realpath, sys.argv[1:])
root = os.path.dirname(os.path.dirname(os.path.realpath(__file__)))
pages = pages or [f'{root}/README.md', *(f'{root}/docs/{name}.md' for name in ('scenes', 'methods', 'tiles', 'experiments'))]


def commands_of(page):
    """The indented lines that call farcull, without their comments."""
    with open(page, encoding='utf-8') as file:
        return [re.sub(' +#.*', '', line) for line in re.findall(r'^    ((?:build/)?farcull .*)', file.read(), re.MULTILINE)]


@functools.cache
def help_of(*command):
    return subprocess.run([program, *command, '--help'], stdout=subprocess.PIPE, check=False, text=True).stdout


def unknown(line):
    """What the program does not know of the line."""
    command = []
    for word in re.split('[|&]', line)[0].split()[1:]:
        text = help_of(*command)
        subcommands = re.search('^Subcommands:\n(.*?)(^$|\\Z)', text, re.MULTILINE | re.DOTALL)
        option = re.escape(word.split('=')[0])
        if word.startswith('-'):
            if not re.search(f'^  (?:(?:-[a-z],)?{option}( |$)|{option}[, ])', text, re.MULTILINE):
                yield f"'{word}' in: {line}"
        elif len(command) < 2 and subcommands and re.search(f'^  {re.escape(word)}( |$)', subcommands[1], re.MULTILINE):
            command.append(word)
        elif not command:
            yield f"'{word}' in: {line}"


def wrong(lines):
    """Commands that cannot be as they stand."""
    for line in lines:
        said = list(unknown(line))
        yield from said
        if line.startswith('build/') and not said:
            child = subprocess.run(['timeout', '120', 'bash', '-c', f'set -o pipefail; {line}'], stdin=subprocess.DEVNULL,
                                   stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False, text=True)
            if child.returncode and 'was built without OpenGL' not in child.stdout:
                yield f'status {child.returncode} of: {line}: {child.stdout[-300:]}'


with tempfile.TemporaryDirectory() as work:
    os.chdir(work)
    os.mkdir('build')
    os.symlink(program, 'build/farcull')
    commands = [line for page in pages for line in commands_of(page)]
    failures = [] if len(commands) >= 12 else [f'only {len(commands)} commands are found in {pages}']
    failures += wrong(commands)
    failures += [f'this is not noticed: {line}' for line in (
        'farcull run two-spheres --metod far', 'farcull rum two-spheres', 'build/farcull run there-is-no-such-scene',
        'build/farcull run two-spheres --method fast', 'farcull experiment accuracy --clearance 1') if not list(wrong([line]))]
    os.chdir('/')
print('\n'.join(f'readme_test: {failure}' for failure in failures) or f'readme_test: {len(commands)} commands')
sys.exit(bool(failures))
