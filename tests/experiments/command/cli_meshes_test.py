"""Meshes as people have them, on the command line: --weld and its hint, standard input, notes of readers, and what run
says of objects that may lie inside others."""
from cli_lab import rows, write

CORNERS = [(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)]
QUADS = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]  # outwards


def box(name, low, high, joined=True, faces=6):
    """Two triangles for each face; if not joined, with corners of their own that differ in the last digits."""
    text = ''
    count = 0
    for number, quad in enumerate(QUADS[:faces]):
        for part in ((0, 1, 2), (0, 2, 3)):
            for k in part:
                off = 0 if joined else 1e-12 * ((number + k) % 3)
                point = [low[axis] + (high[axis] - low[axis]) * CORNERS[quad[k]][axis] + off for axis in range(3)]
                text += 'v ' + ' '.join(map(repr, map(float, point))) + '\n'
            count += 3
            text += f'f {count - 2} {count - 1} {count}\n'
    write(name, text)


box('house.obj', (0, 0, 0), (9, 9, 9))
box('part.obj', (3, 3, 3), (4, 4, 4))
box('through.obj', (8, 8, 8), (10, 10, 10))
box('open.obj', (0, 0, 0), (9, 9, 9), faces=5)
box('cad.obj', (0, 0, 0), (1, 1, 1), joined=False)

rows(r"""
edge.obj << v 0 0 0; v 1 0 0; v 0 -1 0; v 0 0 1e-17; v 1 0 -1e-17; v 0 1 0; f 1 2 3; f 4 5 6
# Corners that differ in the last digits.
0 apart | run edge.obj --self | ^colliding +1 pair = 1 \+ 0 of neighbours
0 welded | run edge.obj --self --weld 1e-7*size --certificate c.json --json r.json
  | @err ^farcull: edge\.obj: 2 vertices merged with others that are at most 1e-7\*size away$ | ^scene      edge, welded at 1e-7\*size: 1 object
  | ^colliding +0 pairs | @r.json "edge, welded at 1e-7\*size" | @c.json welded at 1e-7
0 checked | check c.json edge.obj --self --weld 1e-7*size | @err merged | #0 ^proved
1 checked without | check c.json edge.obj --self | #0 not proved
bad a weld | --weld: '-1' is no tolerance | run edge.obj --self --weld=-1
bad of a built-in scene | --weld: has no meaning | run two-tori --weld 1
bad of frames of one | --weld: has no meaning | run two-spheres --frames 2 --weld 1
bad a format of a file | --format: is of a mesh on standard input | run edge.obj part.obj --format obj
bad an option as a name | --weld=1: | run edge.obj -- --weld=1
0 a hint | run cad.obj --self | ^hint +cad is not closed: [0-9]+ open edges, one of them at .* Their ends nearly$
  | ^ +coincide; --weld 1e-[01][0-9][*]size closes it$
0 no hint | run cad.obj --self --weld 1e-9 | @err merged | ! ^hint | ^colliding +0 pairs
bad a name | two-sphere: no built-in scene has this name, and there is no such file; did you mean two-spheres\? | run two-sphere
$ mkdir near && touch near/house.obj near/other.obj near/hose.oc
bad a name of a file | near/hose\.ob: .*no such file; did you mean near/house\.obj\? | run near/hose.ob
bad a name like none | near/x\.ob: .*no such file; correct the name; | run near/x.ob
$ rm -r near
bad a name for clash | nonexist: no built-in scene has this name, and there is no such file; .*farcull scenes | clash nonexist
$ touch plain
bad a file of no kind | plain: neither .* nor a file that ends in | run plain
$ rm plain
# Standard input.
bad without a format | -: standard input does not say | run - --self
bad of a format | --format: 'step' is no format | run - --format step --self
$ "$farcull" run - part.obj --format obj <house.obj >out && grep -q '^scene      stdin+part: 2 objects' out
$ "$farcull" run - --format off --self </dev/null 2>err >out; [[ $? = 2 ]] && grep -q 'standard input: the file is empty' err
# What readers pass over.
notes.obj << v 0 0 0; v 1 0 0; v 0 1 0; v nan 0 0; t 3; f 1 2 3
0 notes | run notes.obj part.obj | @err notes\.obj: 1 vertex that is not finite | @err 'obj: 1 statement that OBJ does not have
turned.json << {"objects": [{"mesh": "house.obj", "rotate": {"axis": [0, 0, 1], "angle": 90}}, {"mesh": "part.obj"}]}
0 degrees | run turned.json | @err ^farcull: turned\.json: objects\[0\]\.rotate: 90 rad: angles are in radians$
$ sed 's/90/-6.28/' turned.json >once.json && "$farcull" run once.json 2>&1 >out | { ! grep -q radians; }
# A part inside another is no collision of surfaces.
0 nested | run house.obj part.obj | ^colliding +0 pairs | ^nested +1 object may lie wholly inside a closed one, as part in house\.
  | farcull distance says what lies inside
0 not nested | run house.obj through.obj | ! ^nested
0 not closed | run open.obj part.obj | ! ^nested
0 ignored | run house.obj part.obj --ignore house:part --self | ! ^nested
# Only some pairs of objects.
0 all pairs | run house.obj through.obj cad.obj --pairs all.csv
0 only | run house.obj through.obj cad.obj --only house:th* --pairs some.csv
  | $ cmp -s some.csv <(grep -v ',2,[0-9]*$' all.csv) && ! cmp -s some.csv all.csv
0 only and ignored | run house.obj through.obj cad.obj --only house:* --ignore house:cad --pairs fewer.csv | $ cmp -s some.csv fewer.csv
bad an only | .*nobody.* | run house.obj cad.obj --only house:nobody
""".replace("'obj: 1", "obj: 1"))
