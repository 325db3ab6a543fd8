// Arrays of the package as input of the library. The package has made them contiguous.
#include "experiments/python/arrays.h"

#include <algorithm>
#include <limits>

namespace farcull::python {
namespace {

[[noreturn]] void refuse(const std::string& name, const std::string& reason,
                         const std::string& remedy) {
  raise(name, reason, remedy, true);
}

template <class Number>
std::span<const Number> numbers_of(const py::array& array) {
  return {static_cast<const Number*>(array.data()), static_cast<std::size_t>(array.size())};
}

}  // namespace

MeshArrays::MeshArrays(const py::array& vertices, const py::array& triangles,
                       const py::array_t<std::int64_t>& object_starts,
                       const py::array_t<double>& poses)
    : kept_{vertices, triangles} {
  for (py::ssize_t k = 0; k < object_starts.size(); ++k) {
    const std::int64_t first = object_starts.at(k);
    if (first < 0 || first > std::numeric_limits<std::uint32_t>::max()) {
      refuse("object_starts",
             "object " + std::to_string(k) + " starts at triangle " + std::to_string(first),
             "give the first triangle of each object, ascending from 0");
    }
    starts_.push_back(static_cast<std::uint32_t>(first));
  }
  poses_.resize(static_cast<std::size_t>(poses.shape(0)));
  const double* from = poses.data();
  for (Pose& pose : poses_) {
    for (std::size_t row = 0; row < 3; ++row, from += 4) {
      std::copy(from, from + 3, pose.r.begin() + static_cast<std::ptrdiff_t>(3 * row));
      pose.t[row] = from[3];
    }
  }
  input_ = {numbers_of<double>(vertices), {}, starts_, {}, poses_};
  if (triangles.itemsize() == sizeof(std::int64_t)) {
    input_.wide_triangles = numbers_of<std::int64_t>(triangles);
  } else {
    input_.triangles = numbers_of<std::uint32_t>(triangles);
  }
}

std::vector<TrianglePair> pairs_of(const py::array& array, const std::string& name,
                                   std::size_t triangles) {
  // The caller has checked that these are whole numbers; those beyond 2^63 become negative.
  const auto given =
      py::array_t<std::int64_t, py::array::c_style | py::array::forcecast>::ensure(array);
  if (!given || given.ndim() != 2 || given.shape(1) != 2)
    refuse(name, "have no two columns", "give an array of shape (k, 2)");
  std::vector<TrianglePair> out(static_cast<std::size_t>(given.shape(0)));
  const std::int64_t* from = given.data();
  for (std::size_t k = 0; k < out.size(); ++k, from += 2) {
    const auto [low, high] = std::minmax(from[0], from[1]);
    if (low < 0 || static_cast<std::uint64_t>(high) >= triangles) {
      refuse(name,
             "row " + std::to_string(k) + " names triangles " + std::to_string(from[0]) + " and " +
                 std::to_string(from[1]) + " of " + std::to_string(triangles),
             "give numbers of triangles from 0");
    }
    out[k] = {static_cast<std::uint32_t>(low), static_cast<std::uint32_t>(high)};
  }
  return out;
}

}  // namespace farcull::python
