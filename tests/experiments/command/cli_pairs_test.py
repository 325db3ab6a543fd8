"""boxes, self-collision, clearance and frames; certificates of frames and of clearances; lists of pairs; memory."""
from cli_lab import case, expect, launch, read, rows, write

# ---- bad input

rows(r"""
$ echo older >old.json
good.obj << {T}; f 1 2 3; f 1 2 4; f 1 3 4; f 2 3 4
each {0}: has no meaning .*far | run {pairs} | --resolution 64 | --views x | --device native
bad the old name | --method: .*far-pairs is now called boxes | run two-spheres --method far-pairs
each --clearance: .*boxes | run two-spheres --clearance 0 | --method far | --method cullide
bad cullide with self | --self: .*boxes | run two-spheres --method cullide --self
bad compare cullide with self | --methods: .*boxes | compare two-spheres --methods cullide,exact --self
each {0}: | run {pairs} | --radius 24 | --offset 24 | --depth 24 | --depth-format 24 | --query 24 | --clearance | --frames
each {0}: | verify {pairs} | --clearance 1 --clearance 1 | --frames 1 --frames 1
bad clearance '{clearance}' | --clearance: | run {pairs} --clearance {clearance}
bad compare clearance '{clearance}' | --clearance: | compare two-spheres --clearance {clearance}
bad frames '{frames}' | --frames: | run {pairs} --frames {frames}
bad a value for --self | --self: | run {pairs} --self=7
each --frames: nothing .*%d | run --method boxes --frames 3 | two-tori | good.obj
each {0}: .*%04d | run {pairs} --frames 3 | --certificate c.json | --certificate - | --certificate c_%4d.json
bad certificate with a number and no frames | --certificate: .*--frames | run {pairs} --certificate c_%04d.json
bad certificates in no folder | nowhere/c_0\.json: | run {pairs} --frames 3 --certificate nowhere/c_%d.json
c_2.json << {"objects": [{"mesh": "cloth_%d.obj"}]}
bad a certificate over the scene | --certificate: c_2\.json is c_2\.json, which SCENE reads
  | run c_2.json --method boxes --frames 3 --certificate c_%d.json
$ rm c_2.json
bad a certificate over the list | --certificate: c_1\.json is c_1\.json, where --pairs goes
  | run {pairs} --frames 3 --certificate c_%d.json --pairs c_1.json
cloth_{i}.obj << {T}; f 1 2 3; f 1 2 4
2 a frame that is missing | run {cloth} --frames 3:6 --json missing.json --pairs missing.csv | ^ +5[ ]
  | @err ^farcull: .*cloth_06\.obj: the file does not exist; the frames before it are run$
  | @err ^farcull: .*cloth_06\.obj: the file does not exist; give[ ]
  | @missing.json ^ +"frame": 5, | @missing.json ^    "frames": 3, | @missing.json ^}$ | @missing.csv ^frame,
bad frames from another number | cloth_00\.obj: the file does not exist | run {cloth} --frames 3
bad numbered files without frames | cloth_%02d\.obj: .*; add --frames FIRST:LAST | run cloth_%02d.obj
cloth.json << {"objects": [{"mesh": "cloth_%02d.obj"}]}
bad numbered files of a scene file | .*cloth_%02d\.obj: .*; add --frames | run cloth.json
bad numbered files to compare | cloth_%02d\.obj: .*, or name one file | compare cloth_%02d.obj
really_%d.obj << {T}; f 1 2 3
bad a file with such a name | SCENE: nothing to test: the scene has fewer than two triangles | run really_%d.obj
bad faces without pairs | --faces: .*--pairs | run {pairs} --faces
cloth_05.obj << {T}; f 1 2 3
0 a frame with fewer triangles | run {cloth} --self --frames 3:5 | ^topology  changed 1 time between frames$
cloth_05.obj << v 0 0 nan; v 1 0 0; v 0 1 0; v 0 0 1; f 1 2 3; f 1 2 4
bad a first frame that is no mesh | cloth_05\.obj:1: | run {cloth} --frames 5:5 --json old.json --pairs new.csv
self.json << {"objects": [{"mesh": "good.obj", "self": true}, {"mesh": "good.obj"}]}
bad cullide on a scene that collides with itself | self: cullide tests no object .*boxes | run self.json --method cullide
bad compare cullide on one | --methods: cullide tests no object .*boxes | compare self.json --methods cullide,exact
""", pairs='two-spheres --method boxes', cloth='cloth_%02d.obj --method boxes',
     clearance=['-1', '-1e-300', 'nan', 'inf', '1e999', '', '1x', ' 1', '0x1p3'],
     frames=['0', '-1', '1.5', '', 'a', '3:2', '-1:2', '1:', ':2', '1:2:3', '1000001', '0:1000000', ' 1', '1-3',
             '99999999999999999999', '9223372036854775807:9223372036854775807', '1000000001:1000000001'],
     i=['03', '04', '05'])

