// Reads the options of `farcull report`, checks the store, and replaces this process by the Python
// program of experiments/report/, which reads the store and writes the report.
#include <fmt/format.h>
#include <unistd.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "commit.h"
#include "core/canvas/canvas.h"
#include "core/view/regions.h"
#include "experiments/command/command.h"
#include "experiments/scenes/builtin/scenes.h"
#include "experiments/studies/run_studies.h"
#include "experiments/studies/store.h"
#include "experiments/system/python.h"

namespace farcull {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

// Returns the path of the store in the folder. Throws Error if there is no store. If the folder has
// shards (stores of parts of a study), the error says to merge the shards.
std::string store_of(const std::string& folder) {
  const std::string path = store_path(folder);
  if (fs::exists(path)) return path;
  const std::string remedy = "measure first, as in farcull experiment all --quick --out " + folder;
  if (!fs::is_directory(folder)) throw Error(folder, "is no folder of results", remedy);
  std::error_code ignored;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, ignored)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with("results-") && name.ends_with(".sqlite"))
      throw Error(folder, "holds shards that are not merged", "farcull merge " + folder);
  }
  throw Error(folder, "holds no results.sqlite", remedy);
}

// Returns JSON that tells the Python program about studies and scenes.
std::string context_for_python() {
  Json known = Json::array(), scenes = Json::object();
  for (const Study& study : studies())
    known.push_back({{"name", study.name}, {"title", study.title}, {"question", study.question}});
  for (const BuiltinScene& scene : builtin_scenes()) {
    scenes[scene.name] = {{"needs_meshes", scene.needs_meshes}};
    if (scene.seed) scenes[scene.name]["seed"] = *scene.seed;
  }
  const Json constants = {
      {"few_triangles", kFewTriangles},
      {"depth_rounding", {{"24", depth_rounding(24)}, {"32", depth_rounding(32)}}},
      {"scene_resolution", kSceneResolution},
      {"scenes", std::move(scenes)}};
  return Json({{"program", fs::read_symlink("/proc/self/exe").string()},
               {"commit", FARCULL_COMMIT},
               {"studies", std::move(known)},
               {"constants", constants}})
      .dump();
}

class ReportCommand {
 public:
  CLI::App* add_to(CLI::App& app) {
    folder_ = kResultsFolder;
    return add_command(
        app, "report", "figures, tables and a page of what was measured",
        {{"DIR", &folder_, "",
          fmt::format("the folder of the results; default {}", kResultsFolder)},
         {"--device", &device_, "DEVICE", kDeviceHelp},
         {"--no-pictures", &no_pictures_, "",
          "leave out the pictures of scenes, for which methods are\nrun"}},
        "Writes DIR/report: index.html, one page that needs nothing else; figures as "
        "SVG and PDF with\ntheir numbers as CSV; tables as CSV and LaTeX. An earlier "
        "report there is replaced. It needs\nPython with pandas and matplotlib; "
        "FARCULL_PYTHON names another interpreter than python3.\n\n"
        "Examples:\n"
        "  farcull experiment all --quick && farcull report\n"
        "  farcull report results");
  }
  int run() {
    if (folder_.empty()) throw Error("DIR", "the folder is empty", "name one");
    while (folder_.size() > 1 && folder_.back() == '/') folder_.pop_back();
    // The report replaces everything in its folder, so the store must be elsewhere.
    std::error_code error;
    const auto place = [&](const std::string& path) {
      return fs::weakly_canonical(path, error).string();
    };
    const std::string report = place(folder_ + "/report");
    if (!error && place(store_path(folder_)).starts_with(report + "/")) {
      throw Error(store_path(folder_), "leads into DIR/report, which the report replaces",
                  "move the results out of it");
    }
    std::vector<std::string> words = {"-B", report_folder(FARCULL_REPORT_FOLDER), folder_};
    {
      const Store store(store_of(folder_), Store::Access::read);
      for (const std::string& name : store.studies()) {
        if (store.declaration(name)->of > 1)
          throw Error(store.path(), "holds a shard of " + name, "farcull merge " + folder_);
      }
    }
    words.push_back(context_for_python());
    if (no_pictures_) words.push_back("--no-pictures");
    if (device_) words.push_back("--device=" + *device_);
    become_python(std::move(words),
                  "install it (Debian: python3-matplotlib python3-pandas), or run "
                  "experiments/setup.sh");
  }

 private:
  std::string folder_;
  Text device_;
  bool no_pictures_ = false;
};

}  // namespace

Command add_report(CLI::App& app) { return declare<ReportCommand>(app); }

}  // namespace farcull
