// Joins the stores of shards to one store. Refuses rows that do not fit together in one store, such
// as rows with two versions of a library.
#include "experiments/studies/run_studies.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>

#include "core/base/error.h"
#include "core/base/text.h"
#include "experiments/system/output_file.h"

namespace farcull {
namespace {

namespace fs = std::filesystem;

constexpr long kMostShards = 100'000;
constexpr const char* kMeasureAgain = "measure it again as the others were";

// Returns the row's library with its version, or "" if the row names no library.
std::string library_of(const Row& row) {
  const auto at = row.measurement.counts.find("library");
  return at != row.measurement.counts.end() && at->is_string() ? at->get<std::string>() : "";
}

struct Source {
  std::string path;
  std::vector<std::pair<std::int64_t, Provenance>> runs;
  std::vector<StoredStudy> studies;
};

Source read(const std::string& path) {
  const Store store(path, Store::Access::read);
  Source out{.path = path, .runs = store.runs(), .studies = {}};
  for (const std::string& name : store.studies()) out.studies.push_back(store.study(name));
  return out;
}

// Returns the commits of the programs that measured the rows of a study.
std::set<std::string> commits_of(const Source& source, std::size_t study) {
  std::set<std::int64_t> used;
  for (const Row& row : source.studies[study].rows) used.insert(row.run);
  std::set<std::string> out;
  for (const auto& [run, provenance] : source.runs) {
    if (used.contains(run)) out.insert(provenance.commit);
  }
  return out;
}

// Throws Error if the studies, grids or programs of two stores differ.
void require_alike(const Source& first, const Source& other) {
  const auto refuse = [&](const std::string& what) {
    throw Error(other.path, what + " than " + first.path, kMeasureAgain);
  };
  if (other.studies.size() != first.studies.size()) refuse("holds other studies");
  for (std::size_t i = 0; i < first.studies.size(); ++i) {
    const Declaration& a = first.studies[i].declaration;
    const Declaration& b = other.studies[i].declaration;
    if (a.study != b.study) refuse("holds other studies");
    if (a.choice.quick != b.choice.quick || a.choice.seed != b.choice.seed)
      refuse(a.study + " has another grid or seed");
    if (a.points != b.points) refuse(a.study + " has other points");
    if (a.of != b.of) refuse(a.study + " is divided into another number of shards");
  }
  for (std::size_t i = 0; i < first.studies.size(); ++i) {
    std::set<std::string> commits = commits_of(first, i);
    for (const std::string& commit : commits_of(other, i)) {
      if (!commits.empty() && !commits.contains(commit))
        refuse(first.studies[i].declaration.study + " is of another commit (" + commit + ")");
    }
  }
}

// Throws Error if a shard is missing or repeated, or if the number of complete rows of a point is
// not 1.
void require_whole(const std::vector<Source>& sources) {
  for (std::size_t i = 0; i < sources.front().studies.size(); ++i) {
    const Declaration& all = sources.front().studies[i].declaration;
    std::map<int, std::string> shards;
    std::map<std::size_t, std::string> rows;
    for (const Source& source : sources) {
      const StoredStudy& stored = source.studies[i];
      const auto [same, fresh] = shards.emplace(stored.declaration.shard, source.path);
      if (!fresh) {
        throw Error(source.path,
                    fmt::format("is shard {}/{} of {}, and so is {}", stored.declaration.shard,
                                all.of, all.study, same->second),
                    "name one of the two");
      }
      for (const Row& row : stored.rows) {
        if (!is_whole(row.measurement)) continue;
        const auto [other, first] = rows.emplace(row.position, source.path);
        if (!first) {
          throw Error(source.path,
                      "holds a point of " + all.study + " that " + other->second +
                          " holds too: " + describe(row.point),
                      kMeasureAgain);
        }
      }
    }
    for (int shard = 1; shard <= all.of; ++shard) {
      if (!shards.contains(shard)) {
        throw Error(fmt::format("shard {}/{}", shard, all.of), "of " + all.study + " is missing",
                    "name its file as well");
      }
    }
    for (std::size_t p = 0; p < all.points.size(); ++p) {
      if (!rows.contains(p)) {
        const int shard = static_cast<int>(p % static_cast<std::size_t>(all.of)) + 1;
        throw Error(shards.at(shard), "has no row of " + all.study + ": " + describe(all.points[p]),
                    "finish it: the command that began it, with --resume");
      }
    }
  }
}

// Gives all rows of a point the times of the point's first row. Without this, times could differ,
// since several studies may have the point, in shards that were timed separately.
void share_times(std::vector<Source>& sources) {
  std::map<PointKey, nlohmann::ordered_json> times;
  for (std::size_t i = 0; i < sources.front().studies.size(); ++i) {
    for (Source& source : sources) {
      for (Row& row : source.studies[i].rows) {
        if (rounds_in(row.measurement).value_or(0) == 0 || !row.measurement.left_out.empty())
          continue;
        row.measurement.times = times.try_emplace(row.point, row.measurement.times).first->second;
      }
    }
  }
}

}  // namespace

Shard parse_shard(const std::string& text) {
  const std::size_t slash = text.find('/');
  const std::optional<long> index = parse_number<long>(text.substr(0, slash));
  const std::optional<long> of =
      slash == std::string::npos ? std::nullopt : parse_number<long>(text.substr(slash + 1));
  if (!index || !of || *of < 1 || *of > kMostShards || *index < 1 || *index > *of) {
    throw Error("--shard", "'" + text + "' is no shard",
                fmt::format("give K/N with 1 <= K <= N <= {}, such as 2/4", kMostShards));
  }
  return {static_cast<int>(*index), static_cast<int>(*of)};
}

void require_same_versions(const std::string& path, const StoredStudy& stored, const Study& study,
                           const std::vector<Point>& points, const std::vector<std::size_t>& open) {
  if (!study.library) return;
  std::map<std::string, std::string> then;
  for (const Row& row : stored.rows) {
    if (const std::string library = library_of(row); !library.empty())
      then[row.point.method] = library;
  }
  std::string reason;
  for (const std::size_t position : open) {
    const std::string& name = stored.declaration.points[position].method;
    const auto at = then.find(name);
    if (at == then.end()) continue;
    const std::string now = study.library(points[position]);
    if (!now.empty() && now != at->second)
      reason += fmt::format("{}its rows of {} are of {}, and {} is here now",
                            reason.empty() ? "" : "; ", name, at->second, now);
    then.erase(at);  // each contestant is checked only once
  }
  if (!reason.empty()) throw Error(path, reason, "start anew in another folder (--out)");
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
      throw Error(file.path,
                  fmt::format("its rows of {} are of {}, and {} of {}", name, library,
                              one_file ? "others" : "those of " + known->second.path,
                              known->second.library),
                  one_file ? "start anew in another folder"
                           : "measure one of the two again in another folder");
    }
  }
}

