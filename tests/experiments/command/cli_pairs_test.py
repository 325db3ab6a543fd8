"""boxes, self-collision, clearance and frames; certificates of frames and of clearances; lists of pairs; memory."""
from cli_lab import case, expect, launch, rows, write

rows(r"""
$ echo older >old.json
good.obj << {T}; f 1 2 3; f 1 2 4; f 1 3 4; f 2 3 4
bad an option of drawing | --views: has no meaning .*far | run {pairs} --views x
bad the old name | --method: .*far-pairs is now called boxes | run two-spheres --method far-pairs
bad cullide with self | --self: .*boxes | run two-spheres --method cullide --self
bad clearance '{clearance}' | --clearance: | run {pairs} --clearance {clearance}
bad frames '{frames}' | --frames: | run {pairs} --frames {frames}
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
  | @err ^farcull: .*cloth_06\.obj: the file does not exist; give numbers that there are: --frames 3:5 instead of 3:6$
  | @missing.json ^ +"frame": 5, | @missing.json ^    "frames": 3, | @missing.json ^}$ | @missing.csv ^frame,
bad frames from another number | cloth_00\.obj: the file does not exist; give numbers that there are: --frames 3:5 instead of 0:2$
  | run {cloth} --frames 3
bad frames of no file | absent_0\.obj: the file does not exist; give numbers that there are$ | run absent_%d.obj --frames 3
bad numbered files without frames | cloth_%02d\.obj: .*; add --frames FIRST:LAST | run cloth_%02d.obj
cloth.json << {"objects": [{"mesh": "cloth_%02d.obj"}]}
bad numbered files of a scene file | .*cloth_%02d\.obj: .*; add --frames | run cloth.json
bad faces without pairs | --faces: .*--pairs | run {pairs} --faces
cloth_05.obj << {T}; f 1 2 3
0 a frame with fewer triangles | run {cloth} --self --frames 3:5 | ^topology  changed 1 time between frames$
cloth_05.obj << v 0 0 nan; v 1 0 0; v 0 1 0; v 0 0 1; f 1 2 3; f 1 2 4
bad a first frame that is no mesh | cloth_05\.obj:1: | run {cloth} --frames 5:5 --json old.json --pairs new.csv
self.json << {"objects": [{"mesh": "good.obj", "self": true}, {"mesh": "good.obj"}]}

0 boxes | run {pairs} | ^device     none needed: the method draws nothing$ | [ ]\+ 0 missed$ | ^colliding  298 pairs$
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
# Faces of the file: a square and a concave hexagon, six triangles of two faces, and a blade.
faces.obj << v 0 0 0; v 1 0 0; v 1 1 0; v 0 1 0; v 2 0 0; v 4 0 0; v 4 1 0; v 3 0.2 0; v 2.5 1 0; v 2 1 0
  ; f 1 2 3 4; f 5 6 7 8 9 10
blade.obj << v 0.1 0.6 -1; v 0.1 0.6 1; v 0.1 0.7 0; v 2.1 0.6 -1; v 2.1 0.6 1; v 2.1 0.7 0; f 1 2 3; f 4 5 6
0 faces | run faces.obj blade.obj --pairs faces.csv --faces | @faces.csv ^0,1,1,0,0,0$
  | @faces.csv #0 ^object_a,triangle_a,object_b,triangle_b,face_a,face_b$ | @faces.csv ^0,[2-5],1,1,1,1$
0 faces of frames | run two-spheres --frames 1 --pairs - --faces | ^0,0,([0-9]+),1,([0-9]+),\1,\2$
  | ^frame,object_a,triangle_a,object_b,triangle_b,face_a,face_b$
0 certificate of self-collision | run folded.obj --method boxes --self --certificate c.json
0 check of it | check c.json folded.obj --self | ^proved:
1 check of it without --self | check c.json folded.obj | ^not proved: the certificate is of another scene
# Meshes in another order are named in that of the certificate. The twin: another mesh.
0 of three | run faces.obj blade.obj folded.obj --method boxes --certificate o.json
1 in another order | check o.json folded.obj faces.obj blade.obj | are in another order: give faces\.obj blade\.obj$
  | ^folded\.obj$
1 of another mesh | check o.json folded.obj faces.obj folded.obj | ^not proved: .* another scene | ! another order
0 scene that collides with itself | verify self.json --method boxes
0 compare with self | compare folded.obj --self --clearance 0.5 | ^boxes +-[ ] | ^method .* colliding \+ neighbours[ ]
# Frames: a triangle that falls through another. frames_test.cpp has the answers.
fall_1.obj << v 0.1 0.1 -1.5; v 0.9 0.1 -1.5; v 0.1 0.1 -1.1; f 1 2 3
fall_2.obj << v 0.1 0.1 0.5; v 0.9 0.1 0.5; v 0.1 0.1 0.1; f 1 2 3
fall_3.obj << v 0.1 0.1 1.5; v 0.9 0.1 1.5; v 0.1 0.1 1.1; f 1 2 3
fall.json << {"objects": [{"mesh": "fall_%d.obj", "self": true}, {"mesh": "good.obj"}]}
0 frames of a scene file | run fall.json --method exact --frames 1:3 --no-verify
  | ^frame +candidates +colliding +\+ neighbours +cull ms | ^per frame  median[ ]
0 frames of a built-in scene | verify two-spheres@far@ground --method boxes --frames 3
  | ^ +2 .* 0 +[0-9.]+ +[0-9.]+ +[0-9.]+ +[0-9,]+ +[0-9,]+$

# Certificates of frames. check_test.cpp has those of clearances, and lists without a certificate.
$ mkdir certificates
0 certificates of frames | run fall.json --method exact --frames 1:3 --no-verify
  --certificate certificates/c_%02d.json --pairs falls.csv
  | $ [[ $(cd certificates && echo *) == 'c_01.json c_02.json c_03.json' ]]
0 the scene before its certificates | check fall.json certificates/c_%02d.json --frames 1:3 | ^proved: in each of 3 frames
0 check of frames | check certificates/c_%02d.json fall.json --frames 1:3 --pairs falls.csv
  | ^proved: in each of 3 frames these pairs of the scene meet, and no others: 1 in all$ | ^ +2  proved +[0-9]+ +1 +[0-9.]+$
bad certificates of frames without frames | CERTIFICATE: .*--frames | check certificates/c_%02d.json fall.json
bad neither certificate nor list | SCENE: is missing[ ] | check two-spheres
bad a mesh for the certificate | CERTIFICATE: .*--pairs | check good.obj folded.obj
""", pairs='two-spheres --method boxes', cloth='cloth_%02d.obj --method boxes', clearance=['-1', 'nan', ''],
     frames=['0', '1.5', '', '3:2', '1:', '1:2:3', '1000001', '99999999999999999999'], i=['03', '04', '05'])