# ---- good cases

rows(r"""
0 boxes | run {pairs} | ^device     none: the method draws nothing$ | [ ]\+ 0 missed$ | ^colliding  298 pairs$
  | ^method     boxes; promises to miss nothing$
0 a clearance of 0 | run {pairs} --clearance 0 --pairs - >plain.csv
0 boxes without | run {pairs} --pairs - | $ cmp -s "$out" plain.csv
0 exact pairs | run two-spheres --method exact --pairs - | $ cmp -s "$out" plain.csv
0 boxes as JSON | run {pairs} --json - | ^ *"method": "boxes"
  | ^ *"resolution": null | ^ *"clearance": 0\.0 | ^ *"promises": true | ^ *"neighbour_pairs": 0
  | ^ *"none": "the method draws nothing" | ^ *"self_objects": 0
folded.obj << {T}; v 1 1 -1; v 1 1 1; v 0 0 -1; f 1 2 3; f 1 2 4; f 5 6 7
0 self-collision | verify folded.obj --method boxes --self --pairs - | ^0,0,0,2,0$
  | ^object_a,triangle_a,object_b,triangle_b,neighbours$
0 self-collision by exact | verify folded.obj --method exact --self
  | ^colliding  1 pair = 1 \+ 0 of neighbours; 1 candidate is of neighbours$
# Faces of the file: a square and a concave hexagon, six triangles of two faces, and a blade.
faces.obj << v 0 0 0; v 1 0 0; v 1 1 0; v 0 1 0; v 2 0 0; v 4 0 0; v 4 1 0; v 3 0.2 0; v 2.5 1 0; v 2 1 0
  ; f 1 2 3 4; f 5 6 7 8 9 10
blade.obj << v 0.1 0.6 -1; v 0.1 0.6 1; v 0.1 0.7 0; v 2.1 0.6 -1; v 2.1 0.6 1; v 2.1 0.7 0; f 1 2 3; f 4 5 6
0 faces | run faces.obj blade.obj --pairs faces.csv --faces | @faces.csv ^0,1,1,0,0,0$
  | @faces.csv #0 ^object_a,triangle_a,object_b,triangle_b,face_a,face_b$ | @faces.csv ^0,[2-5],1,1,1,1$
0 without faces | run faces.obj blade.obj --pairs unnamed.csv | $ cmp -s unnamed.csv <(cut -d, -f1-4 faces.csv)
0 faces of self-collision | run faces.obj blade.obj --self --pairs - --faces | ^0,1,1,0,0,0,0$
  | ^object_a,triangle_a,object_b,triangle_b,neighbours,face_a,face_b$
0 faces of frames | run two-spheres --frames 1 --pairs - --faces | ^0,0,([0-9]+),1,([0-9]+),\1,\2$
  | ^frame,object_a,triangle_a,object_b,triangle_b,face_a,face_b$
0 certificate of self-collision | run folded.obj --method boxes --self --certificate c.json
0 check of it | check c.json folded.obj --self | ^proved:
1 check of it without --self | check c.json folded.obj | ^not proved: the certificate is of another scene
bad no self-collision | SCENE: nothing to test: .*only with --self | verify folded.obj --method boxes
0 scene that collides with itself | verify self.json --method boxes
0 compare with self | compare folded.obj --self --clearance 0.5 | ^boxes +- +- | ^method .* colliding  \+ neighbours[ ]
# Frames: a triangle that falls through another.
fall_1.obj << v 0.1 0.1 -1.5; v 0.9 0.1 -1.5; v 0.1 0.1 -1.1; f 1 2 3
fall_2.obj << v 0.1 0.1 0.5; v 0.9 0.1 0.5; v 0.1 0.1 0.1; f 1 2 3
fall_3.obj << v 0.1 0.1 1.5; v 0.9 0.1 1.5; v 0.1 0.1 1.1; f 1 2 3
0 frames | verify fall_%d.obj good.obj --method boxes --frames 1:3 --json - --pairs falls.csv
  | ^ *"frame": 3 | ^ *"read": | ^ *"median": | ^ *"p95": | ^ *"max": | ^ *"frames": 3 | ^ *"missed": 0
  | @falls.csv ^frame,object_a,triangle_a,object_b,triangle_b$ | @falls.csv ^2,0,0,1,3$
fall.json << {"objects": [{"mesh": "fall_%d.obj", "self": true}, {"mesh": "good.obj"}]}
0 frames of a scene file | run fall.json --method exact --frames 1:3 --no-verify
  | ^frame +candidates +colliding +\+ neighbours +cull ms | ^per frame  median[ ]
0 frames of a built-in scene | verify two-spheres@far@ground --method boxes --frames 3
  | ^ +2 .* 0 +[0-9.]+ +[0-9.]+ +[0-9.]+ +[0-9,]+ +[0-9,]+$
0 frames of one number | run crowd --method boxes --frames 1
""", pairs='two-spheres --method boxes')

