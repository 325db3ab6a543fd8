"""farcull compare: radii, repeats, pairs at risk, CSV and figure; and the pairs at risk of verify."""
import csv
import json
import os
import subprocess

from cli_lab import OUT, case, launch, program, read, rows

FAR = 'mixed --methods far --resolutions 64 --device native'  # a scene with pairs at risk


def answer(*words):
    launch(words)
    return read(OUT)


def table(words):
    return list(csv.DictReader(answer('compare', *words.split(), '--csv', '-').splitlines()))


def missed_at(radius):
    """What another command says: the misses of one run at this radius."""
    return json.loads(answer('run', 'mixed', '--method', 'far', '--resolution', '64', '--device', 'native', '--radius',
                             str(radius), '--json', '-'))['verification']['false_negatives']


def stages(run):
    return [(stage['name'], stage['ran']) for stage in run['stages']]


rows(r"""
each --radius: .*small.* | compare two-spheres --methods far | --radius small | --radius budget,small
bad radii of what has none | --radius: .*methods | compare two-spheres --methods boxes,exact --radius 0.9
bad radii outside compare | --radius: 'budget,0\.9' is no .*; farcull compare takes several | verify two-spheres --method far --radius budget,0.9
bad a figure that is no SVG | --figure: .*\.svg | compare {far} --figure f.png
bad a figure on standard output | --figure: | compare {far} --figure -
bad figure and table in one place | --figure: | compare {far} --figure f.svg --csv f.svg
bad verify of frames without risk | --no-verify: | verify two-spheres --no-verify
0 risk | verify mixed --method far --resolution 64 --device native | ^at risk    [1-9][0-9]* pairs? with 0\.9 of the radius, [1-9]
0 no risk | verify mixed --method far --resolution 64 --device native --no-risk | ! at risk
0 risk of boxes | verify two-spheres | ! at risk
0 risk of cullide | compare two-spheres --methods cullide,boxes --resolutions 16 --device native | ! at risk | ^ms: .*median of 3 runs
0 compared | compare {far} | ^method +px .* at risk +ms +least - most$ | ^far +64 .* [1-9][0-9]* / [1-9][0-9]* +[0-9.]+ +[0-9.]+ - [0-9.]+$
0 repeated | compare {far} --repeat 2 --no-risk | ^ms: .*median of 2 runs | ! at risk
0 radii | compare {far} --radius budget,published,0.9 | ^far +budget +64 | ^far +published | ^far +0\.9 | ^far leaves no stage out here
0 exact is the measure | compare two-spheres --methods boxes,exact | ^x exact: .*lower is faster
""", far=FAR)

# The pairs at risk are those that a run at the smaller radius misses, and rows of such radii say the same.
smaller, bare = missed_at(0.9), missed_at(0)
case('pairs are at risk', 0 < smaller < bare, f'{smaller}, {bare}')
budget, less, none = table(f'{FAR} --radius budget,0.9,0')
case('risk by run', (budget['missed'], budget['at_risk'], budget['at_risk_bare']) == ('0', str(smaller), str(bare)), str(budget))
case('risk by rows', (less['missed'], none['missed']) == (str(smaller), str(bare)), f'{less}, {none}')
case('risk only where promised', less['at_risk'] == none['at_risk_bare'] == '')
verified = json.loads(answer('verify', 'mixed', '--method', 'far', '--resolution', '64', '--device', 'native', '--json', '-'))
case('risk in the record', (verified['at_risk'], verified['at_risk_bare']) == (smaller, bare))

# In a comparison of radii all draw the same stages. The twin: apart they do not.
compared = json.loads(answer(*f'compare crowd --methods far --resolutions 256 --device native --radius budget,published --repeat 1 '
                             '--no-risk --json -'.split()))['runs']
alone = [json.loads(answer(*f'run crowd --method far --resolution 256 --device native --radius {radius} --json -'.split()))
         for radius in ('budget', 'published')]
case('the same stages', stages(compared[0]) == stages(compared[1]), str([stages(run) for run in compared]))
case('other stages apart', stages(alone[0]) != stages(alone[1]), 'the twin draws the same')
case('said', [run['no_shortcuts'] for run in compared + alone] == [True, True, False, False])

everything = table('two-spheres --methods far,cullide,boxes --resolutions 16,32 --offsets obb,exact --repeat 2 --device native')
case('rows of the CSV', [(row['method'], row['offset'], row['resolution']) for row in everything] == [
    ('far', 'obb', '16'), ('far', 'obb', '32'), ('far', 'exact', '16'), ('far', 'exact', '32'), ('cullide', '', '16'),
    ('cullide', '', '32'), ('boxes', '', '')])
case('times of the CSV', all(float(row['least_ms']) <= float(row['ms']) <= float(row['most_ms']) and row['runs'] == '2'
                             for row in everything))

if subprocess.run(['/usr/bin/python3', '-c', 'import pandas, matplotlib'], stderr=subprocess.DEVNULL, check=False).returncode:
    print('note: no figure, since /usr/bin/python3 lacks pandas or matplotlib')
else:
    rows('0 a figure | compare two-spheres --methods far,cullide --resolutions 16,32 --repeat 1 --device native --figure f.svg'
         ' | ^far +16 | @f.svg <title>two-spheres: missed pairs against time | @f.svg cullide 16 px | @f.svg ^ *</?svg | @f.svg far 16 px'
         '\n0 radii in a figure | compare two-spheres --methods far --radius budget,0.5 --resolutions 16 --repeat 1 --device native'
         ' --figure r.svg | @r.svg radius budget 16 px | @r.svg radius 0\\.5 16 px | @r.svg collide; at risk, .* radius: at most [0-9]')
    case('nothing beside the figure', not [name for name in os.listdir() if '.part-' in name], program)
