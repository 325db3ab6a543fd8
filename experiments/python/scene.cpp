// Scenes, and scenes that move, as the program reads them.
#include <pybind11/stl.h>

#include <array>
#include <atomic>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "experiments/library/input.h"
#include "experiments/python/arrays.h"
#include "experiments/scenes/builtin/scenes.h"
#include "experiments/scenes/frames.h"
#include "experiments/scenes/scene_file.h"

namespace farcull::python {
namespace {

using Kept = std::unique_ptr<KeptScene>;

Kept from_arrays(const py::array& vertices, const py::array& triangles, const py::array& starts,
                 const std::string& name, const std::vector<std::string>& names, bool self,
                 const std::vector<bool>& self_objects) {
  const Given given(vertices, triangles, starts);
  return answer_beside([&] {
    Scene scene;
    Copies copies;
    take(given.input(copies), self, self_objects, scene);
    scene.name = name;
    if (!names.empty() && names.size() != scene.objects.size()) {
      throw Error("names",
                  "are " + std::to_string(names.size()) + " for " +
                      std::to_string(scene.objects.size()) + " objects",
                  "give one for each object, or none");
    }
    for (std::size_t o = 0; o < scene.objects.size(); ++o)
      scene.objects[o].name = names.empty() ? std::to_string(o) : names[o];
    for (std::size_t t = 0; t < scene.triangles.size(); ++t)
      scene.source_face[t] = static_cast<std::uint32_t>(t);
    return std::make_unique<KeptScene>(std::move(scene));
  });
}

Kept from_names(const std::vector<std::string>& names, bool self) {
  return answer_beside([&] {
    Scene scene = load_scene(names);
    if (self) {
      for (Object& object : scene.objects) object.self = true;
    }
    return std::make_unique<KeptScene>(std::move(scene));
  });
}

// A scene that moves. Used by one thread at a time.
class Frames {
 public:
  Frames(const std::vector<std::string>& names, const std::string& range, bool self) {
    beside([&] {
      range_ = parse_frames(range);
      source_ = std::make_unique<FrameSource>(names, range_, self);
    });
  }
  long first() const { return range_.first; }
  long last() const { return range_.last; }
  Kept at(long frame) {
    if (frame < range_.first || frame > range_.last)
      raise("frame", std::to_string(frame) + " is none of the frames", "give one of them", true);
    const Turn turn(used_, "Frames");
    return answer_beside([&] { return std::make_unique<KeptScene>(source_->at(frame)); });
  }

 private:
  FrameRange range_;
  std::atomic_flag used_;
  std::unique_ptr<FrameSource> source_;
};

py::array_t<std::int64_t> object_starts(const KeptScene& kept) {
  const std::vector<Object>& objects = kept.scene->objects;
  py::array_t<std::int64_t> out(static_cast<py::ssize_t>(objects.size()));
  for (std::size_t o = 0; o < objects.size(); ++o)
    out.mutable_at(static_cast<py::ssize_t>(o)) = objects[o].first_triangle;
  return out;
}

// The objects that two patterns of names name, as the program takes them. what: for errors.
std::vector<std::array<std::uint32_t, 2>> pairs_named(const KeptScene& kept,
                                                      const std::string& first,
                                                      const std::string& second,
                                                      const std::string& what) {
  return answer_beside([&] {
    std::vector<std::array<std::uint32_t, 2>> out;
    for (const ObjectPair& pair : pairs_between(*kept.scene, first, second, "ignore", what))
      out.push_back({pair.a, pair.b});
    return out;
  });
}

}  // namespace

void add_scenes(py::module_& module) {
  static_assert(sizeof(Vec3) == 3 * sizeof(double));
  // (n, 3): a view of the vertices or triangles of a scene.
  const auto rows = [](auto rows_of) {
    return [rows_of](py::object self) {
      const auto& out = (*self.cast<const KeptScene&>().scene).*rows_of;
      return view_of(out.empty() ? nullptr : out[0].data(),
                     {static_cast<py::ssize_t>(out.size()), 3}, self);
    };
  };
  const auto each = [](auto member) {
    return [member](const KeptScene& k) {
      py::list out;
      for (const Object& object : k.scene->objects) out.append(object.*member);
      return out;
    };
  };
  py::class_<KeptScene>(module, "Scene")
      .def_property_readonly("name", [](const KeptScene& k) { return k.scene->name; })
      .def_property_readonly("vertices", rows(&Scene::vertices))
      .def_property_readonly("triangles", rows(&Scene::triangles))
      .def_property_readonly("objects", &object_starts)
      .def_property_readonly("ignored",
                             [](const KeptScene& k) { return pair_array(k.scene->ignored); })
      .def("pairs_named", &pairs_named)
      .def_property_readonly("names", each(&Object::name))
      .def_property_readonly("self", each(&Object::self));
  module.def("scene_of_arrays", &from_arrays);
  module.def("scene_of_names", &from_names);
  module.def("builtin_scenes", [] {
    py::list out;
    for (const BuiltinScene& scene : builtin_scenes()) out.append(scene.name);
    return out;
  });
  py::class_<Frames>(module, "Frames")
      .def(py::init<const std::vector<std::string>&, const std::string&, bool>())
      .def_property_readonly("first", &Frames::first)
      .def_property_readonly("last", &Frames::last)
      .def("at", &Frames::at);
}

}  // namespace farcull::python
