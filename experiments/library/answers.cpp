// What the library says of contacts, and the objects that it is told to ignore.
#include "experiments/library/answers.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include "core/base/error.h"
#include "core/scene/scene.h"
#include "experiments/library/input.h"

namespace farcull {
namespace {

constexpr int kMostResolution = 16384;

ColliderContactKind given_out(ContactKind kind) {
  switch (kind) {
    case ContactKind::apart:
      return ColliderContactKind::apart;
    case ContactKind::equal:
      return ColliderContactKind::equal;
    case ContactKind::touch_vertex:
      return ColliderContactKind::touch_vertex;
    case ContactKind::touch_edge:
      return ColliderContactKind::touch_edge;
    case ContactKind::coplanar:
      return ColliderContactKind::coplanar;
    case ContactKind::crossing:
      return ColliderContactKind::crossing;
    case ContactKind::touch_face:
      return ColliderContactKind::touch_face;
  }
  throw std::logic_error("library: a kind of contact that there is not");
}

}  // namespace

void check(const ColliderOptions& options) {
  if (options.threads > kMostThreads)
    throw Error("threads", "are more than 1024", "give a number up to 1024, or 0");
  if (!(options.clearance >= 0) || !std::isfinite(options.clearance))
    throw Error("clearance", "is no distance", "give a finite number, 0 or more");
  if (options.resolution < 0 || options.resolution > kMostResolution)
    throw Error("resolution", "is outside 0 .. 16384", "give a number of pixels, or 0");
}

ContactDetail detail_of(ColliderContacts contacts) {
  switch (contacts) {
    case ColliderContacts::none:
      return ContactDetail::none;
    case ColliderContacts::kinds:
      return ContactDetail::kinds;
    case ColliderContacts::segments:
      return ContactDetail::segments;
  }
  return ContactDetail::none;
}

ColliderContact given_out(const ContactShape& shape) {
  const auto point = [](const Vec3& p) { return std::array{p.x(), p.y(), p.z()}; };
  return {.kind = given_out(shape.kind),
          .dimension = shape.dimension,
          .ends = {point(shape.ends[0]), point(shape.ends[1])}};
}

std::vector<ColliderContact> given_out(const std::vector<ContactShape>& shapes) {
  std::vector<ColliderContact> out;
  out.reserve(shapes.size());
  for (const ContactShape& shape : shapes) out.push_back(given_out(shape));
  return out;
}

/// The ignored pairs of a scene with so many objects.
std::vector<ObjectPair> ignored_of(const ColliderOptions& options, std::size_t objects) {
  std::vector<ObjectPair> out;
  for (const auto& [a, b] : options.ignore) {
    const std::string text = "names objects " + std::to_string(a) + " and " + std::to_string(b);
    if (std::max(a, b) >= objects) {
      throw Error("ignore", text + " of " + std::to_string(objects) + ", numbered from 0",
                  "give two objects of the input in each pair");
    }
    if (a == b) {
      throw Error("ignore", text + ", which are one",
                  "give two different objects; self_objects says which are tested against "
                  "themselves");
    }
    out.push_back({a, b});
  }
  return in_order(std::move(out));
}

const char* to_string(ColliderContactKind kind) {
  for (const ContactKind own : kContactKinds) {
    if (given_out(own) == kind) return name_of(own).data();  // of a literal, so it ends with a 0
  }
  throw std::logic_error("library: a kind of contact that there is not");
}

}  // namespace farcull
