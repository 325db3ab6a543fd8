"""farcull picture."""
import os
import subprocess

from cli_lab import program, rows

rows(r"""
$ echo older >old.png && mkdir folder
crossing.obj << {T}; v 1 1 -1; v 1 1 1; v 0 0 -1; f 1 2 3; f 5 6 7
bad no scene | SCENE: | picture -o new.png
bad an unknown scene | nowhere | picture nowhere -o new.png
bad a scene that does not move | .*move | picture far-apart --frame 0 -o new.png
bad zoom without a collision | --zoom: | picture far-apart --method exact --zoom -o new.png
bad no output | -o: | {p}
each {0}: | {p} | -o '' | --html - | --frames 5 -o new.png | --compare far:x -o new.png | --compare far --method far -o new.png
  | --view 0:0:0 -o new.png | --up y --view y -o new.png
  | --resolutions 32,64 --method far -o new.png
bad an output named like a mesh | -o: .*mesh | {p} -o crossing.obj
bad a picture that is no PNG | -o: .new.jpg. .*; give -o new.png$ | {p} -o new.jpg
bad a folder for the output | folder: | {p} -o folder
bad no such folder | nofolder/new.png: | {p} -o nofolder/new.png
bad an empty method to compare | --compare: '' | {p} --compare far, -o new.png
bad a resolution for exact | --compare: exact | {p} --compare exact:64 -o new.png
bad seven panels | --compare: 7 | {p} --compare far,far,far,far,far,far,far -o new.png
bad the size '{size}' | --size | {p} --size {size} -o new.png
bad a page named like a mesh | --html: .*mesh | {p} --html crossing.obj
bad a page and a picture in one file | --html | {p} --html new.png -o new.png
bad s-cullide without self | two-spheres: | {p} --method s-cullide -o new.png
each standard output: | {p} --method exact -o - | >closed | >broken
bad no driver | EGL: | __EGL_VENDOR_LIBRARY_FILENAMES=/nowhere {p} --method exact -o new.png
""", p='picture two-spheres', size=['', '100', '61x80', '100x4097'])
if os.getuid() != 0:
    rows(r"""
$ mkdir locked && chmod a-w locked
bad a folder without permission | locked/new.png: | picture two-spheres -o locked/new.png
""")

rows(r"""
$ printf '\x89PNG\r\n\x1a\n' >signature
0 help | picture --help | --zoom
0 cullide | picture two-spheres --method cullide --resolution 64 {small} -o cullide.png | $ cmp -sn 8 signature cullide.png
  | ^cullide at 64 px: missed [1-9][0-9,]* of [0-9,]+ colliding pairs$ | ^The picture is in cullide.png$
0 compare | picture two-spheres --compare cullide:32,far:64,exact {small} -o old.png | $ cmp -sn 8 signature old.png
  | ^far at 64 px: missed 0 of[ ] | ^exact: missed 0 of[ ] | @old.png Scene hash
0 ignored | picture crowd:40 --method exact --ignore '*1:*2' {small} -o i.png | ^exact: missed 0 of[ ]
0 standard output | picture crossing.obj --method exact --self {small} -o - | $ cmp -sn 8 signature "$out"
0 a frame | picture two-spheres --method exact --frame 3 --frames 10 {small} -o f.png
0 a ground a thousand times larger | picture two-spheres@ground --method exact --zoom {small} -o g.png
""", small='--size 100x80')

page = ['picture', 'two-spheres', '--method', 'exact', '--size', '100x80', '--html', 'page.html']
if b'three.js' in subprocess.run([program, *page], capture_output=True, check=False).stderr:
    rows(r"""
bad a page without three.js | --html: .*libjs-three | picture two-spheres --method exact --html new.html
""")
else:
    rows(r"""
bad too many objects for a page | --html: .*70,000 objects.*65,536 | picture crowd:70000 --html new.html
0 a page | picture two-spheres --compare cullide,exact --resolutions 32,64 --size 100x80 --html page.html
  | ^cullide at 32 px: missed [1-9] | ^exact: missed 0 of[ ] | ^The page is in page.html .[0-9.]* MB.$
  | @page.html ^<!DOCTYPE html> | @page.html three.js
""")
