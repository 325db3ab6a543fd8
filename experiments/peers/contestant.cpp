// The loop of a contestant's program: reads questions, times the library, writes answers. Standard
// output is kept for the answers: text that a library prints there goes to standard error. Also
// writes and reads cards (descriptions of contestants, ContestantCard), one line for each field.
#include "experiments/peers/contestant.h"

#include <unistd.h>

#include <charconv>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <map>
#include <new>
#include <optional>
#include <string_view>

#include "core/base/error.h"
#include "core/base/text.h"

namespace farcull {
namespace {

std::string one_line(std::string text) {
  for (char& c : text) {
    if (static_cast<unsigned char>(c) < ' ') c = ' ';
  }
  return text;
}

/// The shortest decimal text that is read back as this number.
std::string shortest(double number) {
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, number).ptr};
}

std::optional<bool> yes_or_no(const std::string& text) {
  if (text == "yes") return true;
  if (text == "no") return false;
  return {};
}

/// Sets a field of a card. False: the key is unknown, or the value is not allowed for it.
bool set(ContestantCard& card, const std::string& key, const std::string& value) {
  const std::map<std::string, std::string*> texts = {
      {"name", &card.name}, {"library", &card.library}, {"call", &card.call},
      {"says", &card.says}, {"source", &card.source},   {"use", &card.use}};
  const std::map<std::string, bool*> flags = {{"degenerate", &card.degenerate},
                                              {"neighbours", &card.neighbours},
                                              {"promises", &card.promises},
                                              {"pairs", &card.pairs},
                                              {"meshes", &card.meshes}};
  if (const auto text = texts.find(key); text != texts.end()) {
    *text->second = value;
    return !value.empty();
  }
  if (const auto flag = flags.find(key); flag != flags.end()) {
    const std::optional<bool> read = yes_or_no(value);
    if (read) *flag->second = *read;
    return read.has_value();
  }
  if (key == "means") {
    card.means = value == "crossing" ? Means::crossing : Means::closed;
    return value == "crossing" || value == "closed";
  }
  if (key == "margin") {
    const auto margin = parse_number<double>(value);
    if (margin) card.margin = *margin;
    return margin.has_value() && *margin >= 0 && std::isfinite(*margin);
  }
  if (key == "memory") {
    const auto mib = parse_number<std::uint64_t>(value);
    if (mib) card.memory_mib = *mib;
    return mib.has_value() && *mib > 0;
  }
  return false;
}

constexpr int kWrongCall = 2, kNoMemory = 3;

/// The fields of a line between tabulators.
std::vector<std::string_view> fields_of(std::string_view line) {
  std::vector<std::string_view> out;
  for (std::size_t from = 0;;) {
    const std::size_t at = line.find('\t', from);
    out.push_back(line.substr(from, at - from));
    if (at == std::string_view::npos) return out;
    from = at + 1;
  }
}

struct NoQuestion : std::runtime_error {
  using std::runtime_error::runtime_error;
};

template <class Number>
Number number(std::string_view text) {
  Number out{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), out);
  if (error != std::errc() || end != text.data() + text.size())
    throw NoQuestion("'" + std::string(text) + "' is no number");
  return out;
}

SuitePair read_pair(const std::vector<std::string_view>& fields) {
  if (fields.size() != 20) throw NoQuestion("a pair has 20 fields");
  SuitePair out;
  for (std::size_t i = 0; i < 18; ++i)
    (i < 9 ? out.a : out.b)[i / 3 % 3][i % 3] = number<double>(fields[i + 2]);
  std::string_view shared = fields[1];
  if (shared == "-") return out;
  for (; shared.size() >= 3; shared.remove_prefix(std::min<std::size_t>(shared.size(), 4))) {
    out.shared.push_back(
        {static_cast<std::uint8_t>(shared[0] - '0'), static_cast<std::uint8_t>(shared[2] - '0')});
  }
  return out;
}