std::vector<std::string> shard_files(const std::string& folder) {
  std::error_code code;
  std::vector<std::string> out;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, code)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with("results-") && name.ends_with(".sqlite") &&
        name.find("-of-") != std::string::npos)
      out.push_back(entry.path().string());
  }
  if (code)
    throw Error(folder, "cannot be read: " + code.message(), "name the folder of the shards");
  if (out.empty()) {
    throw Error(folder, "holds no shards (results-K-of-N.sqlite)",
                "measure them first: farcull experiment NAME --shard K/N --out " + folder);
  }
  std::sort(out.begin(), out.end());
  return out;
}

MergeSummary merge_stores(const std::vector<std::string>& files, const std::string& out) {
  // SQLite would use an old journal as the journal of the new file.
  for (const char* beside : {"", "-journal", "-wal"}) {
    if (fs::exists(fs::symlink_status(out + beside)))
      throw Error(out + beside, "is there already", "move it away, or name another file with -o");
  }
  std::vector<Source> sources;
  for (const std::string& file : files) {
    sources.push_back(read(file));
    require_alike(sources.front(), sources.back());
  }
  for (std::size_t i = 0; i < sources.front().studies.size(); ++i) {
    std::vector<StudyOfFile> of_study;
    for (const Source& source : sources) of_study.push_back({source.path, &source.studies[i]});
    require_one_version(of_study);
  }
  require_whole(sources);
  share_times(sources);

  StreamedOutput file(out);
  MergeSummary summary{.files = files.size(), .studies = sources.front().studies.size()};
  std::set<std::string> machines;
  for (const Source& source : sources) {
    for (const auto& [run, p] : source.runs)
      machines.insert(p.gl_renderer + ", " + p.gl_version + ", " + p.cpu + ", " + p.cpu_features);
  }
  summary.machines = machines.size();
  {
    Store store(file.half(), Store::Access::write_at_once);
    for (const StoredStudy& stored : sources.front().studies) {
      Declaration whole = stored.declaration;
      whole.shard = whole.of = 1;
      store.declare(whole);
    }
    store.together([&] {
      for (const Source& source : sources) {
        std::map<std::int64_t, std::int64_t> renamed;
        for (const auto& [run, provenance] : source.runs)
          renamed[run] = store.begin_run(provenance);
        for (const StoredStudy& stored : source.studies) {
          for (Row row : stored.rows) {
            row.run = renamed.at(row.run);
            store.add(stored.declaration.study, row);
            ++summary.rows;
          }
        }
      }
    });
  }
  file.put();
  return summary;
}

}  // namespace farcull
