// Reads arrays number by number through their strides, so that numpy need not copy any layout
// first. The type of the numbers is checked once per array.
#include "experiments/python/arrays.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <new>
#include <type_traits>
#include <utility>

#include "core/base/error.h"
#include "core/base/parallel.h"

namespace farcull::python {
namespace {

constexpr std::size_t kStopEvery = std::size_t{1} << 20;     // rows between checks for a stop
constexpr std::size_t kBlock = 256;                          // rows that are converted together
constexpr std::size_t kRowsOfThread = std::size_t{1} << 15;  // least rows of a thread
static_assert(kStopEvery % kBlock == 0);

[[noreturn]] void refuse(const std::string& name, const std::string& reason,
                         const std::string& remedy) {
  raise(name, reason, remedy, true);
}

// Reads a number at any address, also one that is not aligned.
template <class In>
In read(const std::byte* from) {
  In value;
  std::memcpy(&value, from, sizeof value);
  return value;
}

// IEEE binary16.
struct Half {
  std::uint16_t bits;
  double value() const {
    const int exponent = (bits >> 10) & 31;
    const int fraction = bits & 1023;
    double out = std::numeric_limits<double>::quiet_NaN();
    if (exponent == 31) {
      if (fraction == 0) out = std::numeric_limits<double>::infinity();
    } else {
      out = exponent == 0 ? std::ldexp(fraction, -24) : std::ldexp(1024 + fraction, exponent - 25);
    }
    return (bits >> 15) != 0 ? -out : out;
  }
};

template <class In>
double double_of(In value, const std::string& name, std::size_t row) {
  if constexpr (std::is_same_v<In, Half>) {
    return value.value();
  } else {
    const auto out = static_cast<double>(value);
    if constexpr (std::is_integral_v<In> && sizeof(In) == 8) {
      constexpr In kExact = In{1} << 53;
      bool rounds = value > kExact;
      if constexpr (std::is_signed_v<In>) rounds = rounds || value < -kExact;
      if (rounds) {
        throw Error(name,
                    "row " + std::to_string(row) + " holds " + std::to_string(value) +
                        ", which a double may not hold exactly",
                    "give doubles");
      }
    }
    return out;
  }
}

template <class In>
std::uint32_t index_of(In value, const std::string& name, std::size_t row) {
  bool fits = static_cast<std::uint64_t>(value) <= std::numeric_limits<std::uint32_t>::max();
  if constexpr (std::is_signed_v<In>) fits = fits && value >= 0;
  if (fits) return static_cast<std::uint32_t>(value);
  throw Error(name, "triangle " + std::to_string(row) + " names vertex " + std::to_string(value),
              "give indices from 0 to the number of vertices - 1");
}

// Whether all numbers of a block of consecutive indices fit into 32 bits. If so, they are at `to`.
// The loop has no branch, so that the compiler can convert several numbers at a time: a number that
// does not fit sets a bit above the lower 32, and so does a negative one by its sign bits.
template <class In>
bool block_fits(const std::byte* from, std::uint32_t* to) {
  std::uint64_t bits = 0;
  for (std::size_t k = 0; k < 3 * kBlock; ++k) {
    const auto wide = static_cast<std::uint64_t>(read<In>(from + k * sizeof(In)));
    bits |= wide;
    to[k] = static_cast<std::uint32_t>(wide);
  }
  return bits <= std::numeric_limits<std::uint32_t>::max();
}

// Returns call() with a value of the integer type.
template <class Call>
auto with_integer(char kind, std::size_t size, const Call& call) {
  if (kind == 'i') {
    if (size == 1) return call(std::int8_t{});
    if (size == 2) return call(std::int16_t{});
    if (size == 4) return call(std::int32_t{});
    return call(std::int64_t{});
  }
  if (size == 1) return call(std::uint8_t{});
  if (size == 2) return call(std::uint16_t{});
  if (size == 4) return call(std::uint32_t{});
  return call(std::uint64_t{});
}

}  // namespace

Rows::Rows(const py::array& array, std::string name, bool indices)
    : kept_(array), name_(std::move(name)) {
  const py::dtype type = array.dtype();
  kind_ = type.kind();
  size_ = static_cast<std::size_t>(type.itemsize());
  const bool whole = (kind_ == 'i' || kind_ == 'u') && size_ <= 8;
  const bool number = whole || (kind_ == 'f' && size_ <= 8);
  if (indices ? !whole : !number) {
    refuse(name_, "are of type " + std::string(py::str(static_cast<py::handle>(type))),
           indices ? "give whole numbers, as in numpy.int64" : "give doubles");
  }
  if (type.byteorder() != '=' && type.byteorder() != '|')
    refuse(name_, "are in another byte order", "give them in that of the machine");
  if (array.ndim() != 2 || array.shape(1) != 3)
    refuse(name_, "have no three columns", "give an array of shape (n, 3)");
  data_ = static_cast<const std::byte*>(array.data());
  rows_ = static_cast<std::size_t>(array.shape(0));
  row_stride_ = array.strides(0);
  column_stride_ = array.strides(1);
}

bool Rows::packed(std::size_t size) const {
  const auto step = static_cast<std::ptrdiff_t>(size);
  return size_ == size && column_stride_ == step && (row_stride_ == 3 * step || rows_ <= 1) &&
         reinterpret_cast<std::uintptr_t>(data_) % size == 0;
}

template <class Out, class In>
std::span<const Out> Rows::copy(Memory<Out>& memory) const {
  if (rows_ > std::numeric_limits<std::size_t>::max() / (3 * sizeof(Out))) throw std::bad_alloc();
  const std::span<Out> out = memory.room(3 * rows_);
  // With several errors, the one of the lowest row is thrown.
  for_chunks(rows_, chunks_for(rows_, kRowsOfThread),
             [&](std::size_t, std::size_t begin, std::size_t end) {
               copy_rows<Out, In>(begin, end, out.data() + 3 * begin);
             });
  return out;
}

template <class Out, class In>
void Rows::copy_rows(std::size_t begin, std::size_t end, Out* to) const {
  for (std::size_t row = begin; row < end; ++row) {
    if (row % kStopEvery == 0) stop_point();
    const std::byte* from = data_ + static_cast<std::ptrdiff_t>(row) * row_stride_;
    if constexpr (std::is_same_v<Out, std::uint32_t>) {
      // The code below names a number that does not fit.
      if (packed(sizeof(In)) && row + kBlock <= end && block_fits<In>(from, to)) {
        row += kBlock - 1;
        to += 3 * kBlock;
        continue;
      }
    }
    for (int k = 0; k < 3; ++k, from += column_stride_) {
      if constexpr (std::is_same_v<Out, double>) {
        *to++ = double_of(read<In>(from), name_, row);
      } else {
        *to++ = index_of(read<In>(from), name_, row);
      }
    }
  }
}

std::span<const double> Rows::doubles(Memory<double>& memory) const {
  if (kind_ == 'f' && packed(sizeof(double)))
    return {reinterpret_cast<const double*>(data_), 3 * rows_};
  if (kind_ != 'f')
    return with_integer(kind_, size_, [&](auto in) { return copy<double, decltype(in)>(memory); });
  if (size_ == 2) return copy<double, Half>(memory);
  if (size_ == 4) return copy<double, float>(memory);
  return copy<double, double>(memory);
}

std::span<const std::uint32_t> Rows::indices(Memory<std::uint32_t>& memory) const {
  if (kind_ == 'u' && packed(sizeof(std::uint32_t)))
    return {reinterpret_cast<const std::uint32_t*>(data_), 3 * rows_};
  return with_integer(kind_, size_,
                      [&](auto in) { return copy<std::uint32_t, decltype(in)>(memory); });
}

std::span<const std::int64_t> Rows::wide() const {
  if (kind_ != 'i' || !packed(sizeof(std::int64_t))) return {};
  return {reinterpret_cast<const std::int64_t*>(data_), 3 * rows_};
}

Given::Given(const py::array& vertices, const py::array& triangles, const py::array& object_starts,
             const py::array& poses)
    : vertices_(vertices, "V", false), triangles_(triangles, "F", true) {
  const auto starts = py::array_t<std::int64_t, py::array::c_style>::ensure(object_starts);
  if (!starts || starts.ndim() != 1)
    refuse("object_starts", "are no array of one dimension",
           "give the first triangle of each object");
  for (py::ssize_t k = 0; k < starts.size(); ++k) {
    const std::int64_t first = starts.at(k);
    if (first < 0 || first > std::numeric_limits<std::uint32_t>::max()) {
      refuse("object_starts",
             "object " + std::to_string(k) + " starts at triangle " + std::to_string(first),
             "give the first triangle of each object, ascending from 0");
    }
    starts_.push_back(static_cast<std::uint32_t>(first));
  }
  const auto moves = py::array_t<double, py::array::c_style>::ensure(poses);
  if (!moves || moves.ndim() != 3 || moves.shape(1) != 3 || moves.shape(2) != 4)
    refuse("poses", "are no matrices", "give an array of shape (k, 3, 4)");
  poses_.resize(static_cast<std::size_t>(moves.shape(0)));
  const double* from = moves.data();
  for (Pose& pose : poses_) {
    for (std::size_t row = 0; row < 3; ++row, from += 4) {
      std::copy(from, from + 3, pose.r.begin() + static_cast<std::ptrdiff_t>(3 * row));
      pose.t[row] = from[3];
    }
  }
}

Input Given::input(Copies& copies) const {
  const std::span<const double> vertices = vertices_.doubles(copies.vertices);
  const std::span<const std::int64_t> wide = triangles_.wide();
  if (!wide.empty()) return {vertices, {}, starts_, wide, poses_};
  return {vertices, triangles_.indices(copies.triangles), starts_, {}, poses_};
}

std::vector<TrianglePair> pairs_of(const py::array& array, const std::string& name,
                                   std::size_t triangles) {
  // The caller has looked that these are whole numbers; those beyond 2^63 become negative.
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
