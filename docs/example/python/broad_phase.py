"""A broad phase for ipc-toolkit: candidates of edges, vertices and faces whose swept boxes overlap.

The methods are those of ipctk.BroadPhase, and the candidates those of its brute force: two of them with
boxes that have a point in common, and no common vertex. Each box holds the motion from t0 to t1, grown by
the inflation radius. A candidate is a row of numbers; ipctk takes them as in
[ipctk.FaceVertexCandidate(f, v) for f, v in broad.detect_face_vertex_candidates().tolist()].
"""

import farcull
import numpy as np


class BroadPhase:
    def build(self, vertices_t0, vertices_t1, edges, faces, inflation_radius=0.0):
        """vertices_t0, vertices_t1: (n, 3), or (n, 2) in the plane; edges (m, 2), faces (k, 3)."""
        corners = np.stack([vertices_t0, vertices_t1]).astype(float)
        if corners.shape[2] == 2:
            corners = np.concatenate([corners, np.zeros((*corners.shape[:2], 1))], axis=2)
        # A sum is rounded by less than the step to the next number, so the true one lies within.
        lo = np.nextafter(corners.min(axis=0) - inflation_radius, -np.inf)
        hi = np.nextafter(corners.max(axis=0) + inflation_radius, np.inf)
        self._indices = {
            "vertex": np.arange(len(lo))[:, None],
            "edge": np.asarray(edges, int).reshape(-1, 2),
            "face": np.asarray(faces, int).reshape(-1, 3),
        }
        self._boxes = {
            kind: (lo[of].min(axis=1), hi[of].max(axis=1)) for kind, of in self._indices.items()
        }

    def clear(self):
        self._indices = self._boxes = None

    def detect_edge_vertex_candidates(self):
        """(k, 2): edge, vertex."""
        return self._candidates("edge", "vertex")

    def detect_edge_edge_candidates(self):
        """(k, 2): two edges, the lower number first."""
        pairs = self._candidates("edge", "edge")
        return pairs[pairs[:, 0] < pairs[:, 1]]

    def detect_face_vertex_candidates(self):
        """(k, 2): face, vertex."""
        return self._candidates("face", "vertex")

    def detect_edge_face_candidates(self):
        """(k, 2): edge, face."""
        return self._candidates("edge", "face")

    def _candidates(self, first, second):
        pairs = overlapping(self._boxes[first], self._boxes[second])
        a, b = self._indices[first][pairs[:, 0]], self._indices[second][pairs[:, 1]]
        shared = (a[:, :, None] == b[:, None, :]).any(axis=(1, 2))
        return pairs[~shared]


def reach(boxes):
    """Half of the longest diagonal, rounded up: six operations round by 2^-53 each, or by 2^-1074 where
    the numbers are that small."""
    lo, hi = boxes
    return np.hypot.reduce(hi - lo, axis=1).max() / 2 * (1 + 2**-49) + 1e-300


def overlapping(first, second):
    """(k, 2): the boxes of two lists (lo, hi) that have a point in common, in the order of the rows.

    Each box is given to farcull as its diagonal, which is a triangle of two equal corners. A point of a box
    is at most half of the diagonal from its middle. So the diagonals of two boxes with a common point are
    at most `reach(first) + reach(second)` apart, and farcull finds every pair that near. Comparing the
    boxes then leaves the right ones.

    The lists are two objects, also where they are the same: triangles of one object that share a corner
    are neighbours, which farcull reports under other conditions.
    """
    (a_lo, a_hi), (b_lo, b_hi) = first, second
    if not len(a_lo) or not len(b_lo):
        return np.empty((0, 2), int)
    corners = np.concatenate([a_lo, b_lo, a_hi, b_hi])
    low = np.arange(len(corners) // 2)
    diagonals = np.stack([low, low + len(low), low + len(low)], axis=1)
    pairs = farcull.collide(
        corners, diagonals, [0, len(a_lo)], clearance=reach(first) + reach(second)
    ).pairs - [0, len(a_lo)]
    a, b = pairs.T
    return pairs[((a_lo[a] <= b_hi[b]) & (b_lo[b] <= a_hi[a])).all(axis=1)]
