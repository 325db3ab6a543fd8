"""Does my cloth intersect itself, where, and since which frame? A cloth falls on a sphere."""

import farcull

collider = farcull.Collider(self=[True, False])  # the cloth against itself; the sphere is not
since = None
for frame, scene in farcull.Frames("cloth:500", frames=30):
    result = collider.find(scene.vertices, scene.triangles, scene.object_starts)
    # Both triangles of the cloth, which is the first object.
    inside = result.pairs[result.pairs.max(axis=1) < scene.object_starts[1]]
    if len(inside) and since is None:
        since = frame
        corners = scene.vertices[scene.triangles[inside]]  # (k, 2, 3, 3): pair, triangle, corner, xyz
        where = corners.reshape(-1, 3).mean(axis=0)
        print(f"since frame {since}: {len(inside)} pairs, around", *where.round(2))
if since is None:
    print("the cloth never intersects itself")