void add_obj(const std::string& path, bool self, Scene& out) {
  std::ifstream file(path);
  if (!file) throw NoQuestion(path + " cannot be read");
  const auto first = static_cast<std::uint32_t>(out.vertices.size());
  out.objects.push_back({.name = std::to_string(out.objects.size()),
                         .first_triangle = static_cast<std::uint32_t>(out.triangles.size()),
                         .self = self});
  std::uint32_t& count = out.objects.back().triangle_count;
  for (std::string line; std::getline(file, line);) {
    const char* at = line.c_str() + 1;
    char* end = nullptr;
    if (line.starts_with("v ")) {
      Vec3& point = out.vertices.emplace_back();
      for (double& x : point) {
        x = std::strtod(at, &end);
        at = end;
      }
    } else if (line.starts_with("f ")) {
      auto& triangle = out.triangles.emplace_back();
      for (std::uint32_t& v : triangle) {
        v = first + static_cast<std::uint32_t>(std::strtoul(at, &end, 10)) - 1;
        at = end;
        if (v < first || v >= out.vertices.size())
          throw NoQuestion(path + ": a face names no vertex");
      }
      out.source_face.push_back(count++);
    }
  }
}

Scene read_scene(const std::vector<std::string_view>& fields) {
  if (fields.size() < 3) throw NoQuestion("a scene has at least 3 fields");
  Scene out;
  out.name = "scene";
  for (std::size_t i = 2; i < fields.size(); ++i)
    add_obj(std::string(fields[i]), fields[1] == "1", out);
  return out;
}

/// Writes the whole text at once, so that the answer is there even if the next question ends the
/// program.
void answer(int to, const std::string& text) {
  for (std::size_t done = 0; done < text.size();) {
    const ssize_t wrote = ::write(to, text.data() + done, text.size() - done);
    if (wrote <= 0) std::_Exit(kWrongCall);  // nobody reads the output
    done += static_cast<std::size_t>(wrote);
  }
}

/// The answer that `ask` gives, or a refusal if it throws.
template <class Ask>
std::string asked(std::string_view number, const Ask& ask) {
  const std::string begin = std::string(number) + "\t";
  try {
    return ask(begin);
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const NoQuestion&) {
    throw;
  } catch (const std::exception& error) {
    return begin + "refused\t" + one_line(error.what()).substr(0, 300) + "\n";
  }
}

class Timer {
 public:
  std::string nanoseconds() const {
    return std::to_string(std::chrono::duration_cast<std::chrono::nanoseconds>(
                              std::chrono::steady_clock::now() - since_)
                              .count());
  }

 private:
  std::chrono::steady_clock::time_point since_ = std::chrono::steady_clock::now();
};

std::string ask_pair(const Contestant& contestant, const std::vector<std::string_view>& fields,
                     const std::string& begin) {
  const SuitePair pair = read_pair(fields);
  const Timer timer;
  const bool meets = contestant.pair(pair);
  const std::string ns = timer.nanoseconds();
  return begin + (meets ? "1\t" : "0\t") + ns + "\n";
}

std::string ask_mesh(const Contestant& contestant, const std::vector<std::string_view>& fields,
                     const std::string& begin) {
  const Scene scene = read_scene(fields);
  const Timer timer;
  const std::vector<TrianglePair> found = contestant.mesh(scene);
  const std::string ns = timer.nanoseconds();
  const std::vector<std::uint32_t> owner = owners(scene);
  std::string out;
  for (const auto& [a, b] : found) {
    out += begin + "pair";
    for (const std::uint32_t t : {a, b}) {
      out += "\t" + std::to_string(owner[t]) + "\t" +
             std::to_string(t - scene.objects[owner[t]].first_triangle);
    }
    out += "\n";
  }
  return out + begin + "done\t" + ns + "\n";
}

