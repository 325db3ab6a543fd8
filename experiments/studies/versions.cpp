// Compares the count `library` of rows, which holds the name and the version of the library.
#include "experiments/studies/versions.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>

#include "core/base/error.h"
#include "experiments/system/shell_word.h"

namespace farcull {
namespace {

// With its version; empty where the row names none.
std::string library_of(const Row& row) {
  const auto at = row.measurement.counts->find("library");
  return at != row.measurement.counts->end() && at->is_string() ? at->get<std::string>() : "";
}

// The command that deletes all rows of these contestants.
std::string deletion(const std::string& path, const std::string& study,
                     const std::vector<std::string>& contestants) {
  std::string names;
  for (const std::string& name : contestants) names += (names.empty() ? "'" : ", '") + name + "'";
  return fmt::format(
      "sqlite3 {} \"DELETE FROM rows WHERE study = '{}' AND position IN (SELECT position FROM "
      "points WHERE study = '{}' AND method IN ({}))\"",
      quoted(path), study, study, names);
}

}  // namespace

void require_same_versions(const std::string& path, const StoredStudy& stored, const Study& study,
                           const std::vector<Point>& points, const std::vector<std::size_t>& open) {
  if (!study.library) return;
  std::map<std::string, std::string> then;
  for (const Row& row : stored.rows) {
    if (const std::string library = library_of(row); !library.empty())
      then[row.point.method] = library;
  }
  std::string reason;
  std::vector<std::string> contestants;
  for (const std::size_t position : open) {
    const std::string& name = stored.declaration.points[position].method;
    const auto at = then.find(name);
    if (at == then.end()) continue;
    const std::string now = study.library(points[position]);
    if (!now.empty() && now != at->second) {
      reason += fmt::format("{}its rows of {} are of {}, and {} is here now",
                            reason.empty() ? "" : "; ", name, at->second, now);
      contestants.push_back(name);
    }
    then.erase(at);  // each contestant is asked once
  }
  if (contestants.empty()) return;
  throw Error(path, reason,
              "start anew in another folder (--out), or delete these rows, which are then measured "
              "again: " +
                  deletion(path, study.name, contestants));
}

void require_one_version(const std::vector<StudyOfFile>& files) {
  struct First {
    std::string library, path;
  };
  std::map<std::string, First> first;
  for (const StudyOfFile& file : files) {
    for (const Row& row : file.stored->rows) {
      const std::string library = library_of(row), &name = row.point.method;
      if (library.empty()) continue;
      const auto [known, fresh] = first.try_emplace(name, First{library, file.path});
      if (known->second.library == library) continue;
      const bool one_file = known->second.path == file.path;
      throw Error(
          file.path,
          fmt::format("its rows of {} are of {}, and {} of {}", name, library,
                      one_file ? "others" : "those of " + known->second.path,
                      known->second.library),
          (one_file
               ? "start anew in another folder, or delete these rows and measure them again with "
                 "--resume: "
               : "measure one of the two again in another folder, or delete these rows there "
                 "and measure them again with --resume: ") +
              deletion(file.path, file.stored->declaration.study, {name}));
    }
  }
}

}  // namespace farcull
