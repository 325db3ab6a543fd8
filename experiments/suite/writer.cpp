// Makes and writes a suite. Threads label the pairs in parallel. Each pair is stored at the index
// of its ID, so the order does not depend on the threads.
#include "experiments/suite/writer.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <sstream>
#include <stdexcept>

#include "core/base/bytes.h"
#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/base/text.h"
#include "experiments/scenes/mesh/scene_build.h"
#include "experiments/scenes/mesh/text.h"
#include "experiments/system/output_file.h"

namespace farcull {
namespace {

namespace fs = std::filesystem;

/// Returns the number of pairs of each family. All 19 families together have 10070 pairs (small) or
/// 1007000 pairs (full).
std::uint64_t pair_count(SuiteSize size) { return size == SuiteSize::small ? 530 : 53000; }

std::size_t members(const MeshFamily& family, SuiteSize size) {
  return size == SuiteSize::full ? family.members.size() : family.small;
}

std::string mesh_name(const MeshFamily& family, std::size_t index) {
  return fmt::format("{}-{}", family.name, index + 1);
}

std::string obj_text(const Scene& scene, const Object& object) {
  std::string out;
  const auto end = object.first_triangle + object.triangle_count;
  const auto [lo, hi] = vertices_of(scene, object);
  for (std::uint32_t v = lo; v <= hi; ++v) {
    const Vec3& p = scene.vertices[v];
    fmt::format_to(std::back_inserter(out), "v {:.17g} {:.17g} {:.17g}\n", p.x(), p.y(), p.z());
  }
  for (std::uint32_t t = object.first_triangle; t < end; ++t) {
    const auto& [i, j, k] = scene.triangles[t];
    fmt::format_to(std::back_inserter(out), "f {} {} {}\n", i - lo + 1, j - lo + 1, k - lo + 1);
  }
  return out;
}

std::string colliding_text(const SuiteMesh& mesh) {
  const std::vector<std::uint32_t> owner = owners(mesh.scene);
  std::string out = "object_a,triangle_a,object_b,triangle_b,shared\n";
  for (const SuiteMeshPair& row : mesh.pairs) {
    const std::uint32_t a = owner[row.pair.a];
    const std::uint32_t b = owner[row.pair.b];
    fmt::format_to(std::back_inserter(out), "{},{},{},{},{}\n", a,
                   row.pair.a - mesh.scene.objects[a].first_triangle, b,
                   row.pair.b - mesh.scene.objects[b].first_triangle, row.shared);
  }
  return out;
}

/// Returns the line of a pair in the file, without a newline.
std::string pair_line(const SuitePair& pair) {
  std::string shared;
  for (const auto& [i, j] : pair.shared)
    shared += fmt::format("{}{}-{}", shared.empty() ? "" : ",", i, j);
  if (shared.empty()) shared = "-";
  std::string out =
      fmt::format("{} {} {} {}", pair.id, shortest(pair.parameter), shared, to_string(pair.kind));
  for (const auto* t : {&pair.a, &pair.b}) {
    for (const Vec3& p : *t) {
      for (int k = 0; k < 3; ++k) out += " " + hexadecimal(p[k]);
    }
  }
  return out;
}

std::string pairs_text(const SuitePairs& pairs) {
  std::string out = "farcull-pairs 1 " + pairs.family + "\n";
  for (const PairFamily& family : pair_families()) {
    if (family.name != pairs.family) continue;
    out += "# " + family.description + "\n";
    if (!family.parameter.empty()) out += "# parameter: " + family.parameter + "\n";
  }
  for (const SuitePair& pair : pairs.pairs) out += pair_line(pair) + "\n";
  return out;
}

/// Returns the text of suite.txt, with the sum as its last line. Ignores `index.sum`.
std::string index_text(const SuiteIndex& index) {
  std::string out = fmt::format("farcull-suite 1\nseed {}\nsize {}\nlicence {}\n", index.seed,
                                index.size, index.licence);
  for (const SuiteIndex::File& file : index.files) {
    fmt::format_to(std::back_inserter(out), "file {} {} {} {}\n", file.path, file.bytes,
                   file.sha256, file.items);
  }
  return out + "sum " + sha256(out) + "\n";
}

std::string sum_of(const std::string& text) {
  constexpr std::size_t kLine = 4 + 64 + 1;  // "sum ", SHA-256, newline
  return text.size() > kLine ? text.substr(text.size() - 65, 64) : "";
}

/// Writes files below a folder, and adds each file to the index.
class Folder {
 public:
  Folder(std::string path, SuiteIndex& index) : path_(std::move(path)), index_(index) {
    std::error_code error;
    if (fs::exists(path_, error) && !(fs::is_directory(path_, error) && fs::is_empty(path_, error)))
      throw Error(path_, "is there already", "name a new folder, or remove this one");
  }

  void write(const std::string& name, const std::string& text, std::uint64_t items) {
    const std::string parent = fs::path(path_ + "/" + name).parent_path().string();
    std::error_code error;
    fs::create_directories(parent, error);
    if (error) throw Error(parent, error.message(), "name a folder that can be written");
    write_output(path_ + "/" + name, text);
    index_.files.push_back({name, text.size(), sha256(text), items});
  }
  void write(const std::string& name, const SuiteQuestions& questions) {
    const std::size_t count = questions.questions.size();
    if (count > 0) write("questions/" + name + ".txt", questions_text(questions), count);
  }
  void write(const SuiteMesh& mesh) {
    const std::string folder = "meshes/" + mesh.name + "/";
    for (const Object& object : mesh.scene.objects)
      write(folder + object.name + ".obj", obj_text(mesh.scene, object), object.triangle_count);
    write(folder + "mesh.txt",
          fmt::format("self {}\nparameter {}\nfamily {}\n", mesh.self ? "yes" : "no",
                      shortest(mesh.parameter), mesh.family),
          0);
    write(folder + "pairs.csv", colliding_text(mesh), mesh.pairs.size());
  }
  void finish() {
    std::ranges::sort(index_.files, {}, &SuiteIndex::File::path);
    const std::string text = index_text(index_);
    write_output(path_ + "/suite.txt", text);
    index_.sum = sum_of(text);
  }

