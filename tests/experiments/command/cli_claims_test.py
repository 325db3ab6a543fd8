"""What the program claims and what it may overwrite: a certificate says no more than it proves and is bound to the
list of pairs; what was not asked is said; no output is an input."""
import hashlib
import os
import shutil

from cli_lab import program, read, rows, write

# A run that misses pairs, and the truth.
rows(r"""
0 a run that misses | run {missing} --certificate c.json --pairs missed.csv | \+ [1-9][0-9,]* missed$
0 the pairs | run two-spheres --method exact --certificate exact.json --pairs pairs.csv
""", missing='two-spheres --method quick-cullide --device software --resolution 16')
sha, missed = (hashlib.sha256(read(name).encode()).hexdigest() for name in ('pairs.csv', 'missed.csv'))

rows(r"""
$ grep -qx '  "list_sha256": "{sha}",' exact.json
$ grep -qx '  "list_sha256": "{missed}",' c.json
0 a certificate of exact | check exact.json two-spheres --pairs pairs.csv
  | #0 ^proved: these [0-9,]+ pairs of the scene meet, and no others$ | ^list       {sha} 
  | pairs\.csv is this list: [0-9,]+ rows$ | about the scene and not about the run | ^  which pairs the run kept | ns per pair
0 the scene first | check two-spheres exact.json | #0 ^proved: these 298 pairs
1 another list | check exact.json two-spheres --pairs missed.csv
  | #0 ^not proved: missed\.csv is another list: a pair is missing$
1 a certificate of a run that misses | check c.json two-spheres | #0 ^refuted: the pair is called culled, and it meets$
$ sed 's/"method": "[^"]*"/"method": "far\\nproved: all"/' exact.json >lies.json
0 a certificate that prints a verdict | check lies.json two-spheres | #0 ^proved: these | ! ^proved: all
  | ^  that the method was far.proved: all$
bad a list that is not there | nothing\.csv: | check exact.json two-spheres --pairs nothing.csv
bad the proved checker for a list | --verified: does not read the list of --pairs | check exact.json two-spheres --pairs pairs.csv --verified
bad a certificate from standard input | CERTIFICATE: is not read from standard input; name a file | check - two-spheres --verified
bad an empty name of a list | --pairs: | check exact.json two-spheres --pairs ''
$ sed 's/"version": 3/"version": 2/' exact.json >older.json
bad a certificate of another version | older\.json: version is not 3, 4 or 5 | check older.json two-spheres
""", sha=sha, missed=missed)

# Another program in the place of the proved checker: it proves nothing unless it says what it read, and its verdict.
os.mkdir('fake')
shutil.copy(program, 'fake/farcull')
certificate, scene = (f'echo "verified   {name} sha256 $(sha256sum <"${k}" | cut -c1-64)"'
                      for name, k in (('certificate', 1), ('scene      ', 2)))
proved, wrong = 'echo "verified   proved: all"', scene.replace('cut', 'tr 0-9 1-90 | cut')
for lines, why in (([], 'does not say that it read'), ([certificate, proved], 'does not say that it read'),
                   ([certificate, wrong, proved], 'does not say that it read'), ([scene, proved, certificate], 'is not that of its verdict'),
                   ([certificate, scene, proved, 'exit 1'], 'is not that of its verdict'), ([certificate, scene, proved], '')):
    write('fake/farcull-check-verified', '\n'.join(['#!/bin/sh', *lines]) + '\n')
    os.chmod('fake/farcull-check-verified', 0o755)
    asked = 'fake/farcull check exact.json two-spheres --verified >said 2>why'
    rows('$ ! {asked} && grep -q "farcull-check-verified: .*{why}" why' if why else '$ {asked} && test ! -s why', asked=asked, why=why)

# What was not asked: two triangles of one object that pierce each other.
rows(r"""
pierced.obj << {T}; v 0.2 0.2 -1; v 0.2 0.2 1; v 0.3 0.6 1; f 1 2 3; f 5 6 7
good.obj << {T}; f 1 2 3
away.obj << v 50 0 0; v 51 0 0; v 50 1 0; f 1 2 3
0 run | run pierced.obj away.obj --method boxes --certificate p.json --json r.json | {unasked} | ^not asked .*\(add --self\)$
  | promises to miss nothing$ | @r.json ~ "self_not_asked":\{"objects":2,"pairs":1,"which":\[\[0,1\]\]\}
  | @p.json ~ "not_asked":\{"objects":2,"pairs":1\}
# One object leaves nothing to test. That is an error that names the command which tests it.
bad nothing for {command} | SCENE: nothing to test: the scene is one object, and an object is tested .* only with --self; .*test this one: farcull {command} pierced\.obj --self$ | {command} pierced.obj
bad nothing for compare | SCENE: nothing to test.*: farcull compare pierced\.obj --self$ | compare pierced.obj --methods boxes,exact
bad nothing for cullide | SCENE: .*: farcull run pierced\.obj --method boxes --self$ | run pierced.obj --method cullide --device software --resolution 64
one.json << {"objects": [{"mesh": "pierced.obj"}]}
bad nothing in a scene file | SCENE: .*: farcull verify one\.json --self$ | verify one.json
0 something for verify | verify pierced.obj --self --json something.json | ! nothing to test
  | ^verified: no colliding pair was culled, 1 pair accounted for$ | @something.json ^    "nothing_to_test": null,$
one.json << {"objects": [{"mesh": "pierced.obj", "self": true}]}
0 something in a scene file | verify one.json | ^verified:
bad all ignored for {command} | SCENE: nothing to test: every pair of objects is ignored; ignore fewer pairs | {command} pierced.obj good.obj --ignore pierced:good
0 bench with ignored objects | bench pierced.obj away.obj good.obj --ignore pierced:good --device cpu --repeat 1 --peers cgal-boxes --json - | "disagreement": null
0 ignored, with self | run pierced.obj good.obj --ignore pierced:good --self | ^colliding +1 pair
0 two objects | verify pierced.obj good.obj | ^verified:
0 check | check p.json pierced.obj away.obj | #0 ^proved: no pair of the scene meets$ | {unasked}
$ cp pierced.obj pierced0.obj
0 frames | run pierced%d.obj away.obj --method boxes --frames 1 | ^not asked +1 pair of triangles inside pierced
0 plan | plan pierced.obj away.obj --method boxes
  | ^not asked  1 pair of triangles inside pierced,
0 asked | run pierced.obj --method boxes --self --certificate s.json --pairs s.csv | ^colliding +1 pair[ ] | ! not asked
0 check of it | check s.json pierced.obj --self --pairs s.csv | #0 ^proved: this pair of the scene meets, and no other$
""", command=['run', 'verify', 'plan'],
     unasked=r'^not asked +1 pair of triangles inside pierced, away \(')

