// What Gappa cannot express, and where it is proved by hand.
#include "tests/proofs/bounds.h"

namespace farcull::proofs {

std::vector<ByHand> proved_by_hand() {
  return {
      {"A rounded result is x (1 + d) + f, with the bounds on d and f that each arithmetic names",
       "IEEE 754 for doubles and floats to nearest; the GLSL specification 4.50, section 4.7.1",
       "every row: it is how an operation is written in the scripts"},
      {"Where products overflow, the bound of a filter is infinite or not a number, and no "
       "comparison "
       "with it holds",
       "the comment of `verify/filter_scalars.h`, \"Overflow\"",
       "the rows `filter.*` and `distance.*`, which have no largest number"},
      {"The length of a vector is at most that of another plus that of their difference",
       "the triangle inequality",
       "`filter.component` with `filter.clearance_length`; `fit.corner`"},
      {"Rounding never decreases with x, so least and largest computed numbers are those of some "
       "corner",
       "each operation is rounded to the nearest number, or in one direction",
       "`distance.gap`, `fit.box`, `extent.corner`: they speak of one corner"},
      {"Signs of determinants decide on which side corners lie, and what two triangles on a line "
       "share",
       "the comments of `verify/filter_scalars.h` and `verify/filter_planes.inl`",
       "`filter.side`, `filter.normals`, `filter.projection`"},
      {"Every point of the exact triangle inside the planes has a partner on the fan of the "
       "computed "
       "corners (winding numbers)",
       "[budget.md](budget.md), \"Clipping and the fan\"; Coq, `Fan.v`", "`map.point`, `clip.cut`"},
      {"A centre inside the exact proxy by more than the displacement of its corners stays inside "
       "(winding numbers)",
       "[reliability.md](reliability.md), \"One view\"; Coq, `View.v`",
       "`budget.input`, `budget.vertex`, and the term `snap`"},
      {"The doubles of a proxy's rectangle err by less than 2^-48 M; turned normals add less than "
       "2^-20 "
       "of a corner's displacement",
       "[budget.md](budget.md), \"input\" and \"The canvas on the CPU\"",
       "`budget.input`, `budget.input_on_cpu`: both are in the scripts as hypotheses"},
      {"A halfspace n . p <= max n . v_i + r |n| holds the solid, for any n that is one value",
       "[budget.md](budget.md), \"The exact offset\" and \"One normal\"",
       "`extent.*`, then `halfspace.*`"},
      {"|n| is at most (1 + |n|^2) / 2", "(1 - |n|)^2 is not negative",
       "`fit.box_radius`, `extent.ball`"},
      {"A component of n or v below 2^-126 may be read as zero at one use and not at another: at "
       "most "
       "2^-85 px",
       "[budget.md](budget.md), \"One normal\"",
       "`extent.ball` leaves 14 u of the ball, where u r is at least 2^-24 px"},
      {"Of the steps of a slab, a point of the solid has |s| <= h + |a_z| |z - m_z|, and its depth "
       "is "
       "between the two quotients",
       "[budget.md](budget.md), \"The oriented box\"",
       "`slab.doubt`, `slab.height`, then `slab.parallel`, or `slab.end` and `slab.depth`"},
      {"Of all ways in which two programs may round the depth map, up everywhere and down "
       "everywhere "
       "are the worst",
       "[budget.md](budget.md), \"Two programs\"", "`depth.behind`, which is about these two"},
      {"Passes, views and rounds keep both triangles of every colliding pair",
       "[reliability.md](reliability.md), \"Passes, views, rounds\", theorem 2; Coq, "
       "`PassProofs.v`",
       "none: theorem 1 alone joins it to geometry"},
  };
}

}  // namespace farcull::proofs
