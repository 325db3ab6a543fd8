// The loop of a contestant's program: reads questions, times the library, writes answers. Standard
// output is kept for the answers: what a library prints there goes to standard error.
#include "experiments/peers/contestant.h"

#include <unistd.h>

#include <charconv>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <new>
#include <optional>
#include <string_view>

namespace farcull {
namespace {

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

ContestPair read_pair(const std::vector<std::string_view>& fields) {
  if (fields.size() != 20) throw NoQuestion("a pair has 20 fields");
  ContestPair out;
  for (std::size_t i = 0; i < 18; ++i)
    out.triangles[i / 9][i / 3 % 3][i % 3] = number<double>(fields[i + 2]);
  std::string_view shared = fields[1];
  if (shared == "-") return out;
  for (; shared.size() >= 3; shared.remove_prefix(std::min<std::size_t>(shared.size(), 4)))
    out.shared.emplace_back(shared[0] - '0', shared[2] - '0');
  return out;
}

ContestMesh read_obj(const std::string& path) {
  std::ifstream file(path);
  if (!file) throw NoQuestion(path + " cannot be read");
  ContestMesh out;
  for (std::string line; std::getline(file, line);) {
    const char* at = line.c_str() + 1;
    char* end = nullptr;
    if (line.starts_with("v ")) {
      ContestPoint& point = out.vertices.emplace_back();
      for (double& x : point) {
        x = std::strtod(at, &end);
        at = end;
      }
    } else if (line.starts_with("f ")) {
      auto& triangle = out.triangles.emplace_back();
      for (std::uint32_t& v : triangle) {
        v = static_cast<std::uint32_t>(std::strtoul(at, &end, 10)) - 1;
        at = end;
        if (v >= out.vertices.size()) throw NoQuestion(path + ": a face names no vertex");
      }
    }
  }
  return out;
}

ContestScene read_scene(const std::vector<std::string_view>& fields) {
  if (fields.size() < 3) throw NoQuestion("a scene has at least 3 fields");
  ContestScene out{.objects = {}, .self = fields[1] == "1"};
  for (std::size_t i = 2; i < fields.size(); ++i)
    out.objects.push_back(read_obj(std::string(fields[i])));
  return out;
}

std::string one_line(std::string text) {
  for (char& c : text) {
    if (static_cast<unsigned char>(c) < ' ') c = ' ';
  }
  return text.substr(0, 300);
}

/// Writes all of it at once, so that it is there if the next question ends the program.
void answer(int to, const std::string& text) {
  for (std::size_t done = 0; done < text.size();) {
    const ssize_t wrote = ::write(to, text.data() + done, text.size() - done);
    if (wrote <= 0) std::_Exit(kWrongCall);  // nobody listens
    done += static_cast<std::size_t>(wrote);
  }
}

/// Calls `ask`, which gives the answer and sets the nanoseconds after a tabulator, or a refusal.
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
    return begin + "refused\t" + one_line(error.what()) + "\n";
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
  const ContestPair pair = read_pair(fields);
  const Timer timer;
  const bool meets = contestant.pair(pair);
  const std::string ns = timer.nanoseconds();
  return begin + (meets ? "1\t" : "0\t") + ns + "\n";
}

std::string ask_mesh(const Contestant& contestant, const std::vector<std::string_view>& fields,
                     const std::string& begin) {
  const ContestScene scene = read_scene(fields);
  const Timer timer;
  const std::vector<ContestFound> found = contestant.mesh(scene);
  const std::string ns = timer.nanoseconds();
  std::string out;
  for (const ContestFound& pair : found) {
    out += begin + "pair";
    for (const std::uint32_t n : {pair.object_a, pair.triangle_a, pair.object_b, pair.triangle_b})
      out += "\t" + std::to_string(n);
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

void for_each_object_pair(const ContestScene& scene,
                          const std::function<void(std::uint32_t, std::uint32_t)>& ask) {
  for (std::uint32_t a = 0; a < scene.objects.size(); ++a) {
    for (std::uint32_t b = scene.self ? a : a + 1; b < scene.objects.size(); ++b) ask(a, b);
  }
}

}  // namespace farcull
