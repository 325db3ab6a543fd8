// Numbers the grid by nested dissection, then factors part by part with dense matrices of Eigen.
#include "experiments/scenes/cloth/cloth.h"

#include <Eigen/Cholesky>
#include <algorithm>

namespace farcull::cloth {
namespace {

constexpr std::uint32_t kSmallest = 5;  // a part of at most this many rows and columns stays whole

struct Dissector {
  std::uint32_t side;
  std::uint32_t next = 0;
  Dissection result;

  std::uint32_t number(std::uint32_t i0, std::uint32_t i1, std::uint32_t j0, std::uint32_t j1) {
    const std::uint32_t begin = next;
    for (std::uint32_t j = j0; j < j1; ++j) {
      for (std::uint32_t i = i0; i < i1; ++i) result.places[j * side + i] = next++;
    }
    const auto part = static_cast<std::uint32_t>(result.parts.size());
    result.parts.push_back({begin, next, part});
    return part;
  }

  // Columns i0 to i1 - 1 of rows j0 to j1 - 1; the index of the last part.
  std::uint32_t cut(std::uint32_t i0, std::uint32_t i1, std::uint32_t j0, std::uint32_t j1) {
    const std::uint32_t width = i1 - i0;
    const std::uint32_t height = j1 - j0;
    if (width <= kSmallest && height <= kSmallest) return number(i0, i1, j0, j1);
    std::uint32_t one = 0;
    std::uint32_t other = 0;
    std::uint32_t line = 0;
    if (width >= height) {
      const std::uint32_t middle = i0 + width / 2 - 1;
      one = cut(i0, middle, j0, j1);
      other = cut(middle + 2, i1, j0, j1);
      line = number(middle, middle + 2, j0, j1);
    } else {
      const std::uint32_t middle = j0 + height / 2 - 1;
      one = cut(i0, i1, j0, middle);
      other = cut(i0, i1, middle + 2, j1);
      line = number(i0, i1, middle, middle + 2);
    }
    result.parts[one].parent = line;
    result.parts[other].parent = line;
    return line;
  }
};

}  // namespace

Dissection dissect(std::uint32_t side) {
  Dissector dissector{side, 0, {}};
  dissector.result.places.resize(static_cast<std::size_t>(side) * side);
  dissector.cut(0, side, 0, side);
  return dissector.result;
}

Factor::Factor(const Dissection& dissection, const Eigen::SparseMatrix<double>& matrix)
    : fronts_(dissection.parts.size()),
      children_(dissection.parts.size()),
      index_(dissection.places.size()) {
  for (std::uint32_t f = 0; f < fronts_.size(); ++f) {
    Front& front = fronts_[f];
    const Dissection::Part& part = dissection.parts[f];
    front.begin = part.begin;
    front.end = part.end;
    front.parent = part.parent;
    if (front.parent != f) children_[front.parent].push_back(f);
    for (std::uint32_t place = front.begin; place < front.end; ++place) {
      for (Eigen::SparseMatrix<double>::InnerIterator it(matrix, 3 * place); it; ++it) {
        const auto row = static_cast<std::uint32_t>(it.row() / 3);
        if (row >= front.end) front.rows.push_back(row);
      }
    }
    for (const std::uint32_t child : children_[f]) {
      for (const std::uint32_t row : fronts_[child].rows) {
        if (row >= front.end) front.rows.push_back(row);
      }
    }
    std::sort(front.rows.begin(), front.rows.end());
    front.rows.erase(std::unique(front.rows.begin(), front.rows.end()), front.rows.end());
    const std::uint32_t own = front.end - front.begin;
    for (const std::uint32_t child : children_[f]) {
      for (const std::uint32_t row : fronts_[child].rows) {
        const auto at = std::lower_bound(front.rows.begin(), front.rows.end(), row);
        fronts_[child].above.push_back(
            row < front.end ? row - front.begin
                            : own + static_cast<std::uint32_t>(at - front.rows.begin()));
      }
    }
    const auto rest = static_cast<Eigen::Index>(3 * front.rows.size());
    front.panel.resize(3 * own + rest, 3 * own);
    front.update.resize(rest, rest);
  }
}

void Factor::assemble(const Eigen::SparseMatrix<double>& matrix, Front& front) {
  const std::uint32_t own = front.end - front.begin;
  for (std::uint32_t place = front.begin; place < front.end; ++place)
    index_[place] = place - front.begin;
  for (std::uint32_t r = 0; r < front.rows.size(); ++r) index_[front.rows[r]] = own + r;
  front.panel.setZero();
  front.update.setZero();
  for (Eigen::Index c = 0; c < front.panel.cols(); ++c) {
    for (Eigen::SparseMatrix<double>::InnerIterator it(matrix, 3 * front.begin + c); it; ++it)
      front.panel(3 * index_[it.row() / 3] + it.row() % 3, c) = it.value();
  }
}

void Factor::extend(const Front& child, Front& parent) {
  const std::uint32_t own = parent.end - parent.begin;
  for (std::uint32_t c = 0; c < child.above.size(); ++c) {
    for (std::uint32_t r = c; r < child.above.size(); ++r) {
      const auto block = child.update.block<3, 3>(3 * r, 3 * c);
      const std::uint32_t row = child.above[r];
      const std::uint32_t column = child.above[c];
      if (column < own) {
        parent.panel.block<3, 3>(3 * row, 3 * column) += block;
      } else {
        parent.update.block<3, 3>(3 * (row - own), 3 * (column - own)) += block;
      }
    }
  }
}

bool Factor::factorize(const Eigen::SparseMatrix<double>& matrix) {
  for (std::uint32_t f = 0; f < fronts_.size(); ++f) {
    Front& front = fronts_[f];
    assemble(matrix, front);
    for (const std::uint32_t child : children_[f]) extend(fronts_[child], front);
    const Eigen::Index own = front.panel.cols();
    Eigen::Ref<Eigen::MatrixXd> pivots = front.panel.topRows(own);
    const Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>, Eigen::Lower> llt(pivots);
    if (llt.info() != Eigen::Success) return false;
    if (front.rows.empty()) continue;
    auto below = front.panel.bottomRows(front.update.rows());
    pivots.triangularView<Eigen::Lower>().transpose().solveInPlace<Eigen::OnTheRight>(below);
    front.update.selfadjointView<Eigen::Lower>().rankUpdate(below, -1);
  }
  return true;
}

void Factor::solve_in_place(Eigen::VectorXd& x) const {
  Eigen::VectorXd rest;
  for (const Front& front : fronts_) {
    const Eigen::Index own = front.panel.cols();
    auto mine = x.segment(3 * front.begin, own);
    front.panel.topRows(own).triangularView<Eigen::Lower>().solveInPlace(mine);
    rest.noalias() = front.panel.bottomRows(front.update.rows()) * mine;
    for (std::size_t r = 0; r < front.rows.size(); ++r)
      x.segment<3>(3 * front.rows[r]) -= rest.segment<3>(3 * r);
  }
  for (auto front = fronts_.rbegin(); front != fronts_.rend(); ++front) {
    const Eigen::Index own = front->panel.cols();
    auto mine = x.segment(3 * front->begin, own);
    rest.resize(front->update.rows());
    for (std::size_t r = 0; r < front->rows.size(); ++r)
      rest.segment<3>(3 * r) = x.segment<3>(3 * front->rows[r]);
    mine.noalias() -= front->panel.bottomRows(front->update.rows()).transpose() * rest;
    front->panel.topRows(own).triangularView<Eigen::Lower>().transpose().solveInPlace(mine);
  }
}

}  // namespace farcull::cloth
