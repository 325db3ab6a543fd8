// Counts of pairs of triangles and of pairs of meshes are never added: the first are questions,
// each with its answer, the second are what one answer about a mesh has to consist of.
#include "experiments/report/chapters/library_findings.h"

#include <fmt/format.h>

#include <algorithm>

#include "experiments/report/chapters/library_rows.h"
#include "experiments/report/chapters/numbers.h"
#include "experiments/system/text_table.h"

namespace farcull {
namespace {

std::size_t answered_meshes(const Rows& meshes) {
  return static_cast<std::size_t>(std::count_if(
      meshes.begin(), meshes.end(), [](const Row* row) { return without_answer({row}) == 0; }));
}

// A wrong answer of a method that promises breaks the promise.
void find_broken_answers(const std::string& name, const Rows& pairs, const Rows& meshes,
                         Chapter& chapter) {
  const auto broken = [&](std::uint64_t bad, const std::string& of) {
    if (bad > 0)
      chapter.find_broken(fmt::format("{}: {} {}, and it promises none.", name, grouped(bad), of));
  };
  const std::string asked = grouped(total(pairs, "answered"));
  broken(total(pairs, "missed"), fmt::format("of {} pairs missed", asked));
  broken(total(pairs, "wrong"), fmt::format("of {} pairs reported wrongly", asked));
  const MeshAnswers of = mesh_answers(meshes, false);
  const std::string many = counted(answered_meshes(meshes), "mesh", "meshes");
  broken(of.missed,
         fmt::format("of the {} colliding pairs of {} missed", grouped(of.colliding), many));
  broken(of.false_alarms,
         fmt::format("of the {} pairs reported of {} are apart", grouped(of.reported), many));
}

// Each method of farcull that promises.
void find_ours(const Rows& rows, Chapter& chapter) {
  for (const NamedRows& one : rows_by_contestant(rows)) {
    Rows of;
    for (const Row* row : one.rows) {
      if (promises(*row)) of.push_back(row);
    }
    if (of.empty()) continue;
    const std::string& name = of.front()->point.method;
    const Rows pairs = rows_about(of, true), meshes = rows_about(of, false);
    find_broken_answers(name, pairs, meshes, chapter);
    const std::uint64_t silent = without_answer(of);
    if (silent > 0)
      chapter.find_broken(
          fmt::format("{} has no answer to {}.", name, counted(silent, "question", "questions")));
    // Those that have a label.
    const std::uint64_t asked = total(pairs, "answered"), colliding = total(meshes, "answered");
    if (asked + colliding == 0 || total(of, "missed") + total(of, "wrong") + silent > 0) continue;
    std::string what;
    if (asked > 0) what = fmt::format("of {}", counted(asked, "pair", "pairs"));
    if (colliding > 0) {
      what += fmt::format("{}of the {} of {}", asked > 0 ? ", and " : "",
                          counted(colliding, "colliding pair", "colliding pairs"),
                          counted(answered_meshes(meshes), "mesh", "meshes"));
    }
    chapter.find(fmt::format("{} missed none and reported none wrongly {}.", name, what));
  }
}

// The sums of a contestant by its own documentation: how bad it is, and in words.
struct OwnErrors {
  bool any_question = false;
  double part = 0;  // of wrong answers
  std::string text = {};
};
OwnErrors own_errors(const Rows& rows, bool pairs) {
  if (!pairs) {
    const MeshAnswers of = mesh_answers(rows, true);
    return {.any_question = of.colliding + of.reported > 0,
            .part = wrong_part(of),
            .text = fmt::format("{}, {}", of_all(of.missed, of.colliding),
                                of_all(of.false_alarms, of.reported))};
  }
  const std::uint64_t bad = total(rows, "own_missed") + total(rows, "own_wrong"),
                      all = total(rows, "own_asked");
  if (all == 0) return {};
  return {.any_question = true,
          .part = static_cast<double>(bad) / static_cast<double>(all),
          .text = of_all(bad, all)};
}

// Sentences about the contestants that do not promise: those that gave no wrong answer by their own
// documentation, the others, and those that died. `pairs`: rows of pairs of triangles; else of
// meshes.
void find_others(const Rows& rows, bool pairs, Chapter& chapter) {
  std::vector<std::string> right, dead, published, changing;
  std::vector<std::pair<double, std::string>> worst;
  for (const NamedRows& one : rows_by_contestant(rows)) {
    const Row& row = *one.rows.front();
    if (promises(row)) continue;
    const std::string& name = row.point.method;
    if (is_ours(row)) {
      published.push_back(fmt::format("{} ({})", name, of_all(one.rows, "missed", "answered")));
      continue;
    }
    if (deaths(one.rows) > 0)
      dead.push_back(fmt::format("{} ({})", name, grouped(deaths(one.rows))));
    if (total(one.rows, "differing") > 0)
      changing.push_back(fmt::format("{} ({})", name, differing(one.rows)));
    const OwnErrors errors = own_errors(one.rows, pairs);
    if (!errors.any_question) continue;
    if (errors.part == 0) {
      right.push_back(name);
    } else {
      worst.emplace_back(errors.part, fmt::format("{} ({})", name, errors.text));
    }
  }
  std::stable_sort(worst.begin(), worst.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  std::vector<std::string> names;
  for (const auto& [part, text] : worst) names.push_back(text);
  const auto say = [&](const std::string& start, const std::vector<std::string>& who) {
    if (!who.empty())
      chapter.find(fmt::format("Of {}, {}: {}.", pairs ? "pairs of triangles" : "meshes", start,
                               listed(who)));
  };
  say("these gave no wrong answer by their own documentation", right);
  say(pairs ? "wrong answers to questions of which their documentation promises the answer, of all "
              "such that were answered"
            : "wrong answers where their documentation promises the answer (first the missed pairs "
              "of those that collide, then the false alarms of those that were reported)",
      names);
  say("missed by methods as they were published, which promise nothing below the size of a pixel",
      published);
  say("answered otherwise when they were asked again", changing);
  say("questions at which the process crashed, hung or ran out of memory", dead);
}

// A store of an earlier farcull may hold both.
void find_two_versions(const Rows& rows, Chapter& chapter) {
  for (const NamedRows& one : rows_by_contestant(rows)) {
    std::vector<std::string> versions;
    for (const Row* row : one.rows) {
      const std::string version = text_of(*row, "library");
      if (std::find(versions.begin(), versions.end(), version) == versions.end())
        versions.push_back(version);
    }
    if (versions.size() > 1)
      chapter.find(fmt::format("The rows of {} are of more than one version: {}.",
                               one.rows.front()->point.method, listed(versions)));
  }
}

}  // namespace

void find_in_libraries(const Rows& rows, Chapter& chapter) {
  find_ours(rows, chapter);
  find_two_versions(rows, chapter);
  find_others(rows_about(rows, true), true, chapter);
  find_others(rows_about(rows, false), false, chapter);
}

}  // namespace farcull
