// suite.txt: the list of the files of a suite with their sums.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <limits>

#include "core/base/error.h"
#include "core/base/text.h"
#include "experiments/scenes/mesh/text.h"
#include "experiments/suite/reader.h"
#include "experiments/suite/words.h"
#include "verify/certificate/sha256.h"

namespace farcull {
namespace {

constexpr const char* kAgain = "write the suite again, as in farcull suite DIR";
constexpr std::uint64_t kAnyBytes = std::numeric_limits<std::uint64_t>::max();

std::string sum_of(std::string_view text) {
  Sha256 sum;
  sum.add(text);
  return sum.digest();
}

std::uint64_t whole(const Lines& lines, std::string_view word) {
  const std::optional<std::uint64_t> value = parse_number<std::uint64_t>(word);
  if (!value) lines.fail(quote_token(word) + " is no whole number", kAgain);
  return *value;
}

/// The word after `key`; the next line has to be these two.
std::string one_word(Lines& lines, std::string_view key) {
  std::string_view line;
  if (!lines.next(line) || take_word(line) != key)
    lines.fail(fmt::format("the line does not begin with '{}'", key), kAgain);
  const std::string out(take_word(line));
  if (out.empty() || !take_word(line).empty())
    lines.fail(fmt::format("there is not one word after '{}'", key), kAgain);
  return out;
}

bool is_sum(std::string_view word) {
  return word.size() == 64 && word.find_first_not_of("0123456789abcdef") == std::string_view::npos;
}

/// A path below the folder, with nothing that leads out of it.
bool is_inner_path(std::string_view path) {
  return !path.empty() && path[0] != '/' && path.find("..") == std::string_view::npos;
}

SuiteIndex::File parse_file(const Lines& lines, std::string_view line) {
  SuiteIndex::File out;
  out.path = take_word(line);
  out.bytes = whole(lines, take_word(line));
  out.sha256 = take_word(line);
  out.items = whole(lines, take_word(line));
  if (!is_inner_path(out.path) || !is_sum(out.sha256) || !take_word(line).empty())
    lines.fail("the line is not 'file PATH BYTES SHA256 ITEMS'", kAgain);
  return out;
}

}  // namespace

SuiteIndex parse_suite(std::string_view text, const std::string& name) {
  Lines lines(text, name);
  SuiteIndex out;
  std::string_view line;
  lines.next(line);
  if (line != "farcull-suite 1")
    lines.fail("the first line is not 'farcull-suite 1'", "give the folder of a suite, version 1");
  out.seed = whole(lines, one_word(lines, "seed"));
  out.size = one_word(lines, "size");
  out.licence = one_word(lines, "licence");
  while (lines.next(line)) {
    const std::size_t before = static_cast<std::size_t>(line.data() - text.data());
    const std::string_view key = take_word(line);
    if (key == "file") {
      SuiteIndex::File file = parse_file(lines, line);
      if (!out.files.empty() && !(out.files.back().path < file.path))
        lines.fail("the paths do not ascend", kAgain);
      out.files.push_back(std::move(file));
      continue;
    }
    if (key != "sum") lines.fail(quote_token(key) + " is no word of a suite", kAgain);
    out.sum = take_word(line);
    if (out.sum != sum_of(text.substr(0, before)))
      lines.fail("the sum is not that of the lines before it", kAgain);
    if (lines.next(line)) lines.fail("there are lines after the sum", kAgain);
    return out;
  }
  lines.fail("the last line is not 'sum SHA256', so the end of the file is missing", kAgain);
}

SuiteIndex read_suite(const std::string& folder) {
  const std::string path = folder + "/suite.txt";
  return parse_suite(read_file(path, kAnyBytes), path);
}

std::vector<std::string> SuiteIndex::pair_files() const {
  std::vector<std::string> out;
  for (const File& file : files) {
    if (file.path.starts_with("pairs/")) out.push_back(file.path);
  }
  return out;
}

std::vector<std::string> SuiteIndex::mesh_folders() const {
  constexpr std::string_view kFile = "/mesh.txt";
  std::vector<std::string> out;
  for (const File& file : files) {
    if (file.path.starts_with("meshes/") && file.path.ends_with(kFile))
      out.push_back(file.path.substr(0, file.path.size() - kFile.size()));
  }
  return out;
}

void check_files(const std::string& folder, const SuiteIndex& index) {
  for (const SuiteIndex::File& file : index.files) {
    const std::string path = folder + "/" + file.path;
    const std::string text = read_file(path, kAnyBytes);
    if (text.size() != file.bytes) {
      throw Error(path, fmt::format("has {} bytes; suite.txt says {}", text.size(), file.bytes),
                  kAgain);
    }
    if (sum_of(text) != file.sha256)
      throw Error(path, "its SHA-256 is not the one of suite.txt, so it was changed", kAgain);
  }
  std::vector<std::string> there;
  for (const char* part : {"pairs", "meshes"}) {
    std::error_code error;
    for (const auto& entry :
         std::filesystem::recursive_directory_iterator(folder + "/" + part, error)) {
      if (!entry.is_directory())
        there.push_back(std::filesystem::relative(entry.path(), folder).generic_string());
    }
  }
  std::sort(there.begin(), there.end());
  for (const std::string& path : there) {
    const auto named = [&](const SuiteIndex::File& file) { return file.path == path; };
    if (!std::any_of(index.files.begin(), index.files.end(), named))
      throw Error(folder + "/" + path, "is no file of the suite", "move it elsewhere");
  }
}

}  // namespace farcull
