// The study "libraries": wrong answers of other libraries, textbook tests and our own methods on a
// labelled suite. Each contestant runs in processes of its own (peers/runner.h).
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <variant>

#include "core/base/error.h"
#include "experiments/generators/pair_generators.h"
#include "experiments/measure/harness.h"
#include "experiments/peers/score.h"
#include "experiments/studies/study.h"
#include "experiments/suite/writer.h"

namespace farcull {
namespace {

SuiteSettings settings_of(bool small, std::uint64_t seed) {
  return {.size = small ? SuiteSize::small : SuiteSize::full, .seed = seed};
}

std::vector<std::string> last_parts(const std::vector<std::string>& paths, bool extension) {
  std::vector<std::string> out;
  for (const std::filesystem::path path : paths)
    out.push_back((extension ? path.stem() : path.filename()).string());
  return out;
}

// Adds a point for each chosen contestant and each name.
void add(const std::vector<std::string>& names, const GridChoice& choice, LibraryPoint point,
         std::vector<Point>& out) {
  const std::vector<std::string>& chosen = choice.contestants;
  for (const std::string& name : names) {
    for (const KnownContestant& contestant : known_contestants()) {
      if (!(point.mesh ? contestant.meshes : contestant.pairs)) continue;
      if (!chosen.empty() &&
          std::find(chosen.begin(), chosen.end(), contestant.name) == chosen.end())
        continue;
      point.contestant = contestant.name;
      point.family = name;
      out.emplace_back(point);
    }
  }
}

// Lists all contestants of one family together, so that the family is made once.
std::vector<Point> grid(const GridChoice& choice) {
  LibraryPoint pairs{.contestant = {},
                     .family = {},
                     .small = choice.quick,
                     .seed = choice.seed,
                     .suite = choice.suite};
  std::vector<std::string> families, meshes;
  if (choice.suite.empty()) {
    for (const PairFamily& family : pair_families()) families.push_back(family.name);
    meshes = mesh_names(choice.quick ? SuiteSize::small : SuiteSize::full);
  } else {
    const SuiteIndex index = read_suite(choice.suite);
    pairs.suite_name = index.sum.substr(0, 8);
    families = last_parts(index.pair_files(), true);
    meshes = last_parts(index.mesh_folders(), false);
  }
  LibraryPoint of_meshes = pairs;
  of_meshes.mesh = true;
  std::vector<Point> out;
  add(families, choice, pairs, out);
  add(meshes, choice, of_meshes, out);
  return out;
}

// The pairs of a family; the last family is cached.
const SuitePairs& pairs_of(const LibraryPoint& point) {
  static std::pair<std::string, SuitePairs> last;
  const std::string name = key_of(point).scene + fmt::format(", seed {}", point.seed);
  if (last.first != name) {
    SuitePairs pairs = point.suite.empty()
                           ? make_pairs(point.family, settings_of(point.small, point.seed))
                           : read_pairs(point.suite + "/pairs/" + point.family + ".txt");
    last = {name, std::move(pairs)};
  }
  return last.second;
}

// A mesh, and a folder with its files as a contestant reads them, which the destructor removes.
struct MeshFiles {
  explicit MeshFiles(const LibraryPoint& point)
      : mesh(point.suite.empty() ? make_mesh(point.family, settings_of(point.small, point.seed))
                                 : read_mesh(point.suite + "/meshes/" + point.family)) {
    std::string pattern = (std::filesystem::temp_directory_path() / "farcull-mesh-XXXXXX").string();
    if (::mkdtemp(pattern.data()) == nullptr)
      throw Error(pattern, "cannot be made", "set TMPDIR to a folder that can be written");
    folder = pattern;
    for (const SuiteText& text : mesh_texts(mesh)) {
      std::ofstream file(folder + "/" + text.name, std::ios::binary);
      file << text.text;
      if (!file.flush()) {
        remove();
        throw Error(folder, "cannot be written", "free space in TMPDIR");
      }
    }
  }
  ~MeshFiles() { remove(); }
  MeshFiles(const MeshFiles&) = delete;
  MeshFiles& operator=(const MeshFiles&) = delete;

  SuiteMesh mesh;
  std::string folder;

