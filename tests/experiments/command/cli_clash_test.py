"""farcull clash: options, the answer in each form, and the exit status."""
from cli_lab import rows, write


def box(name, lo, hi):
    """A closed box as OBJ, 12 triangles."""
    corners = [(hi if k >> axis & 1 else lo)[axis] for k in range(8) for axis in range(3)]
    quads = ['1 3 4 2', '5 6 8 7', '1 2 6 5', '3 7 8 4', '1 5 7 3', '2 4 8 6']
    write(name, ''.join('v {} {} {}\n'.format(*corners[3 * k:3 * k + 3]) for k in range(8)) + ''.join(f'f {q}\n' for q in quads))


def slot(name, left, right):
    """Two walls on a floor, with a slot from x = left to right and z = 1 to 3."""
    profile = [(-1, 0), (4, 0), (4, 3), (right, 3), (right, 1), (left, 1), (left, 3), (-1, 3)]
    faces = [range(1, 9), range(16, 8, -1), *((k % 8 + 1, k, k + 8, k % 8 + 9) for k in range(1, 9))]
    write(name, ''.join(f'v {x} {y} {z}\n' for y in (0, 2) for x, z in profile)
          + ''.join(f'f {" ".join(map(str, face))}\n' for face in faces))


rows('$ mkdir parts nothing')
box('parts/a.obj', (0, 0, 0), (2, 2, 2))
box('parts/b.obj', (1, 0.5, 0.5), (3, 1.5, 1.5))
box('parts/c.obj', (5, 0, 0), (6, 1, 1))
box('parts/d.obj', (6, 0, 0), (7, 1, 1))
box('inner.obj', (0.5, 0.5, 0.5), (1, 1, 1))
box('open.obj', (0, 0, 0), (2, 2, 2))
box('turned.obj', (0, 0, 0), (2, 2, 2))
rows(r"""
$ sed -i '/^f 1 5 7 3$/d' open.obj
$ sed -i 's/^f 1 5 7 3$/f 3 7 5 1/' turned.obj
""")
write('empty.off', 'OFF\n1 0 0\n0 0 0\n')

rows(r"""
bad no part | SCENE: none is named | clash
bad one part | scene: has fewer than two objects; name two parts | clash inner.obj
bad a folder without meshes | nothing: the folder has no mesh files | clash nothing
bad clearance '{clearance}' | --clearance: | clash parts --clearance {clearance}
bad fail on {word} | --fail-on: '{word}' is no verdict; give none, or some of | clash parts --fail-on {word}
bad ignored | --ignore: | clash parts --ignore a:none
bad tolerance '{clearance}' | --tolerance: '.*' is no tolerance | clash parts --tolerance {clearance}
bad only {only} | --only: | clash parts --only {only}
old.csv << name_a,verdict; a,clash
bad compared with another table | old.csv:1: has no column name_b | clash parts --compare old.csv
old.csv << name_a,name_b,verdict; a,clash
bad compared with a broken table | old.csv:2: 2 cells under 3 names | clash parts --compare old.csv
bad new without an earlier table | --fail-on: new needs an earlier table; name it with --compare | clash parts --fail-on new
bad {one} of frames | {one}: is of one frame; leave it or --frames out | clash two-spheres --frames 2 {one} old.csv
bad new in frames | --fail-on new: is of one frame; leave it or --frames out | clash two-spheres --frames 2 --fail-on new
bad frames of what stands still | --frames: nothing in the scene moves | clash parts --frames 2
bad compared with nothing | none.csv: | clash parts --compare none.csv
bad compared with what is written | --csv: .* | clash parts --compare old.csv --csv old.csv
bad only parts without triangles | empty.off: the mesh has no triangles | clash empty.off
$ mkdir -p cad/left cad/right
$ cp parts/a.obj cad/left/Gehäuse.OBJ
$ cp parts/b.obj cad/right/Gehäuse.obj
$ cp parts/c.obj "cad/right/100% c;3.obj"
cad/left/bolt.step << ISO-10303-21;
bad a part in a format that is not read | cad.left.bolt.step: is a .step file | clash cad
$ cp parts/d.obj cad/right/bolt.obj
bad a part in a format that is not read, with a mesh elsewhere | cad.left.bolt.step: is a .step file | clash cad
$ mv cad/left/bolt.step cad/right/bolt.step
$ mkdir packed && cp parts/a.obj parts/b.obj packed && gzip -c cad/right/bolt.step > packed/bolt.step.gz
bad a compressed part in a format that is not read | packed.bolt.step.gz: is a .step file | clash packed
bad a part as output | --csv: .*mesh | clash parts --csv inner.obj
""", clearance=['-1', ''], word=['clear', 'clashes'], one=['--html', '--compare'], only=['a:none', 'a', ''])

