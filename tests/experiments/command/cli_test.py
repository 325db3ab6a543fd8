"""The command line: arguments, outputs, devices, interrupts, and what the answers say."""
import glob
import os
import re
import signal
import time

from cli_lab import OUT, case, ended, expect, read, root, rows, snapshot, start, write

VALUES = {'spheres': 'two-spheres --device software --resolution 64 --method far',
          'cullide': 'two-spheres --device software --resolution 64 --method cullide',
          'judge': ['run', 'verify', 'compare']}

name, wide, deep = 'n' * 255, 'ä' * 127, './' * 2045
rows(r"""
$ mkdir folder && echo older >old.json
good.obj << {T}; f 1 2 3; f 1 2 4; f 1 3 4; f 2 3 4
each {0}: | | frob | --frob
each SCENE: | {judge} | | ''
each {0}: | run | nope | two-spheres@nope | two-tori two-spheres
bad a scene and a mesh | two-tori: | run good.obj two-tori
each {0}: | {judge} two-spheres | --frob | --device nope | --device '' | --device 99 | --device -1 | --views | --device | --json
  | --views x --views y | --device x --device y | --json x --json y
bad --views '{views}' | --views: | run two-spheres --views {views}
bad a command among scenes | two-spheres: | run two-spheres verify
bad compare --resolutions '64,{number}' | --resolutions: | compare two-spheres --resolutions 64,{number}
bad compare --repeat '{repeat}' | --repeat: | compare two-spheres --resolutions 64 --repeat {repeat}
bad resolution beyond the device | --resolution: .*limit of this device
  | run two-spheres --method far --device software --resolution 2147483647 --json new.json
bad compared resolution beyond the device | --resolutions: .*limit of this device
  | compare two-spheres --methods far --device software --resolutions 64,2147483647 --json new.json
bad no value for {choice} | {choice}: | run two-spheres --method far {choice}
each {0}: | verify two-spheres | --method far --method far | --no-verify
each {0}: | run two-spheres | --method | --query flags --depth-format 24 --method far
bad a value for a flag | --no-verify: | run two-spheres --no-verify=7
bad scenes with an argument | extra: no built-in scene | scenes extra
bad scenes with two arguments | far-apart: | scenes two-tori far-apart --write new
bad a scene that is not written | two-spheres: .*--write | scenes two-spheres
each {0}: | scenes | --write new
each {0}: | scenes two-spheres | --write ''
each {0}: | scenes far-apart | --json - --write new
bad a suite into a folder with files | \.: is there already | suite .
each {0}: | suite new | --size large | --seed one | --ask cat --seed 2
each {0}: | run | crowd:1 | crowd:400:nan | crowd:400:0.2:1 | crowd::1 | field:1e6 | two-tori:5 | shells:10:1
each {0}: | doctor | extra | --device nope | --device 99
# Without a GPU, the devices that there are.
$ "$farcull" doctor --device hardware >"$out" 2>"$err"; (($? < 2)) || grep -q 'no GPU was found; give software or native$\|EGL: \(lib\|dev\)' "$err"
bad help of nothing known | nope: no such .*terms | help nope
bad help of two topics | terms pairs: no such[ ] | help terms pairs
# Without arguments, and before the help: what to do first.
$ "$farcull" >"$out" 2>"$err"; (($? == 2)) && [[ ! -s $out ]] && tail -n 1 "$err" | grep -q '^farcull --help'
$ head -n 1 "$err" | grep -q '^Give it two meshes' && "$farcull" --help | head -n 1 | grep -q '^Give it two meshes'
# What may have been meant. The twins: nothing is like it, or it is no scene.
bad meshes without a command | good\.obj: .*; try farcull run good\.obj other\.obj --self$ | good.obj other.obj --self
bad a scene without a command | two-tori@far: .*; try farcull run two-tori@far$ | two-tori@far
bad a folder without a command | folder: .*; try farcull clash folder$ | folder
bad a study that is misspelt | acuracy: .*; try farcull experiment accuracy$ | experiment acuracy
bad {other} without a command | {other}: .*; give one of run, verify,[ ] | {other} two-tori
# Names as long as the system takes, though a part of the file is written under another name.
bad a name that is too long | n+: cannot be written: File name too long | run {spheres} --json n{name}
bad a path that is too long | [./]+x: cannot be written: File name too long | run {spheres} --json {deep}x
""", **VALUES, name=name, deep=deep, choice=['--offset', '--depth', '--depth-format', '--query'],
     views=['q', 'x,', '', '0:0:0'], number=['0', '1.5', '', '99999999999999999999'], repeat=['0', '1.5', ''],
     other=['frobnicate', 'x', 'a.txt'])
