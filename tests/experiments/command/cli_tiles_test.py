"""Tiles: the built-in scenes in tiles give the lists of one run, with every option that tiles take; the others are
refused; and what is merged is whole or not there."""
import glob
import os
import re
import shlex

from cli_lab import bash, good, read, rows, write


def same(tiles, scene):
    """So many tiles, merged, against one run."""
    bash('rm -f t[0-9]*.json *.csv')
    words = ['run', *shlex.split(scene), '--no-verify']
    name = f'{tiles} tiles of {scene}'
    good(name, 0, [*words, '--pairs', 'one.csv'])
    for k in range(1, tiles + 1):
        good(name, 0, [*words, '--tiles', f'{k}/{tiles}', '--json', f't{k}.json', '--pairs', f't{k}.csv'])
    good(name, 0, ['merge', *sorted(glob.glob('t[0-9]*.json')), '-o', 'merged.csv'],
         ['$ cmp -s one.csv merged.csv'])


# Scenes in tiles; random ones, on whose cuts boxes begin and end: run_tile_test.cpp.
for number, scene in enumerate('random-soup degenerate field:3000 cloth:1000 stack'.split()):
    same(number + 1, scene)
# Options that tiles take.
for tiles, scene in (4, 'cloth:1000 --self --contacts --faces'), (2, 'two-spheres --self --clearance 0.01 --segments'), \
        (3, 'degenerate --kinds crossing,coplanar'), (3, "crowd --ignore '*1:*2,*3:*4'"):
    same(tiles, scene)

# Scenes from files, with meshes that are named several times and divided; and one that ignores pairs of its objects, some
# of which meet no tile of the other.
rows('0 a scene from a file | scenes crowd:40 --write crowd')
scene = read('crowd/scene.json')
mesh = min(path for path in glob.glob('crowd/**', recursive=True) if os.path.isfile(path) and path[-5:] != '.json')
write('again.json', '''{"name": "again", "objects": [{"mesh": "MESH", "self": true},
  {"mesh": "MESH", "translate": [0.1, 0, 0]}, {"mesh": "MESH", "split": "components", "scale": 1.5}]}
'''.replace('MESH', mesh))
write('crowd/ignores.json', scene.replace('{', '{"ignore": [["*1", "*2"], ["*3", "*4"]],', 1))
swap = {'tetrahedron0"': 'tetrahedron1"', 'tetrahedron1"': 'tetrahedron0"'}
write('crowd/renamed.json', re.sub('tetrahedron[01]"', lambda found: swap[found[0]], scene))
for tiles, options in (2, 'again.json'), (2, "crowd/ignores.json --ignore '*5:*6'"):
    same(tiles, options)
# Tiles that ignore others are not joined. Nor is a name believed, but the object: here one name is of two objects.
rows(r"""
0 a name | run crowd/scene.json --no-verify --ignore 'tetrahedron0:*2' --tiles 1/2 --json t1.json --pairs t1.csv
0 a name | run crowd/renamed.json --no-verify --ignore 'tetrahedron0:*2' --tiles 2/2 --json t2.json --pairs t2.csv
bad one name of two objects | .*was run with other options | merge t1.json t2.json -o merged.csv
""")

rows(r"""
0 the table | run field:30000 --tiles 2/3 | tile       2 of 3 | pairs of other tiles are not covered | memory    [ ]
  | accounted [ ]
# What cannot be answered in tiles, and values that are none.
bad far | --tiles: are of boxes | run two-spheres --tiles 1/2 --method far
each {0}: cannot be answered in tiles | run two-spheres --tiles 1/2 | --limit 5 | --frames 3
bad a tile that is none | .*'3/2' is no tile | run two-spheres --tiles 3/2
each .*no object is called so | | run crowd --tiles 1/2 --ignore 'nobody:*'
$ "$farcull" run crowd --tiles 1/2 --json t.json --pairs $'u\xff.csv' 2>&1 >/dev/null | grep -qF 'no UTF-8'
ignored.txt << tetrahedron0:*2
each .*--ignore-file | run crowd --ignore-file ignored.txt | --tiles 1/2 --pairs ignored.txt | --json ignored.txt
bad a tile of one object | SCENE: nothing to test: the scene is one object | run {mesh} --tiles 1/1
# A tile that missed a pair, or promises nothing.
0 a promise | run two-tori --tiles 1/1 --json t1.json --pairs t1.csv
$ sed -i 's/"false_negatives": 0/"false_negatives": 3/; s/"promises": true/"promises": false/' t1.json
1 missed pairs | merge t1.json -o merged.csv | @err culled pairs that collide: 3 | no promise:
""", mesh=mesh)

# Certificates of tiles prove the list of the whole together. Twins: a tile that is missing, another scene, another list. Forged
# ones: tile_certificate_test.cpp.
bash('rm -f *.json *.csv')
SCENE = 'field:3000 --clearance 0.02 --no-verify'
for k in 1, 2, 3:
    good('a certificate of a tile', 0, ['run', *shlex.split(SCENE), '--tiles', f'{k}/3', '--json', f'r{k}.json', '--pairs', f'p{k}.csv',
                                        '--certificate', f't{k}.json'])
rows(r"""
0 merged | merge r1.json r2.json r3.json -o merged.csv
0 whole | check t%d.json field:3000 --tiles 3 --pairs merged.csv --json c.json
  | #0 ^proved: these [0-9,]* pairs of the scene are at distance 0.02 or less, and no others$ | ^tile +t3.json, [xyz] from
  | ^not asked +[0-9,]+ pairs of triangles inside [0-9,]+ of [0-9,]+ objects \(add --self\)$
$ grep -qF "$(sha256sum <merged.csv | cut -c 1-64)" c.json && grep -qF '"verdict": "proved"' c.json
0 one tile | check t2.json field:3000 --pairs p2.csv | #0 ^proved: of the pairs that belong to the tile, these
1 another list | check t%d.json field:3000 --tiles 3 --pairs p2.csv | #0 ^not proved: p2\.csv is another list: line
1 another scene | check t%d.json field:3000@far --tiles 3 | #0 ^not proved: t1\.json: the certificate is of another scene
1 two of three | check t%d.json field:3000 --tiles 2 | #0 ^not proved: a tile is missing:
$ cp t1.json u1.json && cp t3.json u2.json && cp t2.json u3.json
1 in another order | check u%d.json field:3000 --tiles 3 | #0 ^not proved: u2\.json is of the tile .*does not begin where
bad four of three | t4\.json | check t%d.json field:3000 --tiles 4
0 whole | run field:3000 --no-verify --certificate w1.json
bad a whole scene | .*is about a whole scene | check w%d.json field:3000 --tiles 1
bad no number | CERTIFICATE: .*has no place for a number | check t1.json field:3000 --tiles 3
bad frames | --tiles: | check t%d.json field:3000 --tiles 3 --frames 2
bad ignored pairs | .*ignores pairs of objects, and a certificate | run crowd/ignores.json --tiles 1/2 --certificate i.json
""")