# Triangles that lie on each other: memory for the pairs that there are, not for each pixel of each.
for name in 'first.obj', 'second.obj':
    write(name, 'v 0 0 0\nv 1 0 0.3\nv 0 1 0.2\n' + 'f 1 2 3\n' * 1200)
rows("""
0 coincident triangles | run first.obj second.obj --no-verify | ^colliding  1,440,000 pairs$
""", limits={'memory': 400_000})

# Where memory is the cause, the message says so. A limit too small for the libraries that the program is linked with is
# theirs to report: the loader's (status 127), or that of a library which takes memory before main(), as octomap under FCL
# does. Then not even --version works. And a driver may crash under it (docs/reliability.md).
least_started = 0
for limit in 75_000, 80_000, 100_000, 150_000, 200_000, 300_000, 350_000, 400_000:
    if launch(['--version'], memory=limit) != 0:
        continue
    least_started = least_started or limit
    for method in 'boxes', 'far', 'exact':
        name = f'{method} in {limit} KiB'
        status = launch(['run', 'two-spheres', '--method', method], memory=limit)
        if case(name, status in (0, 2, 127), f'status {status}') and status == 2:
            expect(name, '@err ^farcull: .*memory.*; .*memory')
case('limits on memory', 0 < least_started <= 150_000, f'the program starts with {least_started} KiB (0: never)')
