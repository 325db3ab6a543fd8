// Cholesky's factorization of the cloth's matrix by nested dissection of the grid (George 1973) and
// fronts (Duff and Reid 1983): dense blocks, where SimplicialLLT goes number by number
// (docs/cloth.md has the times). Vertices come in blocks of 3 numbers.
#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <cstdint>
#include <span>
#include <vector>

namespace farcull::cloth {

/// A grid of side x side vertices cut in half again and again by lines two vertices wide. Vertices
/// that are at most two rows and two columns apart are on one side of a line, or one is on it.
struct Dissection {
  struct Part {
    std::uint32_t begin = 0;  // its places are begin to end - 1
    std::uint32_t end = 0;
    std::uint32_t parent = 0;  // index of the part that cuts it off; of the last: its own
  };
  std::vector<std::uint32_t> places;  // per vertex, row by row
  std::vector<Part> parts;            // by their places; parents come after what they cut off
};
Dissection dissect(std::uint32_t side);

class Factor {
 public:
  /// The pattern of `matrix`: the lower triangle of a symmetric matrix of 3 x 3 blocks (of which
  /// the diagonal ones are lower triangles), compressed, in the order of places. It couples only
  /// vertices that are at most two rows and two columns apart.
  Factor(const Dissection& dissection, const Eigen::SparseMatrix<double>& matrix);

  /// False iff the matrix, which has the pattern, is not positive definite in double.
  bool factorize(const Eigen::SparseMatrix<double>& matrix);
  /// Precondition: factorize() was last true. In the order of places.
  void solve_in_place(Eigen::VectorXd& x) const;

 private:
  struct Front {
    std::uint32_t begin = 0;  // places that are eliminated here
    std::uint32_t end = 0;
    std::uint32_t parent = 0;
    std::vector<std::uint32_t> rows;   // later places that these are coupled to, ascending
    std::vector<std::uint32_t> above;  // per row: its index among begin ... end, rows of the parent
    Eigen::MatrixXd panel;             // columns of the factor: of begin ... end; above the rest
    Eigen::MatrixXd update;            // what they leave to the parent, lower triangle
  };
  void assemble(const Eigen::SparseMatrix<double>& matrix, Front& front);
  static void extend(const Front& child, Front& parent);

  std::vector<Front> fronts_;
  std::vector<std::vector<std::uint32_t>> children_;
  std::vector<std::uint32_t> index_;  // scratch, per place: its index in the front at hand
};

}  // namespace farcull::cloth