# ---- certificates of frames and of clearances, and lists without a certificate

rows(r"""
$ mkdir certificates
0 certificates of frames | run fall.json --method exact --frames 1:3 --no-verify
  --certificate certificates/c_%02d.json --pairs falls.csv
  | $ [[ $(cd certificates && echo *) == 'c_01.json c_02.json c_03.json' ]]
0 check of frames | check certificates/c_%02d.json fall.json --frames 1:3 --pairs falls.csv
  | ^proved: in each of 3 frames these pairs of the scene meet, and no others: 1 in all$ | ^ +2  proved +[0-9]+ +1 +[0-9.]+$
0 a list of frames alone | check fall.json --frames 1:3 --pairs falls.csv | ^proved: in each of 3 frames[ ] | ^ +3  proved[ ]
$ sed '2d' falls.csv >fewer.csv
1 a list that lacks a pair of a frame | check fall.json --frames 1:3 --pairs fewer.csv
  | ^refuted: 1 of 3 frames, the first is frame 2$ | ^  pair: fall_%d triangle 0 and good triangle 3$
  | ^ +refuted: fewer\.csv is not the list of the pairs: a pair is missing$
$ cp certificates/c_01.json certificates/c_02.json
1 the certificate of another frame | check certificates/c_%02d.json fall.json --frames 1:3
  | ^not proved: 1 of 3 frames, the first is frame 2$ | not proved: the certificate is of another scene: hash
bad certificates of frames without frames | CERTIFICATE: .*--frames | check certificates/c_%02d.json fall.json
bad frames of one certificate | CERTIFICATE: .*%04d | check certificates/c_01.json fall.json --frames 1:3
bad the proved checker for frames | --verified: is for certificates of one scene | check certificates/c_%02d.json fall.json --frames 1:3 --verified
bad a list of frames without frames | falls\.csv: has a column .*--frames | check fall.json --pairs falls.csv
bad a list of other frames | falls\.csv:2: frame 2[ ] | check fall.json --frames 1:1 --pairs falls.csv
$ rm certificates/c_03.json
2 a certificate that is missing | check certificates/c_%02d.json fall.json --frames 1:3 | ^ +1  proved[ ]
  | @err ^farcull: certificates/c_03\.json: the file does not .*; give[ ]
$ mkdir partly && cp certificates/c_01.json partly/c_1.json
2 nothing is proved of all frames then | check partly/c_%d.json fall.json --frames 1:3 --json v.json | ^ +1  proved[ ]
  | @err does not | @v.json "verdict": "not proved"
# Certificates of two questions are not one answer. The first one's is the question.
0 certificates of a clearance | run {move} --frames 2 --clearance 0.2 --certificate near_%d.json
0 certificates of meeting | run {move} --frames 2 --certificate meet_%d.json
$ cp near_0.json mixed_0.json && cp meet_1.json mixed_1.json
1 certificates of two questions | check mixed_%d.json two-spheres --frames 2
  | ^not proved: 1 of 2 frames, the first is frame 1$ | not proved: the certificate is of another clearance: 0, not 0\.2$
0 certificates of one question | check near_%d.json two-spheres --frames 2
  | ^proved: in each of 2 frames these pairs are at distance 0\.2 or less
# A built-in motion goes to its last frame, so that its end can be run by itself.
$ rm meet_1.json
2 a frame of a motion that is missing | check meet_%d.json two-spheres --frames 2
  | @err ^farcull: .*; make it with farcull run --certificate --frames 1:1$
0 the last frame alone | run {move} --frames 1:1 --certificate meet_%d.json
0 certificates of two runs | check meet_%d.json two-spheres --frames 2 | ^proved: in each of 2 frames[ ]
# At 0.1, as at every decimal fraction, the clearance is the double nearest to it.
0 a certificate of a clearance | run {move} --clearance 0.1 --certificate near.json --pairs near.csv
  | @near.json ^  "version": 4,$ | @near.json ^  "clearance": 0\.1,$
0 check of a clearance | check near.json two-spheres --pairs near.csv
  | ^proved: these [0-9,]+ pairs of the scene are at distance 0\.1 or less, and no others$
0 with the clearance | check near.json two-spheres --clearance 0.1 | ^proved:
1 with another clearance | check near.json two-spheres --clearance 0.2
  | ^not proved: the certificate is of another clearance: 0\.1, not 0\.2$
0 the list of a clearance alone | check two-spheres --pairs near.csv --clearance 0.1
  | ^proved: these [0-9,]+ pairs of the scene are at distance[ ]
1 without the clearance | check two-spheres --pairs near.csv
  | ^refuted: near\.csv is not the list of the pairs: line [0-9]+: the pair is disjoint$
$ sed 's/"clearance": 0\.1/"clearance": 0.2/' near.json >farther.json
1 a larger clearance in the file | check farther.json two-spheres
# Lists that others wrote.
0 a list alone | check two-spheres --pairs plain.csv | ^proved: these 298 pairs of the scene meet, and no others$
""", move='two-spheres --method boxes')

