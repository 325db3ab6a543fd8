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
write('empty.off', 'OFF\n1 0 0\n0 0 0\n')

# ---- bad input

rows(r"""
bad no part | SCENE: none is named | clash
bad one part | scene: has fewer than two objects; name two parts | clash inner.obj
bad a folder without meshes | nothing: the folder has no mesh files | clash nothing
bad clearance '{clearance}' | --clearance: | clash parts --clearance {clearance}
bad fail on {word} | --fail-on: '{word}' is no verdict; give none, or some of | clash parts --fail-on {word}
bad ignored | --ignore: | clash parts --ignore a:none
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
""", clearance=['-1', ''], word=['clear', 'clashes'])

# ---- good cases

rows(r"""
1 a folder | clash parts | ^examined   6 of 6 pairs of parts$ | ^verdicts   1 clash, 0 contained, 0 unknown, 1 touch, 0 near, 4 clear$
  | ^clash +a +b +.* crossing | ! ^touch
1 touching | clash parts --fail-on touch | ^touch +c +d
0 fail on none | clash parts --fail-on none | ^clash
1 near | clash parts --fail-on near --clearance 2 --unit mm | ^near +b +c .* 2 | depth .mm. | ^depths are not asked for .--depth.$
$ ln -s ../parts cad/more
bad a link to a folder | cad/more: is neither a file nor a folder, or a link to a folder | clash cad
$ rm cad/more
bad a folder for run | parts: is a folder; name its files, as in parts/\*.stl; farcull clash takes | run parts
0 clean | clash parts/a.obj parts/c.obj | ^examined   1 of 1 pair of parts: clean$
0 ignored | clash parts --ignore a:b | ^ignored    1 pair, of which 1 meets$ | ^clash .ignored. +a +b[ ] | ^examined   5 of 5 .*: clean$
1 all digits | clash parts --csv - | #0 ^object_a,object_b,name_a,name_b,verdict,ignored,proved,triangle_pairs, | #1 ^0,1,a,b,clash,0,1, | #2 ^2,3,c,d,touch,
1 a page | clash parts --html page.html | @page.html "verdict":"clash" | @page.html "what":".* crossing
1 folders in a folder | clash cad | ^examined   6 of 6 pairs | ^clash +left/Gehäuse  right/Gehäuse[ ]
1 columns fit letters of two bytes | clash cad --fail-on clash,contained,unknown,touch | ^clash    left/Gehäuse  right/Gehäuse[ ] | ^touch    100% c;3      bolt[ ]
1 a part without triangles | clash parts/a.obj empty.off parts/c.obj | ^examined   1 of 3 pairs of parts$ | ^not examined: empty.off has no triangles$ | ! clean
1 JSON | clash parts --depth --json - --unit mm | "clean": false | "unit": "mm" | "verdict": "clash" | "least": 0.99999
  | $ python3 -c 'import json; r = json.load(open("'"$out"'")); d = r["pairs"][0]["depth"]; assert d["least"] <= 1 <= d["most"] < 1.0001, d'
""")
