"""farcull clash: options, the answer in each form, and the exit status."""
from cli_lab import rows, write


def box(name, lo, hi):
    """A closed box as OBJ, 12 triangles."""
    corners = [(hi if k >> axis & 1 else lo)[axis] for k in range(8) for axis in range(3)]
    quads = ['1 3 4 2', '5 6 8 7', '1 2 6 5', '3 7 8 4', '1 5 7 3', '2 4 8 6']
    write(name, ''.join('v {} {} {}\n'.format(*corners[3 * k:3 * k + 3]) for k in range(8)) + ''.join(f'f {q}\n' for q in quads))


rows('$ mkdir parts nothing')
box('parts/a.obj', (0, 0, 0), (2, 2, 2))
box('parts/b.obj', (1, 0.5, 0.5), (3, 1.5, 1.5))
box('parts/c.obj', (5, 0, 0), (6, 1, 1))
box('parts/d.obj', (6, 0, 0), (7, 1, 1))
box('inner.obj', (0.5, 0.5, 0.5), (1, 1, 1))
box('open.obj', (0, 0, 0), (2, 2, 2))
rows("$ sed -i '/^f 1 5 7 3$/d' open.obj")
write('empty.off', 'OFF\n1 0 0\n0 0 0\n')

# ---- bad input

rows(r"""
bad no part | SCENE: none is named | clash
bad one part | scene: has fewer than two objects; name two parts | clash inner.obj
bad a folder without meshes | nothing: the folder has no mesh files | clash nothing
bad clearance '{clearance}' | --clearance: | clash parts --clearance {clearance}
bad fail on {word} | --fail-on: '{word}' is no verdict; give none, or some of | clash parts --fail-on {word}
bad ignored | --ignore: | clash parts --ignore a:none
bad tolerance '{clearance}' | --tolerance: '.*' is no tolerance | clash parts --tolerance {clearance}
bad only {only} | --only: | clash parts --only {only}
bad only what is ignored | --only: all of these pairs are ignored | clash parts --only a:b --ignore a:*
old.csv << name_a,verdict; a,clash
bad compared with another table | old.csv:1: has no column name_b | clash parts --compare old.csv
old.csv << name_a,name_b,verdict; a,clash
bad compared with a broken table | old.csv:2: 2 cells under 3 names | clash parts --compare old.csv
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
""", clearance=['-1', ''], word=['clear', 'clashes'], only=['a:none', 'a', ''])

# ---- good cases

rows(r"""
1 a folder | clash parts | ^examined   6 of 6 pairs of parts$ | ^verdicts   1 clash, 0 contained, 0 unknown, 1 touch, 0 near, 4 clear$
  | ^clash +a +b +.* surfaces cross in [0-9]* pairs of triangles$ | ! ^touch
1 touching | clash parts --fail-on touch | ^touch +c +d
0 fail on none | clash parts --fail-on none | ^clash
1 near | clash parts --fail-on near --clearance 2 --unit mm | ^near +b +c .* 2 | depth .mm. | ^depths are not asked for .--depth.$
$ ln -s ../parts cad/more
bad a link to a folder | cad/more: is neither a file nor a folder, or a link to a folder | clash cad
$ rm cad/more
bad a folder for run | parts: is a folder; name its files, as in parts/\*.stl; farcull clash takes | run parts
0 clean | clash parts/a.obj parts/c.obj | ^examined   1 of 1 pair of parts: clean$
0 ignored | clash parts --ignore a:b | ^ignored    1 pair, of which 1 meets$ | ^clash .ignored. +a +b[ ] | ^examined   5 of 5 .*: clean$
1 all digits | clash parts --csv - | #0 ^name_a,name_b,id,verdict,exact,ignored,proved,triangle_pairs, | #1 ^a,b,[0-9a-f]{8},clash,clash,0,1, | #1 ,not asked for, | #2 ^c,d,[0-9a-f]{8},touch,touch,
1 a page | clash parts --html page.html | @page.html "verdict":"clash" | @page.html "what":"surfaces cross | @page.html "title":"parts"
1 the title of a folder | clash parts | #0 ^parts: 4 parts,
1 folders in a folder | clash cad | ^examined   6 of 6 pairs | ^clash +left/Gehäuse  right/Gehäuse[ ]
1 columns fit letters of two bytes | clash cad --fail-on clash,contained,unknown,touch | ^clash    left/Gehäuse  right/Gehäuse[ ] | ^touch    100% c;3      bolt[ ]
1 a part without triangles | clash parts/a.obj empty.off parts/c.obj | ^examined   1 of 3 pairs of parts$ | ^not examined: empty.off has no triangles$ | ! clean
1 JSON | clash parts --depth --json - --unit mm | "clean": false | "unit": "mm" | "verdict": "clash" | "least": 0.99999
  | $ python3 -c 'import json; r = json.load(open("'"$out"'")); d = r["pairs"][0]["depth"]; assert d["least"] <= 1 <= d["most"] < 1.0001, d'
""")

