"""farcull distance: bad input, and what it answers."""
from cli_lab import rows, write

VALUES = {'open': 'v -5 -5 -5; v 29 -5 -5; v -5 29 -5; v -5 -5 29; f 1 3 2; f 1 2 4; f 2 3 4',
          'two': 'distance small.obj right.obj', 'three': 'distance small.obj right.obj large.obj'}

write('many.obj', ''.join(f'o o{i}\nv {i} 0 0\nv {i} 1 0\nv {i} 0 1\nf -3 -2 -1\n' for i in range(5794)))
rows(r"""
$ echo older >old.json
small.obj << {T}; f 1 2 3; f 1 2 4; f 1 3 4; f 2 3 4
open.obj << {open}
large.obj << {open}; f 3 1 4
right.obj << v 2 0 0; v 3 0 0; v 2 1 0; f 1 2 3
bad no scene | SCENE: none is named | distance
bad one object | SCENE: only one object .*farcull distance small\.obj --self | distance small.obj
bad no such pairs | --pairs: 'some' is no choice; give objects, nearest or all | {two} --pairs some
bad all without a distance | --within: is missing | {two} --pairs all
bad within '{within}' | --within: | {two} --within {within}
bad k 0 | --k: | {two} --pairs nearest --k 0
bad k of objects | --k: has no meaning without --pairs nearest | {two} --k 2
bad nearest and self | --self: has no meaning with --pairs nearest | {two} --pairs nearest --self
bad inside maybe | --inside: .*give yes or no | {two} --inside maybe
bad nearest of ignored objects | [^:]*: the scene ignores .* nearest objects .*; leave ignore out | {three} --ignore small:right --pairs nearest
bad no such name | --ignore: .*none | {two} --ignore small:none
bad no such option | --clearance: farcull distance has no such option | {two} --clearance 1
bad no such file | none\.obj: | distance small.obj none.obj --json old.json
each {0}: | {two} | --inside yes --pairs all --within 1 | --csv right.obj
bad one file twice | --csv: .*--json | {two} --csv a.out --json a.out
bad frames of what stands still | --frames: nothing .*%d | {two} --frames 3
many.json << {"name": "many", "objects": [{"mesh": "many.obj", "split": "groups"}]}
bad more pairs of objects than are answered
  | scene: has 16782321 pairs of objects, and at most 4194304 .*; ask for the nearest | distance many.json
bad a full disk for {output} | /dev/full: cannot be written: No space left | {two} {output} /dev/full
bad no certificate | --certificate: farcull distance has no such option | {two} --certificate c.json
""", **VALUES, output=['--json', '--csv'], within=['-1', 'nan', ''])
rows(r"""
bad more pairs than are answered | within: has more than 4194304 pairs of triangles, .*; give a smaller distance, or .*, as collisions with --clearance$
  | distance random-soup --pairs all --within 100
""", limits={'cpu': None})
rows(r"""
0 two objects | {two} --verify | ^0 small +1 right +1 +0 vertex 1 +0 vertex 0
  | ^verified: the answers are right, no nearer pair was culled, 4 pairs accounted for$
  | ^nearest points and exact squares: with --csv or --json$
0 the least | distance small.obj right.obj large.obj small.obj | ^least +0, of 0 small and 3 small.*, which meet$
  | ^0 small +2 large .* a in b$
0 as JSON | {two} --json - | ^ +"distance": 1\.0,$ | ^ +"squared": "1/1",$ | ^ +"inside": "none"$ | ^ +"hash": "[0-9a-f]{16}"$
0 as CSV | {two} --csv - | ^object_a,triangle_a,object_b,triangle_b,distance,squared,x_a,
  | ^0,0,1,0,1,1/1,1,0,0,2,0,0,vertex 1,vertex 0,none$
0 inside | distance small.obj large.obj --csv - | ,a$
0 ignored in each frame | distance cylinders:3 --frames 2 --ignore cylinder0:cylinder1 | ^ +0 +2 | ^ +1 +2
0 ignored | {three} --ignore small:right --csv ignored.csv | ^ignored    1 pair of objects$
  | $ ! grep -q '^0,[0-9]*,1,' ignored.csv && (($(wc -l <ignored.csv) == 3))
0 within less | {two} --within 0.999 --csv - | $ (($(wc -l <"$out") == 1))
0 nearest | distance small.obj right.obj large.obj --pairs nearest --k 4000000000 --verify | ^0 small +1  1 right +1[ ]
0 all | distance crowd --pairs all --within 0.01 --verify --csv all.csv --json all.json | ^verified:
0 self | distance crumpled:1000 --self --pairs all --within 0.001 --verify | ^verified: .* pairs accounted for$
moves_{i}.obj << v {i} 0 0; v 9 0 0; v 9 1 0; f 1 2 3
0 frames | distance small.obj moves_%d.obj --frames 2:4 --verify --csv frames.csv --json frames.json | ^ +3 +1 +2[ ]
  | @frames.csv ^frame,object_a, | @frames.csv ^4,0,0,1,0,3,9/1, | @frames.json ^    "missed": 0,$
# A distance beyond the largest double.
right_end.obj << v 1.7e308 0 0; v 1.6e308 0 0; v 1.7e308 1 0; f 1 2 3
left_end.obj << v -1.7e308 0 0; v -1.6e308 0 0; v -1.7e308 1 0; f 1 2 3
0 beyond the doubles | distance right_end.obj left_end.obj --verify --json - | ^ +"distance": null,$
0 frames of a built-in scene | distance two-spheres --frames 2 --inside no
""", **VALUES, i=['2', '3', '4'])