rows(r"""
$ mkdir -p sub meshes results/report && : >results/report/results.sqlite
sub/good.obj << {T}; f 1 2 3
frame_7.obj << {T}; f 1 2 4
meshes/armadillo.off << {T}; f 1 2 3
s.json << {"objects": [{"mesh": "sub/good.obj"}, {"mesh": "{PWD}/frame_7.obj"}]}
moving.json << {"objects": [{"mesh": "frame_%d.obj"}]}
$ ln -s s.json link.json && ln s.json hard.json && ln -s sub/good.obj mesh_link.json && ln frame_7.obj mesh_hard.csv
$ ln -s meshes/armadillo.off packaged.json && ln -s nowhere.json dangling.json
$ ln -s report/results.sqlite results/results.sqlite
bad {command} --json {scene} | --json: .* SCENE .*; choose another place for --json | {command} s.json --json {scene}
bad {judge} {option} {scene} | {option}: .* SCENE[ ] | {judge} s.json {option} {scene}
bad picture -o {scene} | -o: .* SCENE[ ] | picture s.json -o {scene}
bad {reader} over a mesh of the scene file by {mesh} | --json: .*obj, which SCENE reads | {*reader} s.json --json {mesh}
bad picture over a mesh by {mesh} | -o: .*obj, which SCENE reads | picture s.json -o {mesh}
bad run --pairs over a mesh by {mesh} | --pairs: .*obj, which SCENE reads | run sub/good.obj frame_7.obj --pairs {mesh}
bad a numbered mesh | --json: mesh_hard\.csv is frame_7\.obj, which SCENE
  | run frame_%d.obj sub/good.obj {moving} --json mesh_hard.csv
bad a numbered mesh of a scene file | --pairs: mesh_hard\.csv is frame_7\.obj, which SCENE
  | verify moving.json {moving} --pairs mesh_hard.csv
$ cp exact.json kept.json
bad check --json {exact} | --json: .*CERTIFICATE reads | check exact.json two-spheres --json {exact}
bad check over the list | --json: pairs\.csv is pairs\.csv, which --pairs reads
  | check exact.json two-spheres --pairs pairs.csv --json pairs.csv
bad check over the scene | --json: .* SCENE[ ] | check exact.json s.json --json link.json
bad a packaged mesh | --json: packaged\.json is .*armadillo\.off, which SCENE | {meshes} run near-copy --json packaged.json
bad a scene over the meshes that it is made of | --write: .*armadillo\.off, which SCENE reads
  | {meshes} scenes armadillo --write meshes
bad results in the report | results/results\.sqlite: leads into DIR/report | report results
# Two outputs that are one file. A link to a file that is not there counts as that file; so does a link to such a
# link. Standard output is one as well.
$ ln -s "$PWD/sub/../dangling.json" chain.json
each --pairs: .*where --json goes as well | run two-spheres | --json new.csv --pairs {other}
each --pairs: .*where --json goes as well | run two-spheres | --json dangling.json --pairs nowhere.json
  | --json nowhere.json --pairs dangling.json
each --certificate: .*where --json goes as well | run two-spheres --certificate | link.json --json hard.json
  | dangling.json --json chain.json
bad the table into the scene | standard output: .* SCENE[ ] | run s.json --method exact >>s.json
$ touch both.txt
bad the table and the record into one file | --json: .*where standard output goes as well
  | run s.json --method exact --json both.txt >>both.txt
# What is allowed stays so.
0 another file | run s.json --method exact --json kept.json --pairs pairs.csv
0 a link to nowhere, and another file | run s.json --method exact --json dangling.json --pairs elsewhere.csv
0 the same device twice | run s.json --method exact --json /dev/null --pairs /dev/null
0 the same device as stdout | run s.json --method exact --json /dev/null >/dev/null
0 frames that are not read | run frame_%d.obj sub/good.obj --method boxes --frames 7:7 --json kept.json
""", command=['run', 'verify', 'plan', 'compare', 'bench'], judge=['run', 'verify'], option=['--pairs', '--certificate'],
     scene=['s.json', '{PWD}/s.json', 'sub/../s.json', 'link.json', 'hard.json'],
     reader=['run', 'verify', 'plan', 'compare', 'bench'], mesh=['mesh_link.json', 'mesh_hard.csv'],
     moving='--method boxes --frames 7:7', exact=['exact.json', './exact.json'], meshes='FARCULL_MESHES={PWD}/meshes',
     other=['new.csv', './new.csv', '{PWD}/new.csv', 'sub/../new.csv'])
