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


def ply_header(kind, vertices, faces, count='uchar'):
    return lines('ply', f'format {kind} 1.0', f'element vertex {vertices}', 'property float x', 'property float y',
                 'property float z', f'element face {faces}', f'property list {count} int vertex_indices', 'end_header')


def ply(faces, *texts):
    return ply_header('ascii', 4, faces) + lines(*TETRAHEDRON, *texts)


def ply_binary(first=0, face=b'\x03' + words(0, 1, 2), count='uchar'):
    return ply_header('binary_little_endian', 3, 1, count).encode() + words(first, 0, 0, ONE, 0, 0, 0, ONE, 0) + face


def stl(*vertices):
    return lines('solid s', 'facet normal 0 0 1', 'outer loop', *(f'vertex {vertex}' for vertex in vertices), 'endloop',
                 'endfacet', 'endsolid s')


def stl_binary(count=1, first=0):
    return bytes(80) + words(count, 0, 0, ONE, first, 0, 0, ONE, 0, 0, 0, ONE, 0) + b'\0\0'


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

# Truncated; and a header that promises a billion.
corners = words(BILLION, 0, 1, 2)
for name, file, content, said in (
        ('truncated obj', 'truncated.obj', 'v 0 0 0\nv 1 0', ':2: '),
        ('obj without a face', 'no_face.obj', obj(), ': '),
        ('truncated off', 'truncated.off', 'OFF\n4 1 0\n0 0 0\n1 0 0\n', ANY),
        ('off with a face too few', 'one_face.off', off(2, '3 0 1 2'), ANY),
        ('truncated off header', 'header.off', 'OFF\n4', ':2: '),
        ('truncated ply', 'truncated.ply', ply(2, '3 0 1 2'), ANY),
        ('truncated ply header', 'header.ply', ply(1, '3 0 1 2')[:60], ANY),
        ('truncated binary ply', 'truncated_binary.ply', ply_binary()[:-3], ': '),
        ('truncated stl', 'truncated.stl', lines(*stl('0 0 0', '1 0 0', '0 1 0').split('\n')[:5]), ANY),
        ('truncated binary stl', 'truncated_binary.stl', stl_binary()[:-3], ': '),
        ('truncated scene file', 'truncated.json', '{"objects": [\n{"mesh":', ':2: '),
        ('off of a billion vertices', 'billion_vertices.off', f'OFF\n{BILLION} 1 0\n0 0 0\n', ANY),
        ('off of a billion faces', 'billion_faces.off', off(BILLION, '3 0 1 2'), ANY),
        ('off with a billion corners', 'billion_corners.off', off(1, f'{BILLION} 0 1 2'), ':7: '),
        ('binary ply with a billion corners', 'billion_corners.ply', ply_binary(0, corners, 'uint'), ': '),
        ('stl of a billion triangles', 'billion.stl', stl_binary(BILLION), ': '),
        ('binary ply with an index out of range', 'index.ply', ply_binary(0, b'\x03' + words(0, 1, 3)), ': '),
        ('binary ply with two corners', 'polygon.ply', ply_binary(0, b'\x02' + words(0, 1)), ': '),
        ('stl with two corners', 'polygon.stl', stl('0 0 0', '1 0 0'), ':6: ')):
    scene(name, file, content, said)
for kind in 'ascii', 'binary_little_endian', 'binary_big_endian':
    scene(f'{kind} ply of a billion vertices', 'billion_vertices.ply', ply_header(kind, BILLION, 1), ANY)
    scene(f'{kind} ply of a billion faces', 'billion_faces.ply', ply_header(kind, 0, BILLION), ANY)

# Numbers that are no coordinates; indices; polygons.
for number in 'nan', 'NaN', 'inf', '-inf', 'infinity', '1e999', '-1e999':
    vertex = f'0 {number} 0'
    scene(f'obj with {number}', 'number.obj', obj(f'v {vertex}', 'f 1 2 5'), ':5: ')
    scene(f'off with {number}', 'number.off', off(1, '3 0 1 2').replace('0 1 0', vertex), ':5: ')
    scene(f'ply with {number}', 'number.ply', ply(1, '3 0 1 2').replace('0 0 0', vertex), ':10: ')
    scene(f'stl with {number}', 'number.stl', stl(vertex, '1 0 0', '0 1 0'), ':4: ')
    scene(f'scene file with {number}', 'number.json',
          f'{{"objects": [{{"mesh": "good.obj", "translate": [0, {number}, 0]}}]}}', ':1: ')