for word, meant in ('runn', 'run'), ('rum', 'run'), ('compar', 'compare'), ('vrify', 'verify'), ('distnace', 'distance'):
    rows('bad {word} for {meant} | {word}: .*; try farcull {meant} two-tori --self$ | {word} two-tori --self', word=word,
         meant=meant)
for long in name, wide:
    rows('0 a long name | run {spheres} --json {long} --pairs {pair} | @{long} "colliding_pairs" | $ rm {long} {pair}',
         **VALUES, long=long, pair='p' + long[1:])

rows(r"""
each missing/new: cannot be written | run {spheres} | --json missing/new | --pairs missing/new
each good\.obj/new: cannot be written | run {spheres} | --json good.obj/new | --pairs good.obj/new
each folder: cannot be written | run {spheres} | --json folder | --pairs folder
each /dev/full: cannot be written | run {spheres} | --json /dev/full | --pairs /dev/full
each {0}: the path is empty | run {spheres} | --json '' | --pairs ''
each {0}: good\.obj | run | --json good.obj good.obj | --pairs good.obj good.obj
each {0}: | run {spheres} | --json --no-verify | --pairs --no-verify | --pairs new --json new | --pairs - --json -
each missing/new: cannot be written | | compare two-spheres --resolutions 64 --device software --json missing/new
  | scenes --json missing/new | doctor --json missing/new
each standard output: cannot be written | | run {spheres} {to} | run {spheres} --json - {to} | scenes {to} | run --help >/dev/full
  | compare two-spheres --resolutions 64 >closed | --version >closed
each standard output: cannot be written: Broken pipe; let it go | run {spheres} | >broken
each standard output: cannot be written: Broken pipe; name a file instead: {option} FILE$ | run {spheres} | {option} - >broken
# A table that cannot be shown takes no file with it.
2 JSON file beside a broken pipe | run {spheres} --json new.json >broken | @err ^farcull: standard output: | @new.json #-1 ^}$
$ rm new.json
""", **VALUES, to=['>/dev/full', '>closed'], option=['--json', '--pairs'])
if os.getuid() != 0:
    os.chmod('folder', 0o555)
    rows('bad a folder without permission | folder/new: cannot be written: Permission | run {spheres} --json folder/new',
         **VALUES)
else:
    print('note: root may write everywhere, so a folder without permission was not tried')
# A disk that fills in the middle, for once with a real file: files end at 1 KiB.
rows(r"""
bad a file that grows too large | old\.json: cannot be written: File too large | run {spheres} --json old.json
bad a mesh that grows too large | new/first\.off: cannot be written: File too large | scenes far-apart --write new
""", limits={'file_size': 1024}, **VALUES)

rows(r"""
$ mkdir no_vendors broken_egl && echo 'not a library' >broken_egl/libEGL.so.1
bad {gl0} without an EGL vendor | EGL: | __EGL_VENDOR_LIBRARY_FILENAMES=/nonexistent {*gl}
bad {gl0} without EGL vendors in the folder | EGL: | __EGL_VENDOR_LIBRARY_DIRS={PWD}/no_vendors {*gl}
bad {gl0} without libEGL | EGL: libEGL\.so\.1 cannot be loaded | LD_LIBRARY_PATH={PWD}/broken_egl {*gl}
bad {software0} without a driver | EGL: | GALLIUM_DRIVER=nonsense {*software} --device software
bad {software0} with OpenGL 3.3 | EGL: .*older than 4\.3
  | MESA_GL_VERSION_OVERRIDE=3.3 MESA_GLSL_VERSION_OVERRIDE=330 {*software} --device software
# What draws nothing needs no device.
0 far apart without EGL | __EGL_VENDOR_LIBRARY_FILENAMES=/nonexistent run far-apart --method far --device gl | nothing left to draw
0 exact without EGL | __EGL_VENDOR_LIBRARY_FILENAMES=/nonexistent run two-spheres --method exact
# What draws does so on the cores of the CPU where no device was asked for, and says why.
0 far without EGL | __EGL_VENDOR_LIBRARY_FILENAMES=/nonexistent verify {native} --json -
  | ^    "cpu": "no GPU can be used: EGL | ^    "lanes": "[A-Za-z0-9_]+",$
0 cullide without libEGL | LD_LIBRARY_PATH={PWD}/broken_egl run two-spheres --method cullide --resolution 64
  | ^device     cpu, lanes of .*: no GPU can be used:
# The native canvas.
0 far on {cpu} | verify {native} --device {cpu} --json - | ^    "cpu": "--device {cpu}",$ | ^    "depth_bits": 32$
0 occlusion on GL | run {native} --device software --query occlusion --json - | ^  "query": "occlusion",$
""", native='two-spheres --method far --resolution 64', cpu=['native', 'cpu'],
     gl=['run two-spheres --method far --device gl --json old.json', 'doctor',
         'verify two-spheres --method far --device gl --json old.json', 'compare two-spheres --device gl --json old.json'],
     software=['run two-spheres --method far --json old.json', 'verify two-spheres --method far --json old.json',
               'compare two-spheres --json old.json', 'doctor'])


