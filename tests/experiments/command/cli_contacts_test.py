"""Kinds of contact, ignored objects and limits."""
from cli_lab import rows

rows(r"""
floor.obj << v 0 0 0; v 8 0 0; v 0 8 0; f 1 2 3
fin.obj << v 1 1 -1; v 1 1 1; v 1 3 0; f 1 2 3
spike.obj << v 4 2 0; v 4 2 3; v 5 2 3; f 1 2 3
sheet.obj << v 2 2 0; v 3 2 0; v 2 3 0; f 1 2 3
bad {columns} without pairs | {columns0}: .*--pairs | run {all} {*columns}
bad kinds '{kinds}' | --kinds: .*give some of apart,[ ] | run {all} --pairs p.csv --kinds {kinds}
bad limit '{limit}' | --limit: .*1 or more | run {all} --limit {limit}
bad an unknown name | --ignore: 'floor:wing' names 'wing', and no object is called so; .* of a name; the scene has floor, fin
  | run {all} --ignore floor:wing
bad a misspelt name | --only: 'flor:fin' names 'flor', .*; did you mean floor\? the scene has floor, fin | run {all} --only flor:fin
$ mkdir -p one two && cp fin.obj one/floor.obj && cp fin.obj two/floor.obj
bad a name without its folder | --ignore: 'floor:fin' names 'floor', .*; did you mean two/floor\? | run one/floor.obj two/floor.obj fin.obj --ignore floor:fin
wrong.txt << floor:fin; ; floor:wing
bad a wrong line | wrong\.txt:3: 'floor:wing' names 'wing' | run {all} --ignore-file wrong.txt
bad a certificate with {part} | {part0}: a certificate is about all[ ] | run {all} {*part} --certificate c.json

0 kinds | verify {all} --contacts --pairs kinds.csv | ^contacts   1 touch-vertex \+ 1 coplanar \+ 1 crossing$
  | @kinds.csv #0 ^object_a,triangle_a,object_b,triangle_b,contact$ | @kinds.csv ^0,0,1,0,crossing$
  | @kinds.csv ^0,0,2,0,touch-vertex$ | @kinds.csv ^0,0,3,0,coplanar$
0 without kinds | run {all} --pairs plain.csv | $ cmp -s plain.csv <(cut -d, -f1-4 kinds.csv)
0 a list with kinds is proved | check --pairs kinds.csv {all}
0 segments | run {all} --segments --faces --pairs - | ^object_a,.*,contact,x0,y0,z0,x1,y1,z1,polygon,face_a,face_b$
  | ^0,0,1,0,crossing,1,1,0,1,3,0,,0,0$ | ^0,0,2,0,touch-vertex,4,2,0,4,2,0,,0,0$
  | ^0,0,3,0,coplanar,,,,,,,[-0-9.]+( [-0-9.]+)+,0,0$
0 names | run {all} --names --pairs - | #0 ^object_a,.*,name_a,name_b$ | ^0,0,1,0,floor,fin$ | ^0,0,3,0,floor,sheet$
bad names without a list | --names: .*--pairs | run {all} --names
0 some kinds | run {all} --kinds crossing,coplanar --pairs some.csv | $ cmp -s some.csv <(grep -v touch kinds.csv)
0 kinds of a clearance | run {all} --clearance 9 --kinds apart --pairs - | ^0,0,|^1,0,2,0,apart$
0 kinds of frames | run two-spheres --frames 2 --contacts --json - --pairs frames.csv | ^ +"crossing": [0-9]+,$
  | @frames.csv #0 ^frame,object_a,.*,contact$
# boxes makes none of the ignored pairs.
0 ignored | verify {all} --ignore 'f*:spike' --pairs ignored.csv | [ ]2 ignored \+ 0 missed$
  | ^ignored    2 pairs of objects, of which no candidate pairs were made$ | $ cmp -s ignored.csv <(grep -v ',2,0$' plain.csv)
pairs.txt << # links; floor:spike; fin:spike
0 ignored by {method} | run {all} --method {method} --ignore-file pairs.txt --pairs by.csv | $ cmp -s ignored.csv by.csv
0 ignored in frames | verify two-spheres@ground --frames 2 --ignore first:second | [ ]52,428,800 ignored \+ 0 missed$
# The list is proved where the same pairs are ignored. The twins: one of all pairs, and one that lacks a pair.
0 a list with ignored objects is proved | check --pairs ignored.csv {all} --ignore 'f*:spike' | ^proved: .*, of objects that are not ignored$
1 a list of all | check --pairs plain.csv {all} --ignore 'f*:spike' | ^refuted: .* the pair is of two objects that are ignored$
0 a certificate of all | run {all} --certificate all.json
bad a certificate and ignored objects | [^:]*: the scene ignores .* a certificate answers about all | check all.json {all} --ignore 'f*:spike'
# An object of the first frame that is gone in the second one; and one that comes in the second.
parts_1.obj << v 1 1 -1; v 1 1 1; v 1 3 0; g a; f 1 2 3; v 4 1 -1; v 4 1 1; v 4 3 0; g b; f 4 5 6
parts_2.obj << v 1 1 -1; v 1 1 1; v 1 3 0; g a; f 1 2 3
parts.json << {"objects": [{"mesh": "parts_%d.obj", "split": "groups"}, {"mesh": "floor.obj"}]}
ignores.json << {"ignore": [["*/b", "floor"]], "objects": [{"mesh": "parts_%d.obj", "split": "groups"},
  {"mesh": "floor.obj"}]}
goes.csv << frame,object_a,triangle_a,object_b,triangle_b; 1,0,0,2,0; 2,0,0,1,0
0 an object that goes | verify parts.json --frames 1:2 --ignore '*/b:floor' --pairs frames.csv | $ cmp -s frames.csv goes.csv
bad an object that comes | --ignore: '\*/b:floor' names '\*/b', and no object is called so
  | run parts.json --frames 2:2 --ignore '*/b:floor'
0 an object that goes, in the file | verify ignores.json --frames 1:2 --pairs file.csv | $ cmp -s file.csv goes.csv
0 the list of these frames | check ignores.json --frames 1:2 --pairs file.csv
  | ~ proved:ineachof2frames.*,andnoothers,ofobjectsthatarenotignored:2inall
bad an object that comes, in the file | ignores\.json:1: ignore\[0\] names '\*/b', and no object is called so
  | run ignores.json --frames 2:2

# A polygon that crosses itself is named.
folded.obj << v 0 0 0; v 3 0 0; v 3 3 0; v 0 2 0; g a; f 1 2 3; g b; f 1 3 2 4
folded.json << {"objects": [{"mesh": "folded.obj", "split": "groups"}]}
0 a folded polygon | run folded.json | ^scene      folded: 2 objects, 3 triangles, 1 polygon folded: face 1 of folded/b$

0 a limit | verify {all} --limit 2 --pairs - --json first.json | $ cmp -s "$out" <(head -n 3 plain.csv)
  | @first.json "complete": false
""", all='floor.obj fin.obj spike.obj sheet.obj', method=['boxes', 'exact', 'i-collide'],
     columns=['--segments', '--kinds crossing'], kinds=['', 'cross', 'crossing,'], limit=['0', '1.5', '99999999999999999999'],
     part=['--limit 1', '--ignore floor:fin', '--ignore-file wrong.txt'])
