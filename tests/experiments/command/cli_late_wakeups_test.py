"""Mesa's llvmpipe where every thread but the first one waits a moment before it wakes those that wait for a fence
(docs/drivers.md). Without threads of llvmpipe, which is what the program asks for, answers are those of any other run. The
twin has one such thread; it touches a fence that was freed, which ends the process with status 66, or waits for ever.
   cli_late_wakeups_test.py FARCULL LIBRARY, which is tests/core/gl/late_wakeups.cpp
Exit status 77: the device is not llvmpipe."""
import re
import sys

from cli_lab import case, launch, others, read, rows

RUN = 'run two-spheres --device software --no-verify --method'
launch([*RUN.split(), 'far'])  # which says that it probes the device, if it is the first run
rows('0 far | {run} far --pairs pairs.csv --json r.json', run=RUN)
renderer = re.search('"renderer": "(.*)"', read('r.json'))
if not renderer or 'llvmpipe' not in renderer[1]:
    print('late wakeups: not run: the software device is', renderer and renderer[1])
    sys.exit(77)
rows(r"""
$ grep -q '^ *"threads": 0' r.json
0 far, late | LD_PRELOAD={library} {run} far --pairs late.csv --json late.json
  | $ cmp -s pairs.csv late.csv | @late.json ^ *"promises": true
""", run=RUN, library=others[0])

# On a busy machine a draw may take longer than the moment, so that a run goes well. Then the moment becomes longer.
for microseconds in 3_000, 10_000, 30_000, 100_000, 300_000:
    status = launch([f'LD_PRELOAD={others[0]}', f'FARCULL_LATE={microseconds}', 'LP_NUM_THREADS=1', *RUN.split(), 'far'])
    if status in (66, 124):
        break
case('far, late, with a thread', status in (66, 124), f'ended each time with status {status}')