 private:
  void remove() const {
    std::error_code error;
    std::filesystem::remove_all(folder, error);
  }
};

LibraryCounts counts_of(const ContestantCard& card, const std::vector<Score>& scores) {
  LibraryCounts out;
  Score sum;
  for (const Score& score : scores) add(score, sum);
  std::tie(out.asked, out.answered, out.missed, out.wrong, out.own_asked, out.own_missed,
           out.own_wrong, out.refused, out.unanswered, out.crashed, out.hung, out.no_memory,
           out.not_asked, out.twice, out.differing) = sum.members();
  out.reason = sum.reason;
  out.promises = card.promises;
  out.library = card.library;
  out.means = card.means == Means::closed ? "closed" : "crossing";
  out.call = card.call;
  out.says = card.says;
  out.source = card.source;
  out.use = card.use;
  out.scores = scores_text(scores);
  return out;
}

bool missed(const SuitePair& pair, ContestOutcome outcome) {
  return outcome == ContestOutcome::apart && collides(pair.kind);
}
bool wrong(const SuitePair& pair, ContestOutcome outcome) {
  return outcome == ContestOutcome::meets && !collides(pair.kind);
}

void add_firsts(const std::vector<SuitePair>& pairs, const std::vector<ContestAnswer>& answers,
                LibraryCounts& counts) {
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const auto note = [&](std::optional<std::uint64_t>& first) {
      if (!first) first = pairs[i].id;
    };
    const ContestOutcome outcome = answers[i].outcome;
    if (is_death(outcome)) note(counts.first_death);
    if (pairs[i].kind == SuiteKind::unlabelled) continue;
    if (missed(pairs[i], outcome)) note(counts.first_missed);
    if (wrong(pairs[i], outcome)) note(counts.first_wrong);
  }
}

// Minimizes the first fault of each kind on a pair for which the documentation promises the answer.
void add_examples(const Invited& invited, const ContestLimits& limits,
                  const std::vector<SuitePair>& pairs, const std::vector<ContestAnswer>& answers,
                  LibraryCounts& counts) {
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (!promised(invited.card, pairs[i])) continue;
    const ContestOutcome outcome = answers[i].outcome;
    std::optional<std::string>* const to = is_death(outcome)           ? &counts.example_death
                                           : missed(pairs[i], outcome) ? &counts.example_missed
                                           : wrong(pairs[i], outcome)  ? &counts.example_wrong
                                                                       : nullptr;
    if (to == nullptr || *to) continue;
    std::optional<SuitePair> small = minimized(invited, {pairs[i], outcome}, limits);
    if (!small) continue;
    small->id = 0;
    *to = pair_line(*small);
  }
}

PointResult ask_about_pairs(const LibraryPoint& point, const Invited& invited,
                            const ContestLimits& limits) {
  std::vector<SuitePair> asked;
  std::uint64_t left_out = 0;
  for (const SuitePair& pair : pairs_of(point).pairs) {
    if (takes(invited.card, pair)) {
      asked.push_back(pair);
    } else {
      ++left_out;
    }
  }
  const PairsAnswer answer = ask_pairs(invited, asked, limits);
  LibraryCounts counts = counts_of(invited.card, score_pairs(invited.card, asked, answer));
  counts.neighbours_left_out = left_out;
  double ns = 0;
  for (const ContestAnswer& one : answer.answers) {
    ns += one.ns;
    counts.timed += one.outcome == ContestOutcome::apart || one.outcome == ContestOutcome::meets;
  }
  add_firsts(asked, answer.answers, counts);
  add_examples(invited, limits, asked, answer.answers, counts);
  return {.counts = counts, .times = {.total = ns / 1e6}, .device = "process"};
}

PointResult measure(const Point& at, Lab& lab) {
  const auto& point = std::get<LibraryPoint>(at);
  // The processes of our own methods read this variable.
  ::setenv("FARCULL_CONTEST_DEVICE", lab.device().c_str(), 1);
  const Invitation invitation = invite_known(known_contestant(point.contestant));
  if (!invitation.invited) return {.device = "none", .left_out = invitation.missing};
  const ContestLimits limits = point.small
                                   ? ContestLimits{.answer_s = 5, .start_s = 30, .most_deaths = 20}
                                   : ContestLimits{.answer_s = 30, .start_s = 300};
  const Invited& invited = *invitation.invited;
  if (!point.mesh) return ask_about_pairs(point, invited, limits);
  const MeshFiles files(point);
  const MeshAnswer answer = ask_mesh(invited, files.mesh, files.folder, limits);
  return {.counts = counts_of(invited.card, {score_mesh(invited.card, files.mesh, answer)}),
          .times = {.total = answer.ns / 1e6},
          .device = "process"};
}

std::string library(const Point& at) {
  const KnownContestant& known = known_contestant(std::get<LibraryPoint>(at).contestant);
  const Invitation invitation = invite_known(known);
  return invitation.invited ? invitation.invited->card.library : "";
}

}  // namespace

Study libraries_study() {
  return {.name = "libraries",
          .title = "What other libraries miss",
          .question =
              "Which pairs of a labelled suite do libraries, textbook tests and the methods "
              "of farcull miss, report wrongly, or refuse, and at which do they crash?",
          .grid = grid,
          .measure = measure,
          .library = library,
          .campaign = true};
}

}  // namespace farcull
