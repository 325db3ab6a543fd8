// Turns questions into lines and lines into answers (docs/ask.md has the protocol), and starts a
// new process after one ended. Also lists the contestants that the study knows.
#include "experiments/peers/runner.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <optional>
#include <utility>

#include "core/base/error.h"
#include "core/base/text.h"

namespace farcull {
namespace {

ChildLimits child_limits(const ContestLimits& limits) {
  return {.start_s = limits.start_s,
          .line_s = limits.answer_s,
          .cpu_s = limits.cpu_s,
          .memory_mib = limits.memory_mib};
}

ContestOutcome outcome_of(ChildEnd::How how) {
  constexpr std::array kOutcomes = {ContestOutcome::unanswered, ContestOutcome::crashed,
                                    ContestOutcome::hung, ContestOutcome::no_memory};
  return kOutcomes.at(static_cast<std::size_t>(how));
}

void add_corners(const std::array<Vec3, 3>& corners, std::string& out) {
  for (const Vec3& p : corners) out += fmt::format("\t{}\t{}\t{}", p.x(), p.y(), p.z());
}

std::string question(std::size_t number, const SuitePair& pair) {
  std::string out = fmt::format("{}\tpair\t", number);
  for (const SharedCorner& corner : pair.shared)
    out += fmt::format("{}{}-{}", out.back() == '\t' ? "" : ",", corner.a, corner.b);
  if (pair.shared.empty()) out += "-";
  add_corners(pair.a, out);
  add_corners(pair.b, out);
  return out + "\n";
}

/// Removes the field up to the next tabulator, and the tabulator; returns the field.
std::string_view take_field(std::string_view& line) {
  const std::size_t at = std::min(line.find('\t'), line.size());
  const std::string_view out = line.substr(0, at);
  line.remove_prefix(std::min(at + 1, line.size()));
  return out;
}

/// Reads the answer that comes after the number; empty if there is none.
std::optional<ContestAnswer> read_answer(std::string_view line) {
  const std::string_view word = take_field(line);
  if (word == "refused") return ContestAnswer{ContestOutcome::refused, 0, std::string(line)};
  const auto ns = line.empty() ? 0.0 : parse_number<double>(line);
  if (!ns || *ns < 0 || (word != "0" && word != "1")) return {};
  return ContestAnswer{word == "1" ? ContestOutcome::meets : ContestOutcome::apart, *ns, ""};
}

/// Asks about the pairs at some positions, in their order.
class PairAsker {
 public:
  PairAsker(const Invited& invited, std::span<const SuitePair> pairs, const ContestLimits& limits)
      : invited_(invited), pairs_(pairs), limits_(limits) {}

  std::vector<ContestAnswer> ask(const std::vector<std::size_t>& order) {
    std::vector<ContestAnswer> answers(order.size());
    std::size_t next = 0, deaths = 0;
    while (next < order.size() && deaths < limits_.most_deaths) {
      ++processes;
      const std::size_t first = next;
      const ChildEnd end = ask_from(next, order, answers);
      if (next == order.size()) break;
      // A process that answered other questions may have used its limit up with them. So this
      // question is asked again, as the first of a new process.
      if (end.used_up && next > first) continue;
      // The process may not have read all questions in its pipe; a new process gets the later ones.
      answers[next++] = {outcome_of(end.how), 0, end.reason};
      ++deaths;
    }
    return answers;
  }

  std::size_t processes = 0;

 private:
  /// Asks one process. `next` is the first position that is not answered, before and after.
  ChildEnd ask_from(std::size_t& next, const std::vector<std::size_t>& order,
                    std::vector<ContestAnswer>& answers) const {
    std::size_t sent = next;
    const auto more = [&] {
      std::string out;
      while (sent < order.size() && out.size() < kPart) {
        out += question(sent, pairs_[order[sent]]);
        ++sent;
      }
      return out;
    };
    const auto line = [&](std::string_view text) {
      const auto number = parse_number<std::size_t>(take_field(text));
      std::optional<ContestAnswer> answer = read_answer(text);
      if (!number || !answer || *number < next || *number >= sent) return false;
      for (; next < *number; ++next) answers[next].outcome = ContestOutcome::unanswered;
      answers[next++] = std::move(*answer);
      return true;
    };
    ChildLimits limits = child_limits(limits_);
    // After the first start the program and its libraries are in memory, so a start is faster.
    if (processes > 1) limits.start_s = std::min(limits.start_s, 2 * limits.line_s);
    return run_child(invited_.program, limits, more, line);
  }

