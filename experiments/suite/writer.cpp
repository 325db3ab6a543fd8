// The texts of a suite, and the folder that they go to.
#include "experiments/suite/writer.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iterator>

#include "core/base/error.h"
#include "experiments/generators/pair_makers.h"
#include "experiments/suite/words.h"
#include "experiments/system/output_file.h"
#include "verify/certificate/sha256.h"

namespace farcull {
namespace {

namespace fs = std::filesystem;

std::string sum_of(const std::string& text) {
  Sha256 sum;
  sum.add(text);
  return sum.digest();
}

std::string obj_text(const Scene& scene, const Object& object) {
  std::string out;
  const auto end = object.first_triangle + object.triangle_count;
  std::uint32_t lo = ~0u;
  std::uint32_t hi = 0;
  for (std::uint32_t t = object.first_triangle; t < end; ++t) {
    for (const std::uint32_t v : scene.triangles[t]) {
      lo = std::min(lo, v);
      hi = std::max(hi, v);
    }
  }
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

/// Writes files below a folder and lists them.
class Folder {
 public:
  Folder(std::string path, SuiteIndex& index) : path_(std::move(path)), index_(index) {
    std::error_code error;
    if (fs::exists(path_, error) && !(fs::is_directory(path_, error) && fs::is_empty(path_, error)))
      throw Error(path_, "is there already", "name a new folder, or remove this one");
  }

  void write(const std::string& name, const std::string& text, std::uint64_t items) {
    make_parent(name);
    write_output(path_ + "/" + name, text);
    index_.files.push_back({name, text.size(), sum_of(text), items});
  }
  void finish() {
    std::sort(index_.files.begin(), index_.files.end(),
              [](const auto& x, const auto& y) { return x.path < y.path; });
    const std::string text = index_text(index_);
    write_output(path_ + "/suite.txt", text);
    index_ = parse_suite(text, path_ + "/suite.txt");
  }

 private:
  void make_parent(const std::string& name) const {
    const std::string parent = fs::path(path_ + "/" + name).parent_path().string();
    std::error_code error;
    fs::create_directories(parent, error);
    if (error) throw Error(parent, error.message(), "name a folder that can be written");
  }

  std::string path_;
  SuiteIndex& index_;
};

}  // namespace

std::string pair_line(const SuitePair& pair) {
  std::string shared;
  for (const auto& [i, j] : pair.shared)
    shared += fmt::format("{}{}-{}", shared.empty() ? "" : ",", i, j);
  if (shared.empty()) shared = "-";
  std::string out =
      fmt::format("{} {} {} {}", pair.id, decimal(pair.parameter), shared, to_string(pair.kind));
  for (const auto* t : {&pair.a, &pair.b}) {
    for (const Vec3& p : *t) {
      for (int k = 0; k < 3; ++k) {
        out += ' ';
        append_hexadecimal(out, p[k]);
      }
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

std::vector<SuiteText> mesh_texts(const SuiteMesh& mesh) {
  std::vector<SuiteText> out;
  for (const Object& object : mesh.scene.objects)
    out.push_back({object.name + ".obj", obj_text(mesh.scene, object), object.triangle_count});
  out.push_back({"mesh.txt",
                 fmt::format("self {}\nparameter {}\nfamily {}\n", mesh.self ? "yes" : "no",
                             decimal(mesh.parameter), mesh.family),
                 0});
  if (mesh.labelled) out.push_back({"pairs.csv", colliding_text(mesh), mesh.pairs.size()});
  return out;
}

std::string index_text(const SuiteIndex& index) {
  std::string out = fmt::format("farcull-suite 1\nseed {}\nsize {}\nlicence {}\n", index.seed,
                                index.size, index.licence);
  for (const SuiteIndex::File& file : index.files) {
    fmt::format_to(std::back_inserter(out), "file {} {} {} {}\n", file.path, file.bytes,
                   file.sha256, file.items);
  }
  return out + "sum " + sum_of(out) + "\n";
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
    out.families.push_back(counts_of(pairs));
  }
  for (const std::string& name : mesh_names(settings.size)) {
    if (progress) progress("mesh " + name);
    const SuiteMesh mesh = make_mesh(name, settings);
    for (const SuiteText& file : mesh_texts(mesh))
      files.write("meshes/" + name + "/" + file.name, file.text, file.items);
    out.meshes.push_back(counts_of(mesh));
  }
  files.finish();
  return out;
}

}  // namespace farcull