def interrupted():
    """A run that is ended leaves whole files or none."""
    met = 0
    for sent in signal.SIGINT, signal.SIGTERM, signal.SIGHUP:
        for delay in 0.02, 0.1, 0.2:
            name, before = f'{sent.name} after {delay} s', snapshot()
            child = start('run random-soup --method far --device software --json new.json --pairs new.csv'.split())
            time.sleep(delay)
            child.send_signal(sent)
            status = ended(child)
            case(name, status in (0, -sent), f'status {status}')
            met += status != 0
            for file in glob.glob('new.*'):
                case(name, re.search(r'[0-9}]\n\Z', read(file)), f'{file} is not whole')
                os.remove(file)
            case(name, before == snapshot(), 'something is left')
    case('interrupts', met > 0, 'every run was done before its signal')


def interrupted_says():
    """Ctrl-C says whether a file was written, here before the run and after the first of two outputs, a pipe without reader."""
    os.mkfifo('fifo')
    for words, begun, said in (('run field:1000000', lambda child: int(re.search(
            r'SigCgt:\s*(\w+)', read(f'/proc/{child.pid}/status'))[1], 16) >> signal.SIGINT - 1 & 1, 'no file was written'), (
            'run two-spheres --pairs new.csv --json fifo', lambda child: os.path.exists('new.csv'), 'files that are written: 1')):
        child = start(words.split())
        while child.poll() is None and not begun(child):
            time.sleep(0.01)
        time.sleep(0.1)
        child.send_signal(signal.SIGINT)
        case(words, ended(child) == -signal.SIGINT, 'not ended by the signal, for which a shell says 130')
        expect(words, f'@err ^farcull: interrupted; {said}$')
    os.remove('fifo')
    os.remove('new.csv')


def interrupted_frames():
    """Frames say how far they came, and what they gave stays. A kill says nothing."""
    for sent in signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGKILL:
        name, before = f'{sent.name} among frames', snapshot()
        child = start('run two-spheres --method boxes --frames 1000000 --json new.json --pairs new.csv'.split())
        for _ in range(200):
            if os.path.exists('new.csv') and read(OUT).count('\n') > 8:
                break
            time.sleep(0.05)
        child.send_signal(sent)
        case(name, ended(child) != 124, 'it goes on')
        if sent != signal.SIGKILL:
            expect(name, '@err ^farcull: interrupted: after [0-9]+ of 1000000 frames; what they gave is written$')
        frames = read('new.json').count('\n      "frame": ')
        for check in f'@new.json ^    "frames": {frames},$', '@new.json #-1 ^}$', '^ +1[ ]', \
                '@new.csv ! ^(?!frame,|[0-9]+,[0-9]+,[0-9]+,[0-9]+,[0-9]+$)':
            expect(name, check)
        os.remove('new.json')
        os.remove('new.csv')
        case(name, before == snapshot(), 'something else is left')


def interrupted_file():
    """In the middle of a large file: 800 x 800 triangles that all cross give 640,000 lines."""
    write('sheets.obj', ''.join(f'v 0 0 {i}.5\nv 1 0 {i}.5\nv 0 1 {i}.5\nf -3 -2 -1\n' for i in range(1, 801)))
    write('blades.obj', ''.join(f'v 0.0{i:03} 0.1 0\nv 0.0{i:03} 0.1 900\nv 0.0{i:03} 0.3 400\nf -3 -2 -1\n'
                                for i in range(1, 801)))
    child = start('run sheets.obj blades.obj --method exact --no-verify --pairs pairs.csv'.split())
    while child.poll() is None and not (met := glob.glob('pairs.csv.part-*')):
        pass
    child.terminate()
    status = ended(child)
    if not met:
        print('note: the large file was written too fast to be interrupted')
    if met and status:
        expect('interrupt while writing', '@err ^farcull: interrupted; no file was written$')
    case('interrupt while writing', status == 0 or status == -signal.SIGTERM and not glob.glob('pairs.csv*'),
         f'status {status}, left: {glob.glob("pairs.csv*")}')