header, *lines = read('plain.csv').splitlines()
parts = [line.split(',') for line in lines]
write('other.csv', 'triangle_b,name,object_b,triangle_a,object_a\n' +
      ''.join(f'{d},"x, y",{c},{b},{a}\r\n' for a, b, c, d in reversed(parts)))
write('fewer.csv', '\n'.join([header, *lines[:98], *lines[99:], '']))
write('broken.csv', '\n'.join([header, lines[0], ','.join([*parts[1][:3], 'x']), *lines[2:], '']))
rows(r"""
0 a list in another form | check two-spheres --pairs other.csv | ^ +other\.csv is this list: 298 rows$
  | not looked at: columns name$
1 a list that lacks a pair | check two-spheres --pairs fewer.csv | ^  pair: .* triangle {a} and .* triangle {b}$
  | ^refuted: fewer\.csv is not the list of the pairs: a pair is missing$
0 self-collision | run folded.obj --method boxes --self --pairs folded.csv
0 a list of self-collision | check folded.obj --pairs folded.csv --self | ^proved: this pair of the scene meets, and no other$
1 and without --self | check folded.obj --pairs folded.csv | ^refuted: .*line 2: .*\(--self asks\)$
0 two meshes | run good.obj folded.obj --method exact --pairs two.csv
0 a list of two meshes | check good.obj folded.obj --pairs two.csv | ^proved: these [0-9]+ pairs[ ]
bad a list that is no list | broken\.csv:3: triangle_b is 'x', .*; give a list as[ ] | check two-spheres --pairs broken.csv
bad a list of another scene | plain\.csv:[0-9]+: object 0 has no triangle .*; give[ ]
  | check good.obj good.obj --pairs plain.csv
bad neither certificate nor list | SCENE: is missing[ ] | check two-spheres
bad a mesh for the certificate | CERTIFICATE: .*--pairs | check good.obj folded.obj
bad a bad clearance | --clearance: | check two-spheres --pairs plain.csv --clearance -1
bad bad frames | --frames: | check two-spheres --pairs plain.csv --frames 0
""", a=parts[98][1], b=parts[98][3])

# ---- memory

# Triangles that lie on each other: memory for the pairs that there are, not for each pixel of each.
for name in 'first.obj', 'second.obj':
    write(name, 'v 0 0 0\nv 1 0 0.3\nv 0 1 0.2\n' + 'f 1 2 3\n' * 1200)
rows("""
0 coincident triangles | run first.obj second.obj --no-verify | ^colliding  1,440,000 pairs$
""", limits={'memory': 400_000})


def memory_is_named():
    """Where memory is the cause, the message says so. A limit too small for the libraries that the program is linked
    with is theirs to report: the loader's (status 127), or that of a library which takes memory before main(), as
    octomap under FCL does. Then not even --version works. And a driver may crash under it (docs/reliability.md)."""
    least_started = 0
    for limit in 75_000, 80_000, 100_000, 150_000, 200_000, 300_000, 350_000, 400_000:
        if launch(['--version'], memory=limit) != 0:
            continue
        least_started = least_started or limit
        for method in 'boxes', 'far', 'exact':
            name = f'{method} in {limit} KiB'
            status = launch(['run', 'two-spheres', '--method', *method.split()], memory=limit)
            if case(name, status in (0, 2, 127), f'status {status}') and status == 2:
                expect(name, '@err ^farcull: .*memory.*; .*memory')
    case('limits on memory', 0 < least_started <= 150_000, f'the program starts with {least_started} KiB (0: never)')


memory_is_named()