for word in 0x7fc00000, 0x7f800000, 0xff800000:  # nan, infinity, -infinity
    scene(f'binary ply with {word}', 'number.ply', ply_binary(word))
    scene(f'binary stl with {word}', 'number.stl', stl_binary(1, word))
for face in '1 2 5', '0 1 2', '1 2 -5', '1 2 99999999999999999999', '1 2 4294967297', '1 2 x', '1 2':
    scene(f'obj with f {face}', 'face.obj', obj(f'f {face}'), ':5: ')
for face in '3 0 1 4', '3 0 1 -1', '3 0 1 99999999999999999999', '3 0 1 4294967296', '2 0 1', '0 0 0 0', '-1 0 1 2', '3 0 1':
    scene(f'off with face {face}', 'face.off', off(1, face), ':7: ')
    scene(f'ply with face {face}', 'face.ply', ply(1, face), ':14: ')

# Scene files.
write('good.obj', obj('f 1 2 3', 'f 1 2 4', 'f 1 3 4', 'f 2 3 4'))
for said, text in (
        (': .*objects', '{}'), (': .*objects', '{"objects": []}'), (': .*objects', '{"objects": 7}'), (': ', '[]'), (': ', '7'),
        (': .*objects', '{"objects": {"mesh": "good.obj"}}'),
        (': surprise ', '{"objects": [{"mesh": "good.obj"}], "surprise": 1}'),
        (r': objects\[0\]\.meshes ', '{"objects": [{"meshes": "good.obj"}]}'),
        (r': objects\[0\]', '{"objects": [7]}'), (r': objects\[0\]', '{"objects": [{"name": "a"}]}'),
        (r': objects\[0\]\.mesh', '{"objects": [{"mesh": 7}]}'),
        (r': objects\[0\]\.name', '{"objects": [{"mesh": "good.obj", "name": 7}]}'),
        (r': objects\[0\]\.scale', '{"objects": [{"mesh": "good.obj", "scale": "big"}]}'),
        (r': objects\[0\]\.scale', '{"objects": [{"mesh": "good.obj", "scale": 0}]}'),
        (r': objects\[1\]\.translate', '{"objects": [{"mesh": "good.obj"}, {"mesh": "good.obj", "translate": [1, 2]}]}'),
        (r': objects\[0\]\.rotate', '{"objects": [{"mesh": "good.obj", "rotate": [0, 0, 1, 0.5]}]}'),
        (r': objects\[0\]\.rotate\.axis',
         '{"objects": [{"mesh": "good.obj", "rotate": {"axis": [0, 0, 0], "angle": 1}}]}'),
        (r': objects\[0\]\.split', '{"objects": [{"mesh": "good.obj", "split": "halves"}]}'),
        (": .*'mesh'", '{"objects": [{"mesh": "good.obj", "mesh": "good.obj"}]}'),
        (':1: ', '{"objects": [{"mesh": "good.obj",}]}'), (':1: ', '{"objects": [{"mesh": "good.obj"}]} more')):
    scene(f'scene file {text}', 'bad.json', text + '\n', said)
scene('scene file of 200000 brackets', 'deep.json', '[' * 200_000, ':1: ')
rows(r"""
nested.json << {"objects":; [{"mesh": "missing.obj"}]}
bad scene file with a missing mesh | .*missing\.obj: the file does not exist | run nested.json {outputs}
nested.json << {"objects":; [{"mesh": "face.obj"}]}
bad scene file with a bad mesh | .*face\.obj:5: | run nested.json {outputs}
nested.json << {"objects": [{"mesh": "nested.json"}]}
bad scene file that names itself | .*nested\.json: | run nested.json {outputs}
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
