// Finds the pairs of objects that are not tested against each other, by patterns of names.
#include "experiments/scenes/scene_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>

#include "core/base/text.h"

namespace farcull {

namespace {

constexpr const char* kRemedy =
    "give two names of objects with a colon between, as in a:b or link*:gripper; a name is that of "
    "the mesh file without its ending, or that in the scene file; write \\ before a comma, colon "
    "or * "
    "of a name";

constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

/// True if text[at] is a backslash before a comma, a colon or a *. The character after the
/// backslash is then part of a name.
bool escapes(std::string_view text, std::size_t at) {
  return text[at] == '\\' && at + 1 < text.size() &&
         std::string_view(",:*").find(text[at + 1]) != std::string_view::npos;
}

/// Returns the position of the first `character` at or after `from` that is not escaped; npos if
/// there is no such character.
std::size_t find_plain(std::string_view text, char character, std::size_t from = 0) {
  for (std::size_t k = from; k < text.size(); ++k) {
    if (escapes(text, k))
      ++k;
    else if (text[k] == character)
      return k;
  }
  return std::string_view::npos;
}

/// True if the name matches the pattern. A * in the pattern stands for any characters. After a
/// mismatch, matching continues with one more character for the last *.
bool fits(std::string_view name, std::string_view pattern) {
  std::size_t n = 0, p = 0, star = std::string_view::npos, from = 0;
  while (n < name.size()) {
    const std::size_t escape = p < pattern.size() && escapes(pattern, p);
    if (p < pattern.size() && pattern[p] == '*') {
      star = p++;
      from = n;
    } else if (p < pattern.size() && pattern[p + escape] == name[n]) {
      ++n, p += 1 + escape;
    } else if (star != std::string_view::npos) {
      p = star + 1;
      n = ++from;
    } else {
      return false;
    }
  }
  return pattern.find_first_not_of('*', p) == std::string_view::npos;
}

std::vector<std::uint32_t> objects_of(const Scene& scene, std::string_view pattern) {
  std::vector<std::uint32_t> out;
  for (std::uint32_t o = 0; o < scene.objects.size(); ++o) {
    if (fits(scene.objects[o].name, pattern)) out.push_back(o);
  }
  return out;
}

/// True if the pattern is the exact name of some of the `objects`, but not of all. Precondition:
/// the pattern matches all `objects`.
bool doubtful(const Scene& scene, std::string_view pattern,
              const std::vector<std::uint32_t>& objects) {
  const auto named = std::ranges::count_if(
      objects, [&](std::uint32_t o) { return scene.objects[o].name == pattern; });
  return named > 0 && static_cast<std::size_t>(named) < objects.size();
}

constexpr const char* kDoubtful = "is the name of an object, and as a pattern fits others too";

/// Returns text for an error message: a suggestion for the name, and some names of objects.
std::string some_names(const Scene& scene, std::string_view unknown = {}) {
  constexpr std::size_t kShown = 5;
  std::vector<std::string> known;
  for (const Object& object : scene.objects) known.push_back(object.name);
  std::string meant = likely_word(std::string(unknown), known);
  for (const std::string& name : known) {
    if (!unknown.empty() && name.ends_with("/" + std::string(unknown))) meant = name;
  }
  std::string out = did_you_mean(meant) + "the scene has ";
  for (std::size_t o = 0; o < std::min(kShown, scene.objects.size()); ++o)
    out += (o > 0 ? ", " : "") + scene.objects[o].name;
  return out + (scene.objects.size() > kShown ? ", ..." : "");
}

std::vector<ObjectPair> pairs_of(const std::vector<std::uint32_t>& first,
                                 const std::vector<std::uint32_t>& second) {
  std::vector<ObjectPair> out;
  for (const std::uint32_t a : first) {
    for (const std::uint32_t b : second) {
      if (a != b) out.push_back({a, b});
    }
  }
  return in_order(std::move(out));
}

/// Appends the pairs of objects that names.text selects. A name may contain colons, so each
/// colon of the text is tried as the separator of the two names.
void append(const Scene& scene, const IgnoredNames& names, UnknownName lacking,
            std::vector<ObjectPair>& out) {
  const std::string_view text = names.text;
  std::string unknown;
  const auto fail = [&](const std::string& reason) {
    throw Error(names.where, fmt::format("'{}' {}", names.text, reason),
                fmt::format("{}; {}", kRemedy, some_names(scene, unknown)), names.line);
  };
  std::vector<std::uint32_t> first, second;
  int places = 0;
  for (std::size_t colon = find_plain(text, ':'); colon != std::string_view::npos;
       colon = find_plain(text, ':', colon + 1)) {
    const std::string_view left = text.substr(0, colon), right = text.substr(colon + 1);
    const std::vector<std::uint32_t> a = objects_of(scene, left), b = objects_of(scene, right);
    if (a.empty() || b.empty()) {
      if (unknown.empty()) unknown = a.empty() ? left : right;
      continue;
    }
    ++places;
    first = a;
    second = b;
    for (const auto& [name, objects] : {std::pair(left, a), std::pair(right, b)}) {
      if (doubtful(scene, name, objects))
        fail(fmt::format("names '{}', which {}", name, kDoubtful));
    }
  }
  if (find_plain(text, ':') == std::string_view::npos) fail("has no colon between two names");
  if (lacking == UnknownName::passed_over &&
      (places == 0 || (first.size() == 1 && first == second)))
    return;
  if (places == 0) fail(fmt::format("names '{}', and no object is called so", unknown));
  if (places > 1) fail("can be divided at more than one colon");
  if (first.size() == 1 && first == second) fail("names one object, and a pair has two");
  const std::vector<ObjectPair> pairs = pairs_of(first, second);
  out.insert(out.end(), pairs.begin(), pairs.end());
}

}  // namespace

std::vector<ObjectPair> pairs_between(const Scene& scene, const std::string& first,
                                      const std::string& second, const std::string& where,
                                      const std::string& what, long line, UnknownName lacking) {
  const auto objects = [&](const std::string& pattern) {
    std::vector<std::uint32_t> out = objects_of(scene, pattern);
    if (doubtful(scene, pattern, out)) {
      throw Error(where, fmt::format("{} names '{}', which {}", what, pattern, kDoubtful),
                  "call the object something without a *", line);
    }
    if (!out.empty() || lacking == UnknownName::passed_over) return out;
    throw Error(where, fmt::format("{} names '{}', and no object is called so", what, pattern),
                "give names of objects, in which * stands for any characters; " +
                    some_names(scene, pattern),
                line);
  };
  const std::vector<std::uint32_t> a = objects(first), b = objects(second);
  if (a.size() == 1 && a == b && lacking == UnknownName::refused) {
    throw Error(where, fmt::format("{} names '{}' alone", what, scene.objects[a[0]].name),
                "give two different objects; whether an object is tested against itself is said "
                "by self",
                line);
  }
  return pairs_of(a, b);
}

std::vector<IgnoredNames> parse_ignored(const std::string& list, const std::string& option) {
  std::vector<IgnoredNames> out;
  for (std::size_t begin = 0; begin <= list.size();) {
    const std::size_t end = std::min(find_plain(list, ',', begin), list.size());
    out.push_back({list.substr(begin, end - begin), option});
    if (out.back().text.empty()) throw Error(option, "a pair of names is empty", kRemedy);
    begin = end + 1;
  }
  return out;
}

std::vector<IgnoredNames> read_ignored(const std::string& path) {
  std::ifstream file(path);
  if (!file) throw Error(path, "cannot be read", "name a text file with a pair of names a line");
  std::vector<IgnoredNames> out;
  long line = 0;
  for (std::string text; std::getline(file, text);) {
    ++line;
    if (line == 1 && text.starts_with(kByteOrderMark)) text.erase(0, kByteOrderMark.size());
    if (text.ends_with('\r')) text.pop_back();
    if (!text.empty() && !text.starts_with('#')) out.push_back({text, path, line});
  }
  if (!file.eof()) throw Error(path, "cannot be read to its end", "name a text file", line);
  if (out.empty()) throw Error(path, "names no pair of objects", kRemedy);
  return out;
}

std::vector<IgnoredNames> ignored_names(const std::optional<std::string>& list,
                                        const std::optional<std::string>& file) {
  std::vector<IgnoredNames> out;
  if (list) out = parse_ignored(*list);
  if (!file) return out;
  for (IgnoredNames& names : read_ignored(*file)) out.push_back(std::move(names));
  return out;
}

std::vector<ObjectPair> ignored_objects(const Scene& scene, const std::vector<IgnoredNames>& names,
                                        UnknownName lacking) {
  std::vector<ObjectPair> out;
  for (const IgnoredNames& one : names) append(scene, one, lacking, out);
  return in_order(std::move(out));
}

}  // namespace farcull
