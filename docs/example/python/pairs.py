"""From arrays to colliding pairs: two tetrahedra, one with a corner inside the other."""

import farcull
import numpy as np

tetrahedron = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], dtype=float)
faces = np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]])

V, F, objects = farcull.join((tetrahedron, faces), (tetrahedron + 0.25, faces))
result = farcull.collide(V, F, objects)
for a, b in result.pairs:
    print(f"triangle {a} of the first and triangle {b - objects[1]} of the second")
