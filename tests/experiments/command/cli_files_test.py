"""Files that are no meshes, scene files or places for an answer: each ends soon, within an address space too small for what
its header claims, and leaves nothing behind. And files of every format that are read."""
import os
import struct

from cli_lab import bad, rows, write

FORMATS = ['obj', 'off', 'ply', 'stl', 'json']
BILLION, ONE = 1_000_000_000, 0x3f800000
TETRAHEDRON = '0 0 0', '1 0 0', '0 1 0', '0 0 1'


def words(*numbers):
    """Four bytes for each, lowest first."""
    return struct.pack(f'<{len(numbers)}I', *(number % 2**32 for number in numbers))


def lines(*texts):
    return '\n'.join([*texts, ''])


def obj(*texts):
    return lines(*(f'v {vertex}' for vertex in TETRAHEDRON), *texts)


def off(faces, *texts):
    return lines('OFF', f'4 {faces} 0', *TETRAHEDRON, *texts)


def ply_header(kind, vertices, faces):
    return lines('ply', f'format {kind} 1.0', f'element vertex {vertices}', 'property float x', 'property float y',
                 'property float z', f'element face {faces}', 'property list uchar int vertex_indices', 'end_header')


def ply(faces, *texts):
    return ply_header('ascii', 4, faces) + lines(*TETRAHEDRON, *texts)


def ply_binary():
    return (ply_header('binary_little_endian', 3, 1).encode() + words(0, 0, 0, ONE, 0, 0, 0, ONE, 0) + b'\x03'
            + words(0, 1, 2))


def stl(*vertices):
    return lines('solid s', 'facet normal 0 0 1', 'outer loop', *(f'vertex {vertex}' for vertex in vertices), 'endloop',
                 'endfacet', 'endsolid s')


def stl_binary(count=1):
    return bytes(80) + words(count, 0, 0, ONE, 0, 0, 0, ONE, 0, 0, 0, ONE, 0) + b'\0\0'


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

# A file of each format that is cut short, and one whose header promises a billion. mesh_formats_test.cpp has the others.
for name, file, content, said in (
        ('truncated obj', 'truncated.obj', 'v 0 0 0\nv 1 0', ':2: '),
        ('truncated off', 'truncated.off', 'OFF\n4 1 0\n0 0 0\n1 0 0\n', ANY),
        ('truncated binary ply', 'truncated.ply', ply_binary()[:-3], ': '),
        ('truncated binary stl', 'truncated.stl', stl_binary()[:-3], ': '),
        ('truncated scene file', 'truncated.json', '{"objects": [\n{"mesh":', ':2: '),
        ('off of a billion faces', 'billion.off', off(BILLION, '3 0 1 2'), ANY),
        ('ply of a billion vertices', 'billion.ply', ply_header('binary_big_endian', BILLION, 1), ANY),
        ('stl of a billion triangles', 'billion.stl', stl_binary(BILLION), ': '),
        ('a vertex that is no number', 'number.obj', obj('v 0 nan 0', 'f 1 2 5'), ':5: '),
        ('a face of no vertex', 'face.obj', obj('f 1 2 5'), ':5: ')):
    scene(name, file, content, said)
write('good.obj', obj('f 1 2 3', 'f 1 2 4', 'f 1 3 4', 'f 2 3 4'))
scene('a scene file of an unknown key', 'bad.json', '{"objects": [{"meshes": "good.obj"}]}', r': objects\[0\]\.meshes ')
rows(r"""
nested.json << {"objects":; [{"mesh": "face.obj"}]}
bad scene file with a bad mesh | .*face\.obj:5: | run nested.json {outputs}
""", outputs=' '.join(OUTPUTS))

# Every format that is good; an older file that is replaced, a link that stays a link.
for name, content in (
        ('good.off', off(2, '3 0 1 2', '4 0 1 2 3')), ('good.ply', ply(1, '3 0 1 2')), ('good_binary.ply', ply_binary()),
        ('good.stl', stl('0 0 0', '1 0 0', '0 1 0')), ('good_binary.stl', stl_binary())):
    write(name, content)
rows(r"""
0 {mesh} | run good.obj {mesh} {far} --pairs pairs.csv --json old.json | @pairs.csv ^0,[0-9]+,1,[0-9]+$
  | @pairs.csv #0 ^object_a,triangle_a,object_b,triangle_b$ | @old.json ^  "seed": null,
  | $ grep -q "^  \"colliding_pairs\": $(($(wc -l <pairs.csv) - 1)),$" old.json
good.json << {"name": "s", "objects": [{"mesh": "good.obj"}, {"mesh": "good.off", "scale": 2}]}
$ echo older >old.json && ln -s old.json link.json
0 scene file | run good.json {far} --json link.json | @old.json "name": "s", | $ [[ -L link.json ]]
0 JSON to /dev/stdout | run good.json {far} --json /dev/stdout | ^  "method": "far",
$ ! compgen -G '*.part-*'
""", mesh=['good.off', 'good.ply', 'good_binary.ply', 'good.stl', 'good_binary.stl'],
     far='--method far --device software --resolution 64')