  static constexpr std::size_t kPart = 1 << 15;  // bytes of questions at a time
  const Invited& invited_;
  std::span<const SuitePair> pairs_;
  const ContestLimits& limits_;
};

/// Reads a pair, given by objects and triangles; empty if the scene has no such pair.
std::optional<TrianglePair> read_found(std::string_view line, const Scene& scene) {
  std::array<std::uint32_t, 2> out;
  for (std::uint32_t& t : out) {
    const auto o = parse_number<std::uint32_t>(take_field(line));
    const auto i = parse_number<std::uint32_t>(take_field(line));
    if (!o || !i || *o >= scene.objects.size() || *i >= scene.objects[*o].triangle_count) return {};
    t = scene.objects[*o].first_triangle + *i;
  }
  if (!line.empty()) return {};
  return TrianglePair{std::min(out[0], out[1]), std::max(out[0], out[1])};
}

// A program that reports pairs without end would take all memory.
constexpr std::size_t kMostFound = 50'000'000;
constexpr std::size_t kMostCard = 1 << 20;  // bytes

MeshAnswer ask_mesh_once(const Invited& invited, const SuiteMesh& mesh, const std::string& folder,
                         const ContestLimits& limits) {
  std::string input = fmt::format("0\tmesh\t{}", mesh.self ? 1 : 0);
  for (std::size_t o = 0; o < mesh.scene.objects.size(); ++o)
    input += fmt::format("\t{}/{}.obj", folder, o);
  input += "\n";
  MeshAnswer out;
  bool done = false;
  const auto line = [&](std::string_view text) {
    if (done || take_field(text) != "0") return false;
    const std::string_view word = take_field(text);
    if (word == "pair") {
      const std::optional<TrianglePair> pair = read_found(text, mesh.scene);
      if (pair && pair->a != pair->b) out.pairs.push_back(*pair);
      return pair.has_value() && out.pairs.size() <= kMostFound;
    }
    const auto ns = text.empty() ? 0.0 : parse_number<double>(text);
    done = word == "refused" || (word == "done" && ns);
    out.outcome = word == "refused" ? ContestOutcome::refused : ContestOutcome::meets;
    if (word == "refused") out.reason = std::string(text);
    if (ns) out.ns = *ns;
    return done;
  };
  // The whole answer about a scene may come at the end, so the first line may take the time of a
  // line.
  ChildLimits child = child_limits(limits);
  child.start_s = std::max(child.start_s, child.line_s);
  const ChildEnd end = run_child(
      invited.program, child, [&] { return std::exchange(input, {}); }, line);
  if (!done) {
    out = MeshAnswer{.outcome = outcome_of(end.how), .ns = 0, .reason = end.reason, .pairs = {}};
  }
  std::sort(out.pairs.begin(), out.pairs.end());
  out.pairs.erase(std::unique(out.pairs.begin(), out.pairs.end()), out.pairs.end());
  return out;
}

// The list of contestants that the study knows, and where their programs are.

using Names = std::vector<const char*>;

void add(std::vector<KnownContestant>& all, const char* program, const char* package,
         const Names& names, bool pairs = true, bool meshes = true, bool ours = false) {
  for (const char* name : names) all.push_back({name, program, package, pairs, meshes, ours});
}

std::vector<KnownContestant> make_list() {
  std::vector<KnownContestant> all;
  add(all, "ours", "",
      {"far-pairs", "exact", "far", "i-collide", "cullide", "quick-cullide", "s-cullide"}, true,
      true, true);
  add(all, "cgal", "libcgal-dev", {"cgal-exact", "cgal-self-intersections"});
  add(all, "cgal", "libcgal-dev", {"cgal-do-intersect", "cgal-double"}, true, false);
  add(all, "peers", "libfcl-dev", {"fcl-double", "fcl-float"});
  add(all, "bullet_double", "libbullet-dev",
      {"bullet-gimpact-double", "bullet-gimpact-margin-double"});
  add(all, "bullet_float", "libbullet-dev",
      {"bullet-gimpact-float", "bullet-gimpact-margin-float"});
  add(all, "peers", "libode-dev", {"ode-trimesh"});
  add(all, "libccd", "libccd-dev", {"libccd-gjk", "libccd-mpr"}, true, false);
  add(all, "gts", "libgts-dev", {"gts"});
  add(all, "vtk", "libvtk9-dev", {"vtk-collision"});
  add(all, "vtk", "libvtk9-dev", {"vtk-triangle", "vtk-intersection"}, true, false);
  add(all, "open3d", "libopen3d-dev", {"open3d"});
  constexpr const char* kNode = "nodejs, npm, and then packages of npm: experiments/libraries.sh";
  add(all, "node", kNode, {"three-mesh-bvh"});
  add(all, "node", kNode, {"rapier3d", "cannon-es"}, true, false);
  add(all, "textbook", "",
      {"moeller-double", "moeller-double-0", "moeller-float", "guigue-devillers-double",
       "guigue-devillers-float", "edge-face-double"},
      true, false);
  add(all, "peers", "libcgal-dev", {"cgal-boxes-exact", "cgal-aabb-exact"}, false);
  add(all, "peers", "libfcl-dev", {"fcl-obbrss-exact"}, false);
  add(all, "peers", "libembree-dev", {"embree-medium-exact"}, false);
  add(all, "peers", "libbullet-dev", {"bullet-gimpact-exact"}, false);
  return all;
}

std::string folder() {
  const char* const named = std::getenv("FARCULL_CONTESTANTS");
  if (named != nullptr && *named != '\0') return named;
  std::error_code error;
  const std::filesystem::path self = std::filesystem::read_symlink("/proc/self/exe", error);
  return (self.parent_path() / "contestants").string();
}

}  // namespace

std::string to_string(ContestOutcome outcome) {
  constexpr std::array kNames = {"apart",   "meets", "refused",   "unanswered",
                                 "crashed", "hung",  "no memory", "not asked"};
  return kNames.at(static_cast<std::size_t>(outcome));
}

bool answered(ContestOutcome outcome) {
  return outcome == ContestOutcome::apart || outcome == ContestOutcome::meets ||
         outcome == ContestOutcome::refused;
}

bool is_death(ContestOutcome outcome) {
  return outcome == ContestOutcome::crashed || outcome == ContestOutcome::hung ||
         outcome == ContestOutcome::no_memory;
}

PairsAnswer ask_pairs(const Invited& invited, std::span<const SuitePair> pairs,
                      const ContestLimits& limits, std::size_t sample) {
  PairsAnswer out;
  PairAsker asker(invited, pairs, limits);
  std::vector<std::size_t> order(pairs.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  out.answers = asker.ask(order);
  std::vector<std::size_t> again;
  for (std::size_t i = 0; sample > 0 && i < pairs.size(); i += sample) {
    if (answered(out.answers[i].outcome)) again.push_back(i);
  }
  std::reverse(again.begin(), again.end());
  const std::vector<ContestAnswer> second = asker.ask(again);
  for (std::size_t i = 0; i < again.size(); ++i) {
    // If the second time brings no answer, it counts as a different one.
    if (second[i].outcome == ContestOutcome::not_asked) continue;
    ++out.asked_twice;
    if (second[i].outcome != out.answers[again[i]].outcome) out.differing.push_back(again[i]);
  }
  std::sort(out.differing.begin(), out.differing.end());
  out.processes = asker.processes;
  return out;
}

MeshAnswer ask_mesh(const Invited& invited, const SuiteMesh& mesh, const std::string& folder,
                    const ContestLimits& limits, bool twice) {
  MeshAnswer out = ask_mesh_once(invited, mesh, folder, limits);
  if (!twice || !answered(out.outcome)) return out;
  const MeshAnswer second = ask_mesh_once(invited, mesh, folder, limits);
  out.differs = second.outcome != out.outcome || second.pairs != out.pairs;
  if (second.outcome == out.outcome) out.ns = std::min(out.ns, second.ns);
  return out;
}

Invited invite(const ContestProgram& program, const ContestLimits& limits) {
  std::string question = "0\tcard\n", text;
  bool done = false;
  const ChildEnd end = run_child(
      program, {.start_s = limits.start_s, .line_s = limits.answer_s, .cpu_s = limits.cpu_s},
      [&question] { return std::exchange(question, {}); },
      [&](std::string_view line) {
        if (done || take_field(line) != "0") return false;
        const std::string_view word = take_field(line);
        done = word == "done" && line.empty();
        if (word == "card") text += std::string(line) + "\n";
        return done || (word == "card" && text.size() <= kMostCard);
      });
  if (!done)
    throw Error(program.back(), "gives no card: " + end.reason, "docs/ask.md has the protocol");
  return {read_card(text, program.back()), program};
}

const std::vector<KnownContestant>& known_contestants() {
  static const std::vector<KnownContestant> all = make_list();
  return all;
}

const KnownContestant& known_contestant(const std::string& name) {
  const std::vector<KnownContestant>& all = known_contestants();
  const auto at = std::find_if(all.begin(), all.end(),
                               [&](const KnownContestant& of) { return of.name == name; });
  if (at == all.end()) {
    std::string names;
    for (const KnownContestant& of : all) names += (names.empty() ? "" : ", ") + of.name;
    throw Error("contestant", "'" + name + "' is none", "choose of " + names);
  }
  return *at;
}

Invitation invite_known(const KnownContestant& contestant) {
  static std::map<std::pair<std::string, std::string>, Invitation> known;
  const std::string path = folder() + "/farcull_contestant_" + contestant.program;
  Invitation& out = known[{path, contestant.name}];
  if (out.invited || !out.missing.empty()) return out;
  try {
    if (::access(path.c_str(), X_OK) == 0) {
      out.invited = invite({path, contestant.name});
      return out;
    }
    out.missing = contestant.name + ": its program was not built";
  } catch (const Error& error) {
    out.missing = contestant.name + ": " + error.reason;
  }
  if (!contestant.package.empty()) out.missing += " (Debian: " + contestant.package + ")";
  return out;
}

}  // namespace farcull