# ---- tolerance: the walls meet at 0.15, but for rounding

rows('$ mkdir walls')
box('walls/a.obj', (-5, -.15, 0), (5, .15, 3))
box('walls/b.obj', (-.15, 0.1499999999999999, 0), (.15, 4.15, 3))
box('walls/c.obj', (-5, 4.15000000000001, 0), (5, 4.5, 3))
rows(r"""
1 walls | clash walls --fail-on clash | ^verdicts   1 clash, 0 contained, 0 unknown, 0 touch, 0 near, 2 clear$ | ^clash +a +b[ ]
0 with a tolerance | clash walls --tolerance '1e-9*size' --csv walls.csv | ^verdicts   0 clash, 0 contained, 0 unknown, 2 touch .2 within tolerance., 0 near, 1 clear$
  | ^tolerance  1.142.*e-08$ | @walls.csv ^a,b,.*,touch,clash, | @walls.csv ^b,c,.*,touch,clear,
1 touching | clash walls --tolerance 1e-9 --fail-on touch | ~ touchab.*withinthetolerance;exactly:clash,surfacescrossin24pairs
  | ~ touchbc.*withinthetolerance;exactly:clear
1 too little | clash walls --tolerance 1e-17 | ^clash +a +b[ ]
0 JSON of a tolerance | clash walls --tolerance 1e-9 --json - | "within_tolerance": 2
  | $ python3 -c 'import json; r = json.load(open("'"$out"'")); d = r["pairs"][0]; assert d["exact"] == "clash" and 0 < d["depth"]["most"] <= 1e-9 and r["tolerance"] == 1e-9, d'
0 a page of a tolerance | clash walls --tolerance 1e-9 --html walls.html | @walls.html "exact":"clash" | @walls.html within the tolerance

# ---- chosen pairs, an earlier table, hints, names

0 only | clash parts --only c:d,a:c | ^examined   2 of 2 pairs of parts: clean$ | ^verdicts   0 clash, 0 contained, 0 unknown, 1 touch, 0 near, 1 clear$
1 only groups | clash parts --only 'a:*' --json - | "asked": 3 | "examined": 3
$ cp -r parts changed && rm changed/d.obj
1 an earlier table | clash parts --csv before.csv
1 nothing changed | clash parts --compare before.csv --csv same.csv | ^compared   0 new, 2 same, 0 gone$ | ^same clash +a +b[ ] | @same.csv ^a,b,.*,same$
$ mv changed/b.obj changed/c2.obj
1 new and gone | clash changed --compare before.csv --csv after.csv | ^compared   1 new, 0 same, 2 gone$ | ^new clash +a +c2[ ] | ^gone clash +a +b | @after.csv ^a,c2,.*,new$
  | @after.csv ^a,b,[0-9a-f]{8},clash,,.*,gone$ | @after.csv ^c,d,.*,touch,,.*,gone$
  | $ python3 -c 'import csv; assert {len(r) for r in csv.reader(open("after.csv"))} == {37}'
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