rows(r"""
1 a folder | clash parts | ^examined   6 of 6 pairs of parts$ | ^verdicts   1 clash, 0 contained, 0 unknown, 1 touch, 0 near, 4 clear$
  | ^clash +a +b +.* surfaces cross in 8 pairs of triangles$ | ! ^touch
1 touching | clash parts --fail-on touch | ^touch +c +d
0 fail on none | clash parts --fail-on none | ^clash
1 near | clash parts --fail-on near --clearance 2 --unit mm | ^near +b +c .* 2 | depth .mm. | ^depths are not asked for .--depth.$
$ ln -s ../parts cad/more
bad a link to a folder | cad/more: is neither a file nor a folder, or a link to a folder | clash cad
$ rm cad/more
bad a folder for run | parts: is a folder; name its files, as in parts/\*.stl; farcull clash takes | run parts
0 clean | clash parts/a.obj parts/c.obj | ^examined   1 of 1 pair of parts: clean$
0 only what is ignored | clash parts --only a:b --ignore a:*,c:d | ^examined   0 of 0 pairs of parts$ | ^clash .ignored. +a +b[ ]
0 all pairs ignored | clash parts/a.obj parts/b.obj --ignore a:b | ^ignored    1 pair, of which 1 meets$ | ^clash .ignored. +a +b[ ]
0 ignored | clash parts --ignore a:b | ^ignored    1 pair, of which 1 meets$ | ^clash .ignored. +a +b[ ] | ^examined   5 of 5 .*: clean$
1 all digits | clash parts --csv - | #0 ^name_a,name_b,id,verdict,exact,ignored,proved,triangle_pairs, | #1 ^a,b,[0-9a-f]{8},clash,clash,0,1, | #1 ,not asked for, | #2 ^c,d,[0-9a-f]{8},touch,touch,
1 a page | clash parts --html page.html | @page.html "verdict":"clash" | @page.html "what":"surfaces cross | @page.html "title":"parts"
1 the title of a folder | clash parts | #0 ^parts: 4 parts,
1 folders in a folder | clash cad | ^examined   6 of 6 pairs | ^clash +left/Gehäuse  right/Gehäuse[ ]
1 columns fit letters of two bytes | clash cad --fail-on clash,contained,unknown,touch | ^clash    left/Gehäuse  right/Gehäuse[ ] | ^touch    100% c;3      bolt[ ]
1 a part without triangles | clash parts/a.obj empty.off parts/c.obj | ^examined   1 of 3 pairs of parts$ | ^not examined: empty.off has no triangles$ | ! clean
0 a baseline in which a pair is ignored | clash parts --ignore a:b --csv ignored.csv
1 a pair that is ignored no more is new | clash parts --compare ignored.csv --fail-on new | ^new clash +a +b
0 a pair that is ignored still | clash parts --ignore a:b --compare ignored.csv --fail-on new | ^same clash .ignored. +a +b
1 turned faces around a part, where rays decide | clash turned.obj inner.obj | ^contained +turned +inner
1 an open part around a part, where there is no inside | clash open.obj inner.obj | ~ unknownopeninner.*isnotclosed,oritisnotcertainwhatitsfacesenclose
1 JSON | clash parts --depth --json - --unit mm | "clean": false | "unit": "mm" | "verdict": "clash" | "least": 0.99999
  | $ python3 -c 'import json; r = json.load(open("'"$out"'")); d = r["pairs"][0]["depth"]; assert d["least"] <= 1 <= d["most"] < 1.0001, d'
""")

