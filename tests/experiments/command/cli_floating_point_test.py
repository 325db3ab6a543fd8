"""The program in a process whose floating-point environment a library has changed before main, as one that was built with
-ffast-math does. Answers are those of any other process; where the environment cannot be set there is an error.
   cli_floating_point_test.py FARCULL LIBRARY, which is tests/experiments/method/disturbed.cpp"""
import os

from cli_lab import others, rows

# Triangles that overlap, in a plane. Flushing makes the first two disjoint, rounding downward or toward zero the second
# two. The third two are disjoint, but meet as zeros.
rows(r"""
tiny-a.obj << v -1.90109156629516e-211 -3.80218313259032e-211 0; v 1.90109156629516e-211 1.90109156629516e-211 0
  ; v 1.90109156629516e-211 -1.90109156629516e-211 0; f 1 2 3
tiny-b.obj << v 3.80218313259032e-211 1.90109156629516e-211 0; v -1.90109156629516e-211 3.80218313259032e-211 0
  ; v 3.80218313259032e-211 -3.80218313259032e-211 0; f 1 2 3
huge-a.obj << v 0 0 0; v 2e150 -1e150 1e150; v 0 2e150 2e150; f 1 2 3
huge-b.obj << v -1e150 4e150 3e150; v -1e150 -3e150 -4e150; v 1e150 -4e150 -3e150; f 1 2 3
subnormal-a.obj << v 0 0 0; v 4e-320 0 0; v 0 4e-320 0; f 1 2 3
subnormal-b.obj << v 4e-320 4e-320 0; v 4e-320 3e-320 0; v 3e-320 4e-320 0; f 1 2 3
$ for name in a b; do (cat tiny-$name.obj && yes 'f 1 2 3' | head -n 19) >many-$name.obj; done
""")
environments = ['none', 'downward']  # floating_point_answers_test.cpp has the others, and certificates
if os.uname().machine == 'x86_64':  # only there does the library know how to set flushing
    environments.append('flush')

for environment in environments:
    callers = {'none': 'rounds to nearest, keeps subnormals',
               'flush': 'rounds to nearest, flushes subnormal results and operands to zero'
               }.get(environment, f'rounds {environment}, keeps subnormals')
    usual, unspaced = environment == 'none', callers.replace(' ', '')  # an answer is wrapped at 80 columns
    values = {
        'env': f"LD_PRELOAD={others[0]} 'FARCULL_DISTURB={environment}'", 'environment': environment, 'callers': callers,
        'says': '! ^floats' if usual else f'~ floatsroundstonearest,keepssubnormals;thecaller{unspaced}',
        'frames': '! ^floats' if usual else f'~ floats.*;thecaller{unspaced}',
        'host': 'thesame' if usual else f'{unspaced}.setaside.'}
    for scene, pairs in ('tiny', 1), ('huge', 1), ('subnormal', 0):
        rows(r"""
0 {scene}, {environment}, {method} | {env} verify {scene}-a.obj {scene}-b.obj --method {method} --json r.json | {says}
  | @r.json "colliding_pairs": {pairs}, | @r.json "false_negatives": 0,
""", scene=scene, pairs=str(pairs), method=['exact', 'boxes', 'far', 'i-collide'], **values)
    # Every contestant, with several threads; they find all pairs and agree.
    rows(r"""
0 frames, {environment} | {env} verify two-spheres --method boxes --frames 2 --json f.json | {frames}
  | @f.json "floating_point": \{
0 bench, {environment} | {env} bench many-a.obj many-b.obj --device cpu --repeat 1 --json b.json
  | @b.json "disagreement": null | @b.json "pairs": 400,?$
""", **values)
    if environment in ('none', environments[-1]):
        rows(r"""
0 doctor, {environment} | {env} doctor --device software --json d.json | @d.json "rounding": "to nearest"
  | ~ arithmeticofthehost:roundstonearest,keepssubnormals;thecaller's:{host}
""", limits={'seconds': 300, 'memory': None}, **values)

# Twin: where the environment stays as it is, whatever we do, the program says so and answers nothing.
rows(r"""
bad {environment} stays | arithmetic: this thread (rounds downward|.*flushes)
  | LD_PRELOAD={library} FARCULL_DISTURB={environment} FARCULL_DISTURB_STAYS=1 verify tiny-a.obj tiny-b.obj --method exact
""", library=others[0], environment=environments[1:])
