// Lists the built-in scenes, or writes a built-in scene as meshes.
#include <fmt/format.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "experiments/command/command.h"
#include "experiments/record/output.h"
#include "experiments/scenes/builtin/scenes.h"
#include "experiments/system/output_file.h"
#include "experiments/system/text_table.h"

namespace farcull {
namespace {

using Json = nlohmann::ordered_json;

Json to_json(const BuiltinScene& scene) {
  const auto number = [](const auto& n) {
    return n ? FARCULL_JSON(*n, what, least, most, usual) : Json(nullptr);
  };
  Json out = FARCULL_JSON(scene, name, objects, triangles, needs_meshes);
  out["moves"] = !scene.motion.empty();
  out["motion"] = text_json(scene.motion);
  out["topology_changes"] = scene.topology_changes;
  out["seed"] = json_of(scene.seed);
  out["size"] = number(scene.size);
  out["second"] = number(scene.second);
  out["description"] = scene.description;
  return out;
}

std::string sizes_text() {
  Table table("lrrrl");
  table.add({"number", "least", "most", "usual", "of"});
  for (const BuiltinScene& scene : builtin_scenes()) {
    if (const auto& n = scene.size) {
      table.add(
          {scene.name + ":N", grouped(n->least), grouped(n->most), grouped(n->usual), n->what});
    }
    if (const auto& n = scene.second) {
      table.add({scene.name + ":N:X", fmt::format("{:g}", n->least), fmt::format("{:g}", n->most),
                 fmt::format("{:.3g}", n->usual), n->what});
    }
  }
  return "Some take numbers, as in crowd:3000:0.2:\n" + table.text();
}

constexpr const char* kFrameZero =
    "Frame 0 is where a motion begins, which need not be the scene without --frames.\n";

std::string motions_text() {
  Table table("ll");
  for (const BuiltinScene& scene : builtin_scenes()) {
    if (!scene.motion.empty()) table.add({scene.name, scene.motion});
  }
  return "These move, as in farcull run two-bunnies --frames 30:\n" + table.text() + kFrameZero;
}

std::string suffixes_text() {
  Table table("ll");
  for (const SceneSuffix& suffix : scene_suffixes()) table.add({suffix.suffix, suffix.description});
  table.add({"@seedN", "drawn with the seed N; of scenes with a seed"});
  return "Every name takes suffixes, as in two-spheres@far:\n" + table.text();
}

class ScenesCommand {
 public:
  CLI::App* add_to(CLI::App& app) {
    return add_command(
        app, "scenes", "the built-in scenes with their sizes; one of them as meshes",
        {{"NAME", &name_, "", "the scene to write, with its numbers and suffixes"},
         {"--write", &folder_, "DIR",
          "write the scene as meshes, one an object, and\nscene.json into this folder, "
          "which is made if its\nparent is there; files of these names are replaced"},
         {"--json", &outputs_.json, "FILE", kJsonHelp}},
        std::string("Examples:\n"
                    "  farcull scenes\n"
                    "  farcull run crowd@ground\n"
                    "  farcull scenes crowd:3000:0.2 --write crowd\n\n") +
            kFrameZero);
  }
  int run() const {
    if (!name_) {
      if (folder_) {
        throw Error("--write", "no scene is named",
                    "name one, as in farcull scenes two-spheres --write DIR");
      }
      const Outputs outputs = checked(outputs_, {});
      Json all = Json::array();
      Table table("lrrrl");
      table.add({"scene", "objects", "triangles", "seed", ""});
      for (const BuiltinScene& scene : builtin_scenes()) {
        table.add({scene.name, grouped(scene.objects), grouped(scene.triangles),
                   scene.seed ? std::to_string(*scene.seed) : "-", scene.description});
        all.push_back(to_json(scene));
      }
      if (outputs.json) write_json(all, *outputs.json);
      if (!outputs.to_stdout()) {
        print(table.text() + "\n" + sizes_text() + "\n" + suffixes_text() + "\n" + motions_text());
      }
      return 0;
    }
    parse_scene_name(*name_);
    if (!folder_) {
      throw Error(*name_, "is named, but not what to do with it",
                  "give --write DIR, or leave the name out for the list of scenes");
    }
    if (folder_->empty()) throw Error("--write", "the folder's name is empty", "name a folder");
    if (outputs_.json) {
      throw Error("--json", "is for the list of scenes", "leave --json or the scene's name out");
    }
    check_output("-");
    // The command may replace files of the folder, but not the meshes that the scene is made from.
    std::vector<NamedFile> there;
    std::error_code error;
    for (const auto& entry : std::filesystem::directory_iterator(*folder_, error))
      there.push_back({"--write", entry.path().string()});
    require_not_read(scene_files({*name_}), there);
    const WrittenScene written = write_scene(make_builtin_scene(*name_), *folder_);
    print(fmt::format("{}, {}\nfarcull run {}\n", counted(written.files, "file", "files"),
                      counted(written.bytes, "byte", "bytes"), written.scene_file));
    return 0;
  }

 private:
  Text name_, folder_;
  Outputs outputs_;
};

}  // namespace

Command add_scenes(CLI::App& app) { return declare<ScenesCommand>(app); }

}  // namespace farcull