# Tolerance: the walls meet at 0.15, but for rounding.
rows('$ mkdir walls')
box('walls/a.obj', (-5, -.15, 0), (5, .15, 3))
box('walls/b.obj', (-.15, 0.1499999999999999, 0), (.15, 4.15, 3))
box('walls/c.obj', (-5, 4.15000000000001, 0), (5, 4.5, 3))
rows('$ mkdir twice')
box('twice/x.obj', (0, 0, 0), (10, 10, 15))
box('twice/y.obj', (0, 0, 0), (10, 10, 15))
rows(r"""
1 walls | clash walls --fail-on clash | ^verdicts   1 clash, 0 contained, 0 unknown, 0 touch, 0 near, 2 clear$ | ^clash +a +b[ ]
0 with a tolerance | clash walls --tolerance '1e-9*size' --csv walls.csv | ^verdicts   0 clash, 0 contained, 0 unknown, 2 touch .2 within tolerance., 0 near, 1 clear$
  | ^tolerance  1.142.*e-08$ | @walls.csv ^a,b,.*,touch,clash, | @walls.csv ^b,c,.*,touch,clear,
1 touching | clash walls --tolerance 1e-9 --fail-on touch | ~ touchabatmost.*withinthetolerance;exactly:clash,surfacescrossin6pairs
  | ~ touchbc.*withinthetolerance;exactly:clear
1 too little | clash walls --tolerance 1e-17 | ^clash +a +b[ ]
0 JSON of a tolerance | clash walls --tolerance 1e-9 --json - | "within_tolerance": 2
  | $ python3 -c 'import json; r = json.load(open("'"$out"'")); d = r["pairs"][0]; assert d["exact"] == "clash" and 0 < d["depth"]["most"] <= 1e-9 and r["tolerance"] == 1e-9, d'
1 a part twice is deeper than the tolerance | clash twice --tolerance 1e-5 --csv twice.csv | @twice.csv ^x,y,[0-9a-f]{8},clash,clash,0,1,108, | ! not proved
  | ~ clashxy.*faceslieoneachotherin24pairsoftriangles | ^depths are not asked for
1 a part twice, of which a depth is asked | clash twice --tolerance 1e-5 --depth --csv twice.csv | @twice.csv ^x,y,[0-9a-f]{8},clash,clash,0,1,108, | ! not proved
  | @twice.csv ,9.99[0-9]*,10.0000[0-9]*,,140, | ~ clashxy.*faceslieoneachotherin24pairsoftriangles
0 a page of a tolerance | clash walls --tolerance 1e-9 --html walls.html | @walls.html "exact":"clash" | @walls.html within the tolerance
""")

# A part that is flush in a slot, between whose walls no room is left to move it out. Twins fit, or are deeper.
slot('slot.obj', 1, 2)
box('flush.obj', (1 - 1e-9, 0, 1), (2 - 1e-9, 2, 2.5))
box('rounded.obj', (1 - 1.2e-16, 0, 1), (2, 2, 2.5))
box('tight.obj', (1 - 1e-9, 0, 1), (2 + 1e-9, 2, 2.5))
box('loose.obj', (1 - 1e-9, 0, 1), (2 - 2e-9, 2, 2.5))
box('deep.obj', (1 - 1e-9, 0, 0.5), (2 - 1e-9, 2, 2.5))
rows(r"""
1 {flush} in a slot | clash slot.obj {flush}.obj --tolerance 1e-6 --csv slot.csv | ~ (?:[0-9]to|atmost)2[0-9].*;notprovedtobewithinthetolerance | ! ^depths are not asked for
  | @slot.csv ^slot,{flush},[0-9a-f]{8},clash,clash,0,0,[0-9]+,,,,[0-9.e-]+,2.0
1 {flush} in a slot, exactly | clash slot.obj {flush}.obj | ! not proved to be
0 a loose part in a slot | clash slot.obj loose.obj --tolerance 1e-6 | touch .1 within tolerance.
1 a {deep} part in a slot | clash slot.obj {deep}.obj --tolerance 1e-6 --csv slot.csv | ! not proved to be | @slot.csv ^slot,{deep},[0-9a-f]{8},clash,clash,0,1,
0 a tolerance beyond the slot | clash slot.obj flush.obj --tolerance 3 | touch .1 within tolerance.
""", flush=['flush', 'rounded'], deep=['deep', 'tight'])

