"""Files that are no meshes, scene files or places for an answer: each ends soon, within an address space too small for what
its header claims, and leaves nothing behind."""
import os

from cli_lab import bad, rows, write

FORMATS = ['obj', 'off', 'ply', 'stl', 'json']
BILLION = 1_000_000_000
TETRAHEDRON = '0 0 0', '1 0 0', '0 1 0', '0 0 1'


def lines(*texts):
    return '\n'.join([*texts, ''])


def obj(*texts):
    return lines(*(f'v {vertex}' for vertex in TETRAHEDRON), *texts)


def off(faces, *texts):
    return lines('OFF', f'4 {faces} 0', *TETRAHEDRON, *texts)


OUTPUTS = ['--json', 'old.json', '--pairs', 'new.csv']


def scene(name, file, content, said=': '):
    """A file that is refused, while outputs are asked for. What is said begins with its name."""
    write(file, content)
    bad(name, file.replace('.', r'\.') + said, ['run', file, *OUTPUTS])


ANY = r'(:[0-9]+)?: '  # a line or none
write('old.json', 'older\n')
garbage = bytes((i * 167 + 205) % 256 for i in range(256)) * 16  # every byte
for format in FORMATS:
    scene(f'empty {format}', f'empty.{format}', '', ': the file is empty')
    scene(f'garbage {format}', f'garbage.{format}', garbage, ANY)
    os.mkdir(f'folder.{format}')
    os.mkfifo(f'pipe.{format}')
rows(r"""
$ mkdir folder && cp garbage.obj no_extension
bad missing {format} | missing\.{format}: the file does not exist | run missing.{format} {outputs}
bad folder {format} | folder\.{format}: is a directory | run folder.{format} {outputs}
bad pipe {format} | pipe\.{format}: is not a regular file | run pipe.{format} {outputs}
bad folder as scene | folder: | run folder {outputs}
bad no extension | no_extension: | run no_extension {outputs}
bad other extension | mesh\.3ds: | run mesh.3ds {outputs}
bad a name in braces | x[{]left[}]\.obj: the file does not exist | run x{left}.obj {outputs}
""", format=FORMATS, outputs=' '.join(OUTPUTS))
bad('two lines in a name', r'a\?b\.obj: ', ['run', 'a\nb.obj', *OUTPUTS])
if os.getuid() != 0:
    write('secret.obj', obj('f 1 2 3'))
    os.chmod('secret.obj', 0)
    bad('unreadable', r'secret\.obj: cannot be opened', ['run', 'secret.obj', *OUTPUTS])
else:
    print('note: root may read everything, so an unreadable file was not tried')

# Files that are cut short, and one whose header promises a billion. mesh_formats_test.cpp has those of every format.
for name, file, content, said in (
        ('truncated off', 'truncated.off', 'OFF\n4 1 0\n0 0 0\n1 0 0\n', ANY),
        ('truncated scene file', 'truncated.json', '{"objects": [\n{"mesh":', ':2: '),
        ('off of a billion faces', 'billion.off', off(BILLION, '3 0 1 2'), ANY),
        ('a face of no vertex', 'face.obj', obj('f 1 2 5'), ':5: ')):
    scene(name, file, content, said)
write('good.obj', obj('f 1 2 3', 'f 1 2 4', 'f 1 3 4', 'f 2 3 4'))
scene('a scene file of an unknown key', 'bad.json', '{"objects": [{"meshes": "good.obj"}]}', r': objects\[0\]\.meshes ')
rows(r"""
nested.json << {"objects":; [{"mesh": "face.obj"}]}
bad scene file with a bad mesh | .*face\.obj:5: | run nested.json {outputs}
gone.json << {"objects":; [{"mesh": "good.obj"}, {"mesh": "gone.obj"}]}
bad scene file with a missing mesh | gone\.obj: the file does not exist; .*: objects\[1\]\.mesh in line 2 of gone\.json names this one$ | run gone.json {outputs}
$ cat good.obj good.obj > good.stl
bad OBJ named .stl | good\.stl: is text that does not begin with 'solid', not STL; rename it$ | run good.stl {outputs}
""", outputs=' '.join(OUTPUTS))

# Good files (gzip_test.cpp loads those of every format); an older file that is replaced, a link that stays a link.
write('good.off', off(2, '3 0 1 2', '4 0 1 2 3'))
rows(r"""
0 two meshes | run good.obj good.off {far} --pairs pairs.csv --json old.json | @pairs.csv ^0,[0-9]+,1,[0-9]+$
  | @pairs.csv #0 ^object_a,triangle_a,object_b,triangle_b$ | @old.json ^  "seed": null,
  | $ grep -q "^  \"colliding_pairs\": $(($(wc -l <pairs.csv) - 1)),$" old.json
good.json << {"name": "s", "objects": [{"mesh": "good.obj"}, {"mesh": "good.off", "scale": 2}]}
$ echo older >old.json && ln -s old.json link.json
0 scene file | run good.json {far} --json link.json | @old.json "name": "s", | $ [[ -L link.json ]]
0 JSON to /dev/stdout | run good.json {far} --json /dev/stdout | ^  "method": "far",
$ ! compgen -G '*.part-*'
""", far='--method far --device software --resolution 64')