interrupted()
interrupted_says()
interrupted_frames()
interrupted_file()

rows(r"""
0 {command} --help | {*command} --help | ^Examples:$ | ^  farcull {command}
0 --help | --help | ^  farcull run
0 --version | --version
0 help | help | ^  farcull help terms[ ] | $ cmp -s "$out" <("$farcull" --help)
0 help experiment accuracy | help experiment accuracy | $ cmp -s "$out" <("$farcull" experiment accuracy --help)
0 help {topic} | help {topic} | $ cmp -s "$out" {root}/docs/help/{topic}.txt
0 scenes | scenes | ^two-spheres[ ] | ^Frame 0 is where a motion begins,
0 help scenes | help scenes | ^Frame 0 is where a motion begins,
0 scenes as JSON | scenes --json - | "name": "two-spheres"
0 a scene as meshes | scenes crowd:5:2@far --write crowd | ^farcull run crowd/scene\.json$
0 run | run {spheres} | ^scene      two-spheres: 2 objects, 10,240 triangles$ | #0 ^colliding[ ] | ! .{81} | ! left out | [ ]\+ 0 missed$
0 cullide misses | run {cullide} | [ ]\+ [1-9][0-9,]* missed$
0 stages | run {spheres} -v | ^stage +ms +in +out$ | ^kept[ ] | ^radius[ ]
0 verify | verify {spheres} | #1 {verified} | ^accounted  26,214,400 pairs =[ ]
1 verify cullide | verify {cullide} | @err ^farcull: cullide at 64 px[ ] | ! {verified}
  | ^NOT verified: [1-9][0-9,]* colliding pairs were culled, 26,214,400 pairs accounted for$
0 verify frames | verify two-spheres --frames 2 | ^accounted  52,428,800 pairs =[ ]
  | #-3 ^verified: no colliding pair was culled, 52,428,800 pairs accounted for$
# Colours are for terminals alone, and not where NO_COLOR is set.
$ script -qec "env TERM=xterm '$farcull' verify two-spheres" /dev/null </dev/null >shown 2>&1
$ grep -qF $'\e[1;32mverified: ' shown
$ ! script -qec "env TERM=xterm '$farcull' verify {cullide}" /dev/null </dev/null >shown 2>&1
$ grep -qF $'\e[1;31mNOT verified: ' shown && grep -qF $'\e[1;31mfarcull: cullide at' shown
$ script -qec "env NO_COLOR=1 TERM=xterm '$farcull' verify two-spheres" /dev/null </dev/null >shown 2>&1
$ grep -q '^verified: ' shown
0 compare | compare two-spheres --device software --resolutions 32,64 --repeat 1 --json compare.json | ^cullide +64[ ]
  | ^far +64[ ] | ^exact +-[ ] | @compare.json ^  "runs": \[
# The JSON has every key, stands alone on stdout, and is JSON: farcull's own reader of scene files refuses it for its
# keys and not, with a line, for its syntax.
0 JSON | run {spheres} --json - >record.json | #0 ^\{$ | #-1 ^\}$ | ^  "seed": null,
$ grep -q '^ *"{key}": ' record.json
bad {file} is JSON | {file}: .*key | run {file}
0 JSON of a random scene | run random-soup --method exact --json - | ^  "seed": [0-9]+,
$ ! compgen -G '*.part-*'
""", **VALUES, root=root, command=['run', 'verify', 'compare', 'scenes', 'doctor', 'experiment accuracy'], file=['record.json', 'compare.json'],
     verified='^verified: no colliding pair was culled, 26,214,400 pairs accounted for$',
     topic=['methods', 'pairs', 'scene-file', 'terms'],
     key="""scene name objects triangles degenerate_triangles hash method resolution views budget sampling input double vertex
         snap offset radius_px device vendor renderer version subpixel_bits depth_bits stages ran reason ms in out pcs
         candidate_pairs colliding_pairs verification pairs_total pairs_kept certified_by_boxes certified_by_predicates
         neighbours false_negatives examples time_ms setup cull exact total seed commit""".split())
