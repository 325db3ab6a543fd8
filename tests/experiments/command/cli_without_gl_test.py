"""The program built without OpenGL: what needs none answers as always, and the rest says why not.
   cli_without_gl_test.py WITHOUT_GL [WITH_GL]
WITHOUT_GL must not refer to OpenGL at all; WITH_GL, where it is given, is the twin that does."""
import shutil
import subprocess

from cli_lab import case, others, program, rows

if shutil.which('nm'):
    for path, refers in (program, False), *((twin, True) for twin in others):
        symbols = subprocess.run(['nm', '-u', path], stdout=subprocess.PIPE, check=True).stdout
        case(f'references of {path} to OpenGL', (b'epoxy_' in symbols) == refers, f'not {refers}')

rows(r"""
0 far | verify two-spheres --method far --resolution 128
0 boxes | verify two-spheres --method boxes
0 doctor | doctor --device native
bad {method} on {device} | {message} | run two-spheres --method {method} --device {device}
bad a picture | {message} | picture two-spheres -o picture.png
""", method=['far', 'cullide'], device=['software', 'hardware', 'gl', '0'],
     message='.*built without OpenGL; use --device native, or build it with -DFARCULL_GL=ON')
