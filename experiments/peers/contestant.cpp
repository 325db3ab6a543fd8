// The loop of a contestant's program (docs/ask.md): reads questions, times the library, writes
// answers. Only answers go to standard output. Text that a library prints there is sent to standard
// error.
#include "experiments/peers/contestant.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <iostream>

#include "core/base/error.h"
#include "core/base/stopwatch.h"
#include "core/base/text.h"
#include "core/view/view.h"
#include "experiments/scenes/mesh/load.h"
#include "experiments/scenes/mesh/scene_build.h"

namespace farcull {
namespace {

constexpr int kWrongCall = 2, kNoMemory = 3;

/// The fields of a line, which tabs separate: line number, question, data.
using Fields = std::vector<std::string>;

struct NoQuestion : std::runtime_error {
  using std::runtime_error::runtime_error;
};

template <class Number>
Number number(std::string_view text) {
  if (const std::optional<Number> out = parse_number<Number>(text)) return *out;
  throw NoQuestion(fmt::format("'{}' is no number", text));
}

/// Reads two triangles from the last 18 of `count` fields.
SuitePair read_triangles(const Fields& fields, std::size_t count) {
  if (fields.size() != count) throw NoQuestion(fmt::format("{} has {} fields", fields[1], count));
  SuitePair out;
  for (std::size_t i = 0; i < 18; ++i)
    (i < 9 ? out.a : out.b)[i / 3 % 3][i % 3] = number<double>(fields[count - 18 + i]);
  return out;
}

SuitePair read_pair(const Fields& fields) {
  SuitePair out = read_triangles(fields, 21);
  for (const std::string& corners : split_list(fields[2])) {
    if (corners.size() < 3) continue;  // "-": no shared corner
    out.shared.push_back(
        {static_cast<std::uint8_t>(corners[0] - '0'), static_cast<std::uint8_t>(corners[2] - '0')});
  }
  return out;
}

/// Loads the OBJ files that fields[first] to fields[end - 1] name. Each file is an object.
Scene read_scene(const Fields& fields, std::size_t first, std::size_t end, bool self) {
  if (fields.size() < std::max(first + 1, end)) throw NoQuestion(fields[1] + " lacks fields");
  Scene out;
  out.name = "scene";
  try {
    for (std::size_t i = first; i < end; ++i) {
      const Mesh mesh = load_mesh(fields[i]);
      append_object(std::to_string(i - first), mesh.vertices, mesh.triangles, mesh.source_face,
                    out);
      out.objects.back().self = self;
    }
  } catch (const Error& error) {
    throw NoQuestion(error.what());
  }
  return out;
}

/// Writes the text without a buffer, so that it is not lost if the next question ends the program.
void write_answer(int to, const std::string& text) {
  for (std::size_t done = 0; done < text.size();) {
    const ssize_t wrote = ::write(to, text.data() + done, text.size() - done);
    if (wrote <= 0) std::_Exit(kWrongCall);  // the output was closed
    done += static_cast<std::size_t>(wrote);
  }
}

std::string nanoseconds(const Stopwatch& since) {
  return std::to_string(std::llround(1e6 * since.ms()));
}

/// Returns the answer to a yes-or-no question, with the time that the answer took.
template <class Ask>
std::string verdict(const std::string& begin, const Ask& ask) {
  const Stopwatch watch;
  const bool yes = ask();
  const std::string ns = nanoseconds(watch);
  return begin + (yes ? "1\t" : "0\t") + ns + "\n";
}

std::string answer_pair(const Contestant& of, const Fields& fields, const std::string& begin) {
  const SuitePair pair = read_pair(fields);
  return verdict(begin, [&] { return of.pair(pair); });
}

std::string answer_self(const Contestant& of, const Fields& fields, const std::string& begin) {
  const Scene scene = read_scene(fields, 2, 3, true);
  return verdict(begin, [&] { return of.self(scene); });
}

std::string answer_inside(const Contestant& of, const Fields& fields, const std::string& begin) {
  const Scene scene = read_scene(fields, 2, 3, false);
  if (fields.size() != 6) throw NoQuestion("inside has 6 fields");
  const Vec3 point(number<double>(fields[3]), number<double>(fields[4]), number<double>(fields[5]));
  return verdict(begin, [&] { return of.inside(scene, point); });
}

std::string answer_clash(const Contestant& of, const Fields& fields, const std::string& begin) {
  const Scene scene = read_scene(fields, 2, 4, false);
  return verdict(begin, [&] { return of.clash(scene); });
}

std::string answer_mesh(const Contestant& of, const Fields& fields, const std::string& begin) {
  const Scene scene = read_scene(fields, 3, fields.size(), fields[2] == "1");
  const Stopwatch watch;
  const std::vector<TrianglePair> found = of.mesh(scene);
  const std::string ns = nanoseconds(watch);
  const std::vector<std::uint32_t> owner = owners(scene);
  std::string out;
  const auto place = [&](std::uint32_t t) {
    return fmt::format("\t{}\t{}", owner[t], t - scene.objects[owner[t]].first_triangle);
  };
  for (const auto& [a, b] : found) out += begin + "pair" + place(a) + place(b) + "\n";
  return out + begin + "done\t" + ns + "\n";
}

std::string answer_distance(const Contestant& of, const Fields& fields, const std::string& begin) {
  const ContestDistance found = of.distance(read_triangles(fields, 20));
  std::string out = begin + shortest(found.distance);
  for (std::size_t i = 0; found.points && i < 6; ++i)
    out += "\t" + shortest((*found.points)[i / 3][static_cast<Eigen::Index>(i % 3)]);
  return out + "\n";
}

template <auto member>
bool has(const Contestant& contestant) {
  return static_cast<bool>(contestant.*member);
}

/// A kind of question. known(): true if the contestant can answer questions of this kind.
struct Question {
  const char* word;
  bool (*known)(const Contestant&);
  std::string (*answer)(const Contestant&, const Fields&, const std::string& begin);
};
constexpr std::array kQuestions = {
    Question{"pair", has<&Contestant::pair>, answer_pair},
    Question{"mesh", has<&Contestant::mesh>, answer_mesh},
    Question{"distance", has<&Contestant::distance>, answer_distance},
    Question{"self", has<&Contestant::self>, answer_self},
    Question{"inside", has<&Contestant::inside>, answer_inside},
    Question{"clash", has<&Contestant::clash>, answer_clash}};

/// Returns a line KEY TAB VALUE for each member of the card that has a value.
std::string answer_card(const Contestant& contestant, const std::string& begin) {
  const ContestantCard& card = contestant.card;
  std::string answers, out;
  for (const Question& question : kQuestions) {
    if (question.known(contestant))
      answers += (answers.empty() ? "" : " ") + std::string(question.word);
  }
  const auto word = [](bool yes) { return yes ? "yes" : "no"; };
  const std::pair<const char*, std::string> lines[] = {
      {"name", card.name},
      {"library", card.library},
      {"answers", answers},
      {"means", card.means == Means::closed ? "closed" : "crossing"},
      {"degenerate", word(card.degenerate)},
      {"neighbours", word(card.neighbours)},
      {"promises", word(card.guaranteed)},
      {"margin", shortest(card.margin)},
      {"call", card.call},
      {"says", card.says},
      {"source", card.source},
      {"use", card.use}};
  for (const auto& [key, value] : lines) {
    if (!value.empty()) out += begin + "card\t" + key + "\t" + one_line(value) + "\n";
  }
  return out + begin + "done\n";
}

std::string answer_line(const Contestant& contestant, const std::string& line) {
  const Fields fields = split_list(line, '\t');
  if (fields.size() < 2) throw NoQuestion("'" + line + "' is no question");
  const std::string begin = fields[0] + "\t";
  try {
    if (fields[1] == "card") return answer_card(contestant, begin);
    for (const Question& question : kQuestions) {
      if (fields[1] == question.word && question.known(contestant))
        return question.answer(contestant, fields, begin);
    }
    return begin + "refused\tit does not answer this kind of question\n";
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const NoQuestion&) {
    throw;
  } catch (const std::exception& error) {
    return begin + "refused\t" + one_line(error.what()).substr(0, 300) + "\n";
  }
}

}  // namespace

int contest(int argc, char** argv, const std::vector<Contestant>& contestants) {
  const int to = ::dup(STDOUT_FILENO);
  ::dup2(STDERR_FILENO, STDOUT_FILENO);
  std::ios::sync_with_stdio(false);
  const std::string name = argc == 2 ? argv[1] : "";
  std::string names;
  for (const Contestant& contestant : contestants) {
    names += " " + contestant.card.name;
    if (contestant.card.name != name) continue;
    try {
      for (std::string line; std::getline(std::cin, line);)
        write_answer(to, answer_line(contestant, line));
      return 0;
    } catch (const std::bad_alloc&) {
      std::fputs("std::bad_alloc: out of memory\n", stderr);
      return kNoMemory;
    } catch (const NoQuestion& error) {
      std::fprintf(stderr, "%s: %s\n", argv[0], error.what());
      return kWrongCall;
    }
  }
  std::fprintf(stderr, "usage: %s NAME, one of%s\n", argv[0], names.c_str());
  return kWrongCall;
}

ContestantCard crossing_card(const std::string& name, const std::string& library) {
  return {.name = name, .library = library, .means = Means::crossing, .degenerate = false};
}

void for_each_object_pair(const Scene& scene,
                          const std::function<void(const Object&, const Object&)>& ask) {
  for (std::size_t a = 0; a < scene.objects.size(); ++a) {
    for (std::size_t b = scene.objects[a].self ? a : a + 1; b < scene.objects.size(); ++b)
      ask(scene.objects[a], scene.objects[b]);
  }
}

void leave_out_untested(const Scene& scene, std::vector<TrianglePair>& pairs) {
  const std::vector<std::uint32_t> owner = owners(scene);
  std::erase_if(pairs, [&](const TrianglePair& pair) {
    const std::uint32_t o = owner[pair.a];
    return pair.a == pair.b || (o == owner[pair.b] && !scene.objects[o].self);
  });
}

Scene two_objects(const SuitePair& pair) {
  Scene out;
  out.name = "pair";
  const std::array<std::array<std::uint32_t, 3>, 1> triangle = {{{0, 1, 2}}};
  const std::array<std::uint32_t, 1> face = {0};
  append_object("0", pair.a, triangle, face, out);
  append_object("1", pair.b, triangle, face, out);
  return out;
}

Scene scene_of(const SuitePair& pair) {
  Scene out = two_objects(pair);
  if (pair.shared.empty()) return out;
  out.source_face = {0, 1};
  out.objects = {{.name = "0", .first_triangle = 0, .triangle_count = 2, .self = true}};
  for (const auto& [first, second] : pair.shared) out.triangles[1][second] = first;
  return out;
}

}  // namespace farcull