int answer_all(const Contestant& contestant, bool pairs, int to) {
  for (std::string line; std::getline(std::cin, line);) {
    const std::vector<std::string_view> fields = fields_of(line);
    answer(to, asked(fields[0], [&](const std::string& begin) {
             return (pairs ? ask_pair : ask_mesh)(contestant, fields, begin);
           }));
  }
  return 0;
}

}  // namespace

int contest(int argc, char** argv, std::vector<Contestant> contestants) {
  const int to = ::dup(STDOUT_FILENO);
  ::dup2(STDERR_FILENO, STDOUT_FILENO);
  std::ios::sync_with_stdio(false);
  const std::string name = argc > 1 ? argv[1] : "", what = argc > 2 ? argv[2] : "";
  if (argc == 2 && name == "list") {
    std::string text;
    for (Contestant& contestant : contestants) {
      contestant.card.pairs = contestant.pair != nullptr;
      contestant.card.meshes = contestant.mesh != nullptr;
      text += card_text(contestant.card);
    }
    answer(to, text);
    return 0;
  }
  for (const Contestant& contestant : contestants) {
    if (argc != 3 || contestant.card.name != name) continue;
    const bool pairs = what == "pairs" && contestant.pair;
    if (!pairs && !(what == "meshes" && contestant.mesh)) continue;
    try {
      return answer_all(contestant, pairs, to);
    } catch (const std::bad_alloc&) {
      std::fputs("std::bad_alloc: out of memory\n", stderr);
      return kNoMemory;
    } catch (const NoQuestion& error) {
      std::fprintf(stderr, "%s: %s\n", argv[0], error.what());
      return kWrongCall;
    }
  }
  std::fprintf(stderr, "usage: %s list | NAME pairs | NAME meshes\n", argv[0]);
  return kWrongCall;
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
  out.vertices.assign(pair.a.begin(), pair.a.end());
  out.vertices.insert(out.vertices.end(), pair.b.begin(), pair.b.end());
  out.triangles = {{0, 1, 2}, {3, 4, 5}};
  out.source_face = {0, 0};
  out.objects = {{.name = "0", .first_triangle = 0, .triangle_count = 1},
                 {.name = "1", .first_triangle = 1, .triangle_count = 1}};
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

std::string card_text(const ContestantCard& card) {
  std::string out;
  const auto add = [&out](const char* key, const std::string& value) {
    out += std::string(key) + " " + one_line(value) + "\n";
  };
  const auto flag = [&add](const char* key, bool value) { add(key, value ? "yes" : "no"); };
  add("name", card.name);
  add("library", card.library);
  add("means", card.means == Means::closed ? "closed" : "crossing");
  flag("degenerate", card.degenerate);
  flag("neighbours", card.neighbours);
  flag("promises", card.promises);
  flag("pairs", card.pairs);
  flag("meshes", card.meshes);
  if (card.margin > 0) add("margin", shortest(card.margin));
  add("memory", std::to_string(card.memory_mib));
  add("call", card.call);
  add("says", card.says);
  if (!card.source.empty()) add("source", card.source);
  add("use", card.use);
  return out + "\n";
}

std::vector<ContestantCard> read_cards(std::string_view text, const std::string& where) {
  std::vector<ContestantCard> out;
  bool open = false;
  long line = 0;
  while (!text.empty()) {
    ++line;
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string row(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
    if (row.empty()) {
      open = false;
      continue;
    }
    if (!open) out.emplace_back();
    open = true;
    const std::size_t blank = std::min(row.find(' '), row.size() - 1);
    if (!set(out.back(), row.substr(0, blank), row.substr(blank + 1)))
      throw Error(where, "the card says '" + row + "'", "see experiments/peers/contestant.h", line);
  }
  for (const ContestantCard& card : out) {
    if (card.name.empty() || card.library.empty() || (!card.pairs && !card.meshes))
      throw Error(where, "a card lacks its name, its library, or what it can be asked",
                  "see experiments/peers/contestant.h");
  }
  return out;
}

}  // namespace farcull