# Frames: a part comes nearer, meets the wall in frame 3, and leaves it in frame 5.
box('wall.obj', (0, 0, 0), (2.5, 1, 1))
for frame, at in enumerate((4, 3, 2, 2.25, 2.5), 1):
    box(f'moves_{frame}.obj', (at, 0.25, 0.25), (at + 1, 0.75, 0.75))
rows(r"""
1 frames | clash moves_%d.obj wall.obj --frames 1:5 --clearance 1.5 --depth --unit mm --csv frames.csv --json frames.json
  | ^ +3 +1 +0 +0 +0 +0 +0$ | ^ +5 +0 +0 +0 +1 +0 +0$ | ^clash +moves_%d +wall +2 +3 +4 +0.5 in 3 +0 in 3$ | ^5 of 5 frames$
  | depth .mm. | @frames.csv #0 ^frame,name_a,name_b,id,verdict, | @frames.csv #3 ^3,moves_%d,wall,.*,clash, | @frames.csv #5 ^5,.*,touch,
  | $ python3 -c 'import json; r = json.load(open("frames.json")); s = r["summary"]; p = s["pairs"][0]; assert r["objects"] == ["moves_%d", "wall"] and [f["pairs"][0]["verdict"] for f in r["frames"]] == ["near", "near", "clash", "clash", "touch"] and "unit" not in r["frames"][0] and (p["verdict"], p["frames"], p["first"], p["last"], p["deepest"], p["distance"], p["nearest"]) == ("clash", 2, 3, 4, 3, 0, 3) and 0.499 < p["depth"] <= 0.5 and s["frames"] == 5 and not s["clean"], p'
0 frames without a clash | clash moves_%d.obj wall.obj --frames 1:2 --clearance 1.5 | ^near +moves_%d +wall +2 +1 +2 +0.5 in 2$ | ^2 of 2 frames: clean$
1 a word of --fail-on in one frame | clash moves_%d.obj wall.obj --frames 1:2 --clearance 0.6 --fail-on near | ^near +moves_%d +wall +1 +2 +2 +0.5 in 2$
0 ignored in frames | clash moves_%d.obj wall.obj parts/c.obj --frames 1:5 --ignore 'moves*:wall' | ^clash .ignored. +moves_%d +wall +2 +3 +4
0 a tolerance in frames | clash moves_%d.obj wall.obj --frames 3:5 --tolerance 0.6 --json - | "within_tolerance": 1 | "tolerance": 0.6,
1 JSON of frames | clash moves_%d.obj wall.obj --frames 3:4 --json - | #0 ^{$ | #-1 ^}$ | ! ^worst
0 deeper ones over frames are those of --depth alone | clash moves_%d.obj wall.obj --frames 3:4 --tolerance 0.3 --fail-on none --json - | "depth": null,
$ for k in 1 2 3; do cp moves_$k.obj lost_$k.obj; done; echo 'v 0 0 0' > lost_4.obj
2 frames until one is broken | clash lost_%d.obj wall.obj --frames 1:4 --json lost.json | @err lost_4.obj: the mesh has no triangles | ^clash +lost_%d +wall +1 +3 +3 | ^3 of 4 frames$
  | @lost.json "wanted": 4, | @lost.json "frames": 3, | @lost.json "clean": false,
2 a frame that could be clean is none | clash lost_%d.obj wall.obj --frames 4:4 | @err lost_4.obj: the mesh has no triangles
$ printf '{"objects": [{"name": "still", "mesh": "wall.obj"}, {"name": "moves", "mesh": "moves_%%d.obj"}, {"name": "c", "mesh": "parts/c.obj"}]}' > only.json
0 pairs that each frame has | clash only.json --frames 1:2 --only still:c | ^2 of 2 frames: clean$
bad frames from another number | moves_0.obj: the file does not exist; .*: --frames 1:3 instead of 0:2$ | clash moves_%d.obj wall.obj --frames 3
1 frames of a built-in scene | clash two-spheres --frames 2 | ^clash +first +second +2 +0 +1

0 only | clash parts --only c:d,a:c | ^examined   2 of 2 pairs of parts: clean$ | ^verdicts   0 clash, 0 contained, 0 unknown, 1 touch, 0 near, 1 clear$
1 only groups | clash parts --only 'a:*' --json - | "asked": 3 | "examined": 3
$ cp -r parts changed && rm changed/d.obj
$ cp -r parts apart && sed 's/^v 6 /v 6.5 /' parts/d.obj > apart/d.obj
1 an earlier table | clash parts --csv before.csv
1 nothing changed | clash parts --compare before.csv --csv same.csv | ^compared   0 new, 2 same, 0 gone$ | ^same clash +a +b[ ] | @same.csv ^a,b,.*,same$
$ mv changed/b.obj changed/c2.obj
0 nothing new | clash parts --compare before.csv --fail-on new | ^same clash
0 nothing new among touches | clash parts --compare before.csv --fail-on new,touch | ^same touch
0 what --only leaves out is not gone | clash parts --only c:d --compare before.csv --json only.json | ^compared   0 new, 1 same, 0 gone, 1 not examined$ | ! ^gone
  | @only.json "gone": .., | @only.json "gone_unexamined": 1
0 what --only names is gone | clash apart --only c:d --compare before.csv --fail-on touch | ^compared   0 new, 0 same, 1 gone, 1 not examined$ | ^gone touch +c +d
1 near before | clash parts --clearance 2 --csv near.csv
1 what is near and ignored is not gone | clash parts --clearance 2 --ignore b:c --compare near.csv | ^compared   0 new, [0-9]* same, 0 gone, 1 not examined$
1 what is no longer near is gone | clash parts --clearance 1 --compare near.csv | ^compared   0 new, [0-9]* same, [1-9] gone$
bad compared with a table of frames | frames.csv:1: has a column frame.*--csv wrote without --frames | clash parts --compare frames.csv
1 new and gone | clash changed --compare before.csv --csv after.csv | ^compared   1 new, 0 same, 2 gone$ | ^new clash +a +c2[ ] | ^gone clash +a +b | @after.csv ^a,c2,.*,new$
  | @after.csv ^a,b,[0-9a-f]{8},clash,,.*,gone$ | @after.csv ^c,d,.*,touch,,.*,gone$
  | $ python3 -c 'import csv; assert {len(r) for r in csv.reader(open("after.csv"))} == {37}'
1 a new clash | clash changed --compare before.csv --fail-on new | ^new clash
0 a new clash, asked about others | clash changed --compare before.csv --fail-on new,touch | ^new clash
1 what was gone is no row | clash changed --compare after.csv --json - | "compared": "same" | "gone": ..
1 in the other order | clash parts/b.obj parts/a.obj --compare before.csv | ^compared   0 new, 1 same, 1 gone$
$ cp parts/a.obj copy.obj
1 a part twice | clash parts/a.obj copy.obj parts/c.obj | ^hint       a and copy may be one part twice
1 no copies | clash parts | ! ^hint
$ sed 's/^v \(\S*\) \(\S*\) \(\S*\)/v \1e3 \2e3 \3e3/' parts/b.obj >mm.obj
0 units | clash parts/a.obj mm.obj --fail-on none | ^hint       mm is .* times the size of a: are all parts in one unit.$
$ cp parts/a.obj a,1.obj && cp parts/b.obj b:2.obj
0 commas and colons in names | clash a,1.obj b:2.obj parts/c.obj --ignore 'a\,1:b\:2' | ^clash .ignored. +a,1 +b:2[ ]
bad a comma | --ignore: 'a' has no colon between two names; .* write . before a comma | clash a,1.obj b:2.obj --ignore a,1:b:2
1 an open part | clash open.obj parts/b.obj --depth --csv open.csv | ~ nodepth:openisnotclosed | @open.csv ,open is not closed,
""")
