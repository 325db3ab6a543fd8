"""Studies: killed and resumed, interrupted, on a full disk, in shards, and into files that are none of ours."""
import contextlib
import os
import random
import signal
import sqlite3
import subprocess
import time

from cli_lab import bad, case, ended, expect, good, launch, rows, start, work

# The study of the most points and the least work; every point of it by itself takes milliseconds.
STUDY = 'experiment precision --quick --out'


def query(folder, text, *values, store='results.sqlite'):
    with contextlib.closing(sqlite3.connect(f'{folder}/{store}')) as base, base:
        return base.execute(text, values).fetchall()


def rows_of(folder):
    """What has to be the same on every run: everything but times and runs."""
    return query(folder, 'SELECT study, position, device, counts, left_out FROM rows ORDER BY study, position')


def measure(name, options, *checks):
    good(name, 0, [*STUDY.split(), *options.split()], checks, seconds=240, memory=None)


def same(name, folder):
    other = rows_of(folder)
    case(name, other == whole, f'{[pair for pair in zip(whole, other) if pair[0] != pair[1]][:3]}, {len(other)} rows')


started = time.monotonic()
measure('whole', 'whole', '^precision +[0-9]', '^results: whole/results.sqlite$')
took = time.monotonic() - started
whole = rows_of('whole')
points = len(whole)
case('whole', points > 20, f'only {points} points')


def devices():
    """What may differ on the further device is in a store of its own. Here both are the same one."""
    def differing():
        with contextlib.closing(sqlite3.connect('devices/results.sqlite')) as base:
            base.execute("ATTACH 'devices/on-native/results.sqlite' AS other")
            return base.execute('''SELECT count(*), sum(a.counts != b.counts) FROM results a JOIN other.results b
                USING (study, scene, method, "offset", radius, depth_format, depth_mode, resolution, views, frame,
                seed)''').fetchone()
    measure('devices', 'devices --devices native,native')
    compared, other = differing()
    case('the same device twice', compared > 0 and other == 0, f'{compared}, {other}')
    query('devices/on-native', "UPDATE rows SET counts = '{}' WHERE position = 0")
    case('a changed count of a device', differing() == (compared, 1), differing())


def killed():
    """Ten kills at random moments of a run; what is left is gone on with. A run that ended before its kill does not count, and the
    next ones come sooner."""
    seed = int(os.environ.get('FARCULL_SEED', '0'))
    draw, kills, longest = random.Random(seed), 0, took / 5
    while kills < 10 and longest > 1e-6:
        child = start([*STUDY.split(), 'killed', '--resume'], memory=None)
        time.sleep(draw.random() * longest)
        child.kill()
        if ended(child) == -signal.SIGKILL:
            kills += 1
        else:
            longest /= 2
    case('killed', kills == 10, f'only {kills} kills met a run that was going on')
    measure('killed', 'killed --resume')
    same(f'killed (FARCULL_SEED={seed})', 'killed')


def interrupted():
    """Ctrl-C: says how far it is and how to go on."""
    child = start([*STUDY.split(), 'interrupted'], memory=None)
    for _ in range(100):
        time.sleep(0.05)
        if os.path.exists('interrupted/results.sqlite'):
            time.sleep(0.3)
            break
    child.send_signal(signal.SIGINT)
    case('interrupted', ended(child) == -signal.SIGINT, 'not ended by the signal')
    expect('interrupted', f'@err ^farcull: interrupted: after [0-9]+ of {points} points; .*--resume')
    measure('interrupted', 'interrupted --resume')
    same('interrupted', 'interrupted')


def full_disk():
    """A small file system where one may be mounted; and a limit on files."""
    disk = work + '/disk'
    os.mkdir(disk)
    if subprocess.run(['mount', '-t', 'tmpfs', '-o', 'size=48k', 'farcull-test', disk], check=False).returncode == 0:
        try:
            bad('full disk', f'{disk}/full/results.sqlite: cannot be written.*--resume', [*STUDY.split(), disk + '/full'])
            subprocess.run(['mount', '-o', 'remount,size=64m', disk], check=True)
            measure('full disk', f'{disk}/full --resume')
            same('full disk', disk + '/full')
        finally:
            subprocess.run(['umount', disk], check=True)
    else:
        print('not run: a disk that is really full (no file system may be mounted here)')
    status = launch([*STUDY.split(), 'limited'], file_size=48 * 1024)
    case('limited file', status == 2, f'status {status}')
    expect('limited file', '@err ^farcull: limited/results.sqlite: cannot be written.*--resume')
    measure('limited file', 'limited --resume')
    same('limited file', 'limited')


def shards():
    for shard in 3, 2, 1:
        measure('shards', f'shards --shard {shard}/4')
    rows('bad a shard is missing | shard 4/4: of precision is missing | merge shards')
    measure('shards', 'shards --shard 4/4')
    rows(r"""
bad a shard twice | .*is shard 1/4 of precision, and so is
  | merge shards/results-1-of-4.sqlite shards/results-1-of-4.sqlite -o new.sqlite
0 merge | merge shards | ^{points} rows of 1 study from 4 shards: shards/results.sqlite$
bad merged already | shards/results.sqlite: is there already | merge shards
""", points=str(points))
    same('shards', 'shards')
    query('shards', "UPDATE rows SET counts = '{}' WHERE position = 3")
    case('a row that was changed', rows_of('shards') != whole, 'no difference was seen')
    query('shards', 'DELETE FROM rows WHERE position = 5', store='results-2-of-4.sqlite')
    rows('bad a hole | shards/results-2-of-4.sqlite: has no row of precision | merge shards -o new.sqlite')


for step in devices, killed, interrupted, full_disk, shards:
    step()

rows(r"""
# A folder that SQLite would take for something else than a folder.
0 a folder with a colon | {study} 'file:x?mode=memory&q=' --shard 1/1000
  | $ [[ -e 'file:x?mode=memory&q=/results-1-of-1000.sqlite' ]]
# What is refused.
bad again without --resume | whole/results.sqlite: holds [0-9]+ rows of precision already | {study} whole
bad another seed | whole/results.sqlite: precision stands there with | {study} whole --resume --seed 2
bad the other grid | whole/results.sqlite: precision stands there with | experiment precision --out whole --resume
$ mkdir foreign database empty damaged && sqlite3 database/results.sqlite 'CREATE TABLE mine (a)'
foreign/results.sqlite << my notes, long enough to be no empty file
bad a foreign file | foreign/results.sqlite: is no store of farcull | {study} foreign --resume
bad a foreign database | database/results.sqlite: is a database of another program | {study} database
$ head -c 20000 whole/results.sqlite >damaged/results.sqlite && : >afile
bad a file cut short | damaged/results.sqlite: is damaged | {study} damaged --resume
bad the folder is a file | afile: is no folder | {study} afile
bad no such study | acuracy: no such command | experiment acuracy
bad no study | experiment: no study is named; name one: all, scenes, accuracy | experiment
bad seed 0 | --seed: 0 is out of range | experiment precision --seed 0
bad a shard that is none | --shard: '5/4' is no shard | experiment precision --shard 5/4
bad a device that is no name | --devices: 'a/b' is no device | experiment precision --devices native,a/b
bad devices twice | --devices: says what --device says | experiment precision --device native --devices native
bad no shards | empty: holds no shards | merge empty
bad no folder | nowhere | merge nowhere
""", study=STUDY)
