"""The methods and the plan."""
from cli_lab import rows

rows(r"""
folded.obj << {T}; v 1 1 -1; v 1 1 1; v 0 0 -1; f 1 2 3; f 1 2 4; f 5 6 7
bad quick-cullide with self | --self: .*s-cullide | run two-spheres --method quick-cullide --self
each two-spheres: .*--self | | run two-spheres --method s-cullide | plan two-spheres --method s-cullide
bad clusters '{sizes}' | --clusters: | run two-spheres --method far --clusters {sizes}
each {0}: .*methods | compare two-spheres --methods boxes,exact | --resolutions 64 | --views x | --device native | --offsets exact
bad compare s-cullide without self | --methods: .*--self | compare two-spheres --methods s-cullide,exact
bad the old name of an option | --boxes: .*--broad-phase | run two-spheres --method far --boxes objects
bad a broad phase of what does not draw | --broad-phase: .*cullide | run two-spheres --broad-phase triangles
bad a broad phase of everything | --broad-phase: .*--full | run two-spheres --method far --full --broad-phase triangles
bad s-cullide of objects alone | --level: | run folded.obj --method s-cullide --self --level objects
bad far of objects alone against themselves | --level: .*self | run cloth:400 --method far --self --level objects
bad conservative without the extension | --conservative: .*--device native
  | run two-spheres --method cullide --conservative --device software
bad a radius of the default | --radius: .*boxes; .*--method far | run two-spheres --radius 1
bad plan without a scene | SCENE: | plan
bad plan of nothing known | nope: | plan nope
bad plan with frames | --frames: | plan two-spheres --frames 3
bad plan to a full device | standard output|/dev/full | plan two-spheres --json /dev/full
bad an unknown study | nope: .*lemma | experiment nope

0 the default | run two-spheres -v --json default.json | ^method     boxes; promises to miss nothing$
  | ^default    no --method: boxes misses nothing, and is the fastest on[ ]
  | ^           others: far, cullide, quick-cullide, s-cullide, i-collide or exact$
  | @default.json ^  "method": "boxes",$ | @default.json ^  "method_reason": "no --method: boxes misses nothing,[ ]
0 the default of plan | plan two-spheres | ^default    no --method: boxes[ ]
0 named | run two-spheres --method boxes --json named.json | ! ^default | @named.json ^  "method_reason": "--method",$

0 plan | plan far-apart --method far | far, nothing left to draw$ | ^draw +left out +no two objects' boxes | ^not asked +[0-9]
0 plan of a broad phase | plan far-apart --method far --broad-phase triangles | ^draw +left out +no boxes of two triangles
0 plan of everything | plan far-apart --method far --full --no-verify | ^setup +yes[ ] | ^verify +left out[ ]
0 plan as JSON | plan two-spheres --method boxes --json - | "decision": "depends"
0 plan of far inside objects | plan two-spheres --method far --self | ^patches +.*32 patches of at most 320 triangles
0 far inside a small object | verify folded.obj --method far --self -v | boxes alone$ | promises to miss nothing$

0 quick-cullide | run crowd --method quick-cullide {small} --json - | "draws_saved": [1-9] | "promises": false
0 s-cullide | run folded.obj --method s-cullide --self {small} | ^method     s-cullide at 64 px
0 i-collide | verify two-spheres --method i-collide | ^colliding  298 pairs$
0 clusters | run crowd --method cullide --clusters 64,8 {small} -v | clusters of 8
0 a form of cullide | run crowd --method cullide --rounds 1 --clear all --conservative --views x,-x,y,-y,z,-z
  --resolution 64 --device native --json form.json -v
  | ^method     cullide at 64 px, --rounds 1 --clear all --conservative | ^agree, round 1 | @form.json "rounds": 1
  | @form.json "clear": "all" | @form.json "level": "triangles" | @form.json "conservative": true
0 plan of a form | plan crowd --method quick-cullide --rounds 1 --level objects | ^further rounds +left out +--rounds 1
0 plan with misses | plan crowd:60 --method cullide --resolution 256 | ^misses +[67][0-9] of 272 colliding pairs expected, [0-9]+ to [0-9]+$
0 plan of many misses | plan crowd:60 --method cullide --resolution 128 | ^misses +1[67][0-9] of 272 .*; the range is not reliable above 40 %$
0 plan without | plan crowd:60 --method cullide --conservative | ^misses +not predicted: conservative rasterization
0 misses as JSON | plan crowd:60 --method cullide --json - | "misses": \{
0 compare forms | compare two-spheres --methods far,cullide,exact --resolutions 64 --rounds 1 --level objects
  --device native | ^cullide --rounds 1[ ]
0 compare the family | compare two-spheres --methods cullide,quick-cullide,i-collide,exact --resolutions 64
  --device software | ^i-collide +-[ ]
""", small='--resolution 64 --device software', sizes=['', '1', '32,32', '16,32', '32,'])
