"""Studies: interrupted and resumed, and in shards. store_test.cpp kills them and fills the disk, and has stores that are refused;
merge_test.cpp has shards that are."""
import contextlib
import os
import signal
import sqlite3
import time

from cli_lab import case, ended, expect, good, rows, start

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


measure('whole', 'whole', '^precision +[0-9]', '^results: whole/results.sqlite$')
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


def shards():
    for shard in 3, 2, 1:
        measure('shards', f'shards --shard {shard}/4')
    rows('bad a shard is missing | shard 4/4: of precision is missing | merge shards')
    measure('shards', 'shards --shard 4/4')
    rows(r"""
0 merge | merge shards | ^{points} rows of 1 study from 4 shards: shards/results.sqlite$
""", points=str(points))
    same('shards', 'shards')


for step in devices, interrupted, shards:
    step()

rows(r"""
# A folder that SQLite would take for something else than a folder.
0 a folder with a colon | {study} 'file:x?mode=memory&q=' --shard 1/1000
  | $ [[ -e 'file:x?mode=memory&q=/results-1-of-1000.sqlite' ]]
# What is refused.
$ mkdir empty
bad no such study | acuracy: no such command | experiment acuracy
bad no study | experiment: no study is named; name one: all, headline, scenes | experiment
bad seed 0 | --seed: 0 is out of range | experiment precision --seed 0
bad a shard that is none | --shard: '5/4' is no shard | experiment precision --shard 5/4
bad a device that is no name | --devices: 'a/b' is no device | experiment precision --devices native,a/b
bad devices twice | --devices: says what --device says | experiment precision --device native --devices native
bad no shards | empty: holds no shards | merge empty
""", study=STUDY)
