// Turns questions into lines and lines into answers (contestant.h has the protocol), and starts a
// new process where one ended.
#include "experiments/peers/runner.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "core/base/error.h"
#include "core/base/text.h"
#include "experiments/peers/child.h"

namespace farcull {
namespace {

ChildLimits child_limits(const Invited& invited, const ContestLimits& limits) {
  return {.start_s = limits.start_s,
          .line_s = limits.answer_s,
          .cpu_s = limits.cpu_s,
          .memory_mib = limits.memory_mib > 0 ? limits.memory_mib : invited.card.memory_mib};
}

std::vector<std::string> command_of(const Invited& invited, const char* what) {
  std::vector<std::string> out = invited.program;
  out.push_back(invited.card.name);
  out.emplace_back(what);
  return out;
}

ContestOutcome outcome_of(ChildEnd::How how) {
  switch (how) {
    case ChildEnd::How::peace:
      return ContestOutcome::unanswered;
    case ChildEnd::How::crash:
      return ContestOutcome::crashed;
    case ChildEnd::How::time:
      return ContestOutcome::hung;
    case ChildEnd::How::memory:
      return ContestOutcome::no_memory;
  }
  return ContestOutcome::crashed;
}

void add_corners(const std::array<Vec3, 3>& corners, std::string& out) {
  for (const Vec3& p : corners) out += fmt::format("\t{}\t{}\t{}", p.x(), p.y(), p.z());
}

std::string question(std::size_t number, const SuitePair& pair) {
  std::string out = fmt::format("{}\t", number);
  for (const SharedCorner& corner : pair.shared)
    out += fmt::format("{}{}-{}", out.back() == '\t' ? "" : ",", corner.a, corner.b);
  if (pair.shared.empty()) out += "-";
  add_corners(pair.a, out);
  add_corners(pair.b, out);
  return out + "\n";
}

/// The field up to the next tabulator, which is removed with it.
std::string_view take_field(std::string_view& line) {
  const std::size_t at = std::min(line.find('\t'), line.size());
  const std::string_view out = line.substr(0, at);
  line.remove_prefix(std::min(at + 1, line.size()));
  return out;
}

/// What stands after the number; empty: no answer.
std::optional<ContestAnswer> read_answer(std::string_view line) {
  const std::string_view word = take_field(line);
  if (word == "refused") return ContestAnswer{ContestOutcome::refused, 0, std::string(line)};
  const auto ns = parse_number<double>(line);
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
      // A process that answered others may have used its limit up with them: this question is asked
      // again, as the first of a new one.
      if (end.used_up && next > first) continue;
      // The others may have been in its pipe, and are asked in a new one.
      answers[next++] = {outcome_of(end.how), 0, end.reason};
      ++deaths;
    }
    return answers;
  }

  std::size_t processes = 0;

 private:
  /// One process. `next`: the first position that is not answered, before and after.
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
    ChildLimits limits = child_limits(invited_, limits_);
    // Once it has started, the program and its libraries are in memory.
    if (processes > 1) limits.start_s = std::min(limits.start_s, 2 * limits.line_s);
    return run_child(command_of(invited_, "pairs"), limits, more, line);
  }

  static constexpr std::size_t kPart = 1 << 15;  // bytes of questions at a time
  const Invited& invited_;
  std::span<const SuitePair> pairs_;
  const ContestLimits& limits_;
};

/// A pair of the scene by object and triangle; empty where there is no such.
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
constexpr std::size_t kMostCards = 1 << 20;  // bytes

MeshAnswer ask_mesh_once(const Invited& invited, const SuiteMesh& mesh, const std::string& folder,
                         const ContestLimits& limits) {
  std::string input = fmt::format("0\t{}", mesh.self ? 1 : 0);
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
    const auto ns = parse_number<double>(text);
    done = word == "refused" || (word == "done" && ns);
    out.outcome = word == "refused" ? ContestOutcome::refused : ContestOutcome::meets;
    if (word == "refused") out.reason = std::string(text);
    if (ns) out.ns = *ns;
    return done;
  };
  // The whole answer of a scene may come at its end, so it has the time of a start.
  ChildLimits child = child_limits(invited, limits);
  child.start_s = std::max(child.start_s, child.line_s);
  const ChildEnd end = run_child(
      command_of(invited, "meshes"), child, [&] { return std::exchange(input, {}); }, line);
  if (!done) {
    out = MeshAnswer{.outcome = outcome_of(end.how), .ns = 0, .reason = end.reason, .pairs = {}};
  }
  std::sort(out.pairs.begin(), out.pairs.end());
  out.pairs.erase(std::unique(out.pairs.begin(), out.pairs.end()), out.pairs.end());
  return out;
}

}  // namespace

std::string to_string(ContestOutcome outcome) {
  switch (outcome) {
    case ContestOutcome::apart:
      return "apart";
    case ContestOutcome::meets:
      return "meets";
    case ContestOutcome::refused:
      return "refused";
    case ContestOutcome::unanswered:
      return "unanswered";
    case ContestOutcome::crashed:
      return "crashed";
    case ContestOutcome::hung:
      return "hung";
    case ContestOutcome::no_memory:
      return "no memory";
    case ContestOutcome::not_asked:
      return "not asked";
  }
  return "?";
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
    // No answer, where there was one before, is another one.
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

std::vector<Invited> invite(const ContestProgram& program, const ContestLimits& limits) {
  ContestProgram command = program;
  command.emplace_back("list");
  std::string text;
  const ChildEnd end = run_child(
      command, {.start_s = limits.start_s, .line_s = limits.answer_s, .cpu_s = limits.cpu_s},
      [] { return std::string(); },
      [&text](std::string_view line) {
        text += std::string(line) + "\n";
        return text.size() <= kMostCards;
      });
  if (end.how != ChildEnd::How::peace)
    throw Error(program.back(), "says not who it is: " + end.reason, "start it with `list`");
  std::vector<Invited> out;
  for (ContestantCard& card : read_cards(text, program.back()))
    out.push_back({std::move(card), program});
  return out;
}

}  // namespace farcull