 private:
  std::string path_;
  SuiteIndex& index_;
};

}  // namespace

SuiteCounts counts_of(const SuitePairs& pairs) {
  SuiteCounts out;
  out.name = pairs.family;
  out.pairs = pairs.pairs.size();
  for (const SuitePair& pair : pairs.pairs) {
    ++out.kinds[static_cast<std::size_t>(pair.kind)];
    out.colliding += pair.kind != SuiteKind::unlabelled && collides(pair.kind);
  }
  return out;
}

SuiteCounts counts_of(const SuiteMesh& mesh) {
  SuiteCounts out;
  out.name = mesh.name;
  out.triangles = mesh.scene.triangles.size();
  out.pairs = out.colliding = mesh.pairs.size();
  for (const SuiteMeshPair& pair : mesh.pairs) out.neighbours += pair.shared > 0;
  return out;
}

SuitePair make_suite_pair(const PairFamily& family, std::uint64_t seed, std::uint64_t id) {
  RandomDraws draws(seed_of_item(seed, family.name, id));
  SuitePair out;
  out.id = id;
  out.parameter = family.values[id % family.values.size()];
  MadePair made = family.make(draws, out.parameter);
  shuffle(draws, made);
  out.a = made.a;
  out.b = made.b;
  if (made.neighbours) out.shared = equal_corners(out.a, out.b);
  return out;
}

SuitePairs make_pairs(const std::string& family, const SuiteSettings& settings) {
  const auto found = std::ranges::find(pair_families(), family, &PairFamily::name);
  if (found == pair_families().end()) throw std::logic_error("make_pairs: no family " + family);
  SuitePairs out;
  out.family = family;
  out.pairs.resize(pair_count(settings.size));
  const std::size_t count = out.pairs.size();
  for_chunks(count, chunks_for(count, 64), [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      SuitePair pair = make_suite_pair(*found, settings.seed, i);
      pair.kind = decide(pair, fmt::format("pair {} of {}", i, family));
      out.pairs[i] = std::move(pair);
    }
  });
  return out;
}

std::vector<std::string> mesh_names(SuiteSize size) {
  std::vector<std::string> out;
  for (const MeshFamily& family : mesh_families()) {
    for (std::size_t i = 0; i < members(family, size); ++i) out.push_back(mesh_name(family, i));
  }
  std::sort(out.begin(), out.end());
  return out;
}

SuiteMesh make_mesh(const std::string& name, const SuiteSettings& settings) {
  for (const MeshFamily& family : mesh_families()) {
    for (std::size_t i = 0; i < members(family, settings.size); ++i) {
      if (mesh_name(family, i) != name) continue;
      SuiteMesh out;
      out.name = name;
      out.family = family.name;
      out.parameter = family.members[i].parameter;
      out.self = family.self;
      SceneBuilder builder(name, name);
      int number = 0;
      for (SuiteObject& object : make_suite_mesh(family, settings.seed, i)) {
        builder.add(shapes::finished(std::move(object.vertices), std::move(object.triangles)),
                    std::to_string(number++), Split::kNone, {}, family.self);
      }
      out.scene = builder.finish();
      out.pairs = decide_mesh(out.scene, name);
      return out;
    }
  }
  throw std::logic_error("make_mesh: no mesh " + name);
}

SuiteIndex read_suite(const std::string& folder) {
  const std::string path = folder + "/suite.txt", text = read_file(path, UINT64_MAX);
  SuiteIndex out;
  out.sum = sum_of(text);
  std::istringstream words(text);
  std::string seed, size, head, version;
  words >> head >> version >> seed >> out.seed >> size >> out.size;
  if (!words || head + " " + version != "farcull-suite 1" || seed != "seed" || size != "size" ||
      !text.ends_with("sum " + sha256(text.substr(0, text.size() - 69)) + "\n"))
    throw Error(path, "is no list of a suite, or was changed",
                "docs/suite.md has the format; write the suite again");
  return out;
}

SuiteSummary write_suite(const std::string& folder, const SuiteSettings& settings,
                         const Progress& progress) {
  SuiteSummary out;
  out.index.seed = settings.seed;
  out.index.size = settings.size == SuiteSize::small ? "small" : "full";
  out.index.licence = "CC0-1.0";
  Folder files(folder, out.index);
  for (const PairFamily& family : pair_families()) {
    if (progress) progress("pairs, " + family.name);
    const SuitePairs pairs = make_pairs(family.name, settings);
    files.write("pairs/" + family.name + ".txt", pairs_text(pairs), pairs.pairs.size());
    files.write(family.name, questions_of(pairs));
    out.families.push_back(counts_of(pairs));
  }
  for (const std::string& name : mesh_names(settings.size)) {
    if (progress) progress("mesh " + name);
    const SuiteMesh mesh = make_mesh(name, settings);
    files.write(mesh);
    files.write(name, questions_of(mesh, settings.seed));
    out.meshes.push_back(counts_of(mesh));
  }
  files.finish();
  return out;
}

}  // namespace farcull
