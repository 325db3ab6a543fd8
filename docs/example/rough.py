"""Writes three rough sheets that pass through each other, rough0.ply to rough2.ply (docs/results/bench.md, "Scale").
   rough.py N    of N x N cells; 14,008,704 triangles for 1528"""
import array
import math
import random
import sys

n = int(sys.argv[1])
header = ("ply\nformat binary_little_endian 1.0\nelement vertex %d\nproperty double x\nproperty double y\n"
          "property double z\nelement face %d\nproperty list uint uint vertex_indices\nend_header\n")
for s in range(3):
    random.seed(s)
    points, faces = array.array("d"), array.array("I")
    for j in range(n + 1):
        for i in range(n + 1):
            x, y = i + 0.37 * s, j + 0.23 * s
            points.extend((x, y, 20 * math.sin(0.02 * x) * math.sin(0.03 * y) + random.random() + 0.19 * s))
            a = j * (n + 1) + i
            if i < n and j < n:
                faces.extend((3, a, a + 1, a + n + 2, 3, a, a + n + 2, a + n + 1))
    with open("rough%d.ply" % s, "wb") as file:
        file.write((header % ((n + 1) ** 2, 2 * n * n)).encode() + points.tobytes() + faces.tobytes())
