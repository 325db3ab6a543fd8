// What nearly every test uses: googletest and the standard library; which random cases are tried,
// and how many; what a call throws; and folders of a test's own.
#pragma once

#include <gtest/gtest.h>

#include "tests/lab/standard.h"

namespace farcull {

/// The seed of a loop of random cases: `own`, so that a run repeats the last one. Where the
/// variable FARCULL_SEED is set and not 0, another one, which is different for each value and each
/// `own`. Then every test program prints the variable at its start and beside a failure.
/// Rapidcheck's own properties follow it too, unless RC_PARAMS is set. tests/seeds.sh tries many
/// values.
std::uint64_t test_seed(std::uint64_t own);

/// How many random cases a loop tries: all n if FARCULL_TRIALS is "all" (a campaign of
/// tests/run.sh), else a quarter of them, and an eighth with the address sanitizer, which makes
/// every case several times slower and looks for faults of memory, which a few cases of each kind
/// show. At least `least`. Rapidcheck's own properties follow the variable too.
int trials(int n, int least = 1);

/// Whether a loop makes case n: the first `least` cases, and then more until it has `seen` what it
/// asks for. So no test asks for luck:
///     for (int n = 0; more_cases(n, trials(4000), lost > 0 && kept > 9); ++n)
/// At case `most` it ends and the test fails. 0 stands for 20 * least. A loop asks for no more than
/// `most` / 20 cases are expected to show. The number shown by `most` cases is a Poisson variable
/// of mean 20 w or more if w is asked for, and is less than w with a chance below
/// e^(-20 w) (20 e)^w < e^(-16 w), which is 1.2e-7 at w = 1.
inline bool more_cases(std::integral auto n, std::integral auto least, bool seen, int most = 0,
                       std::source_location loop = std::source_location::current()) {
  if (std::cmp_less(n, least)) return true;
  if (seen) return false;
  if (most == 0 ? std::cmp_less(n / 20, least) : std::cmp_less(n, most)) return true;
  ADD_FAILURE_AT(loop.file_name(), static_cast<int>(loop.line()))
      << n << " cases, the bound of this loop, do not show what it asks for";
  return false;
}

/// A file of the build tree for a minimized input that failed, to be moved to tests/cases. Makes
/// the folder.
std::filesystem::path failure_file(const std::string& name);

/// The Error that the call throws. Without one the test fails, and where is "nothing was thrown".
template <class Call>
Error error_of(const Call& call) {
  try {
    call();
  } catch (const Error& error) {
    EXPECT_FALSE(error.remedy.empty()) << error.what();
    EXPECT_FALSE(error.reason.empty());
    return error;
  }
  ADD_FAILURE() << "nothing was thrown";
  return Error("nothing was thrown", "", "");
}

/// The same as text, for calls that may do well: "" then.
template <class Call>
std::string message_of(const Call& call) {
  try {
    call();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

/// The parts of a text between commas.
inline std::vector<std::string> listed(const std::string& text) {
  std::vector<std::string> out;
  std::istringstream in(text);
  for (std::string part; std::getline(in, part, ',');) out.push_back(part);
  return out;
}

/// Whether the text has this part; shows the text where a test fails.
inline testing::AssertionResult has_text(const std::string& text, const std::string& part) {
  const bool has = text.find(part) != std::string::npos;
  return (has ? testing::AssertionSuccess() : testing::AssertionFailure()) << text;
}

/// Whether the call throws an Error whose text has this part.
template <class Call>
testing::AssertionResult refuses(const std::string& part, const Call& call) {
  return has_text(message_of(call), part);
}

/// The bytes of a file; none if it cannot be read.
inline std::string read_text(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

inline void write_text(const std::string& file, const std::string& bytes) {
  std::ofstream(file, std::ios::binary) << bytes;
}

/// A folder of the running test's own, removed with the object.
class ScratchFolder {
 public:
  ScratchFolder() {
    std::string pattern = (std::filesystem::temp_directory_path() / "farcull_test_XXXXXX").string();
    if (mkdtemp(pattern.data()) == nullptr) throw std::runtime_error("no scratch folder");
    path_ = pattern;
  }
  ~ScratchFolder() {
    std::error_code error;
    std::filesystem::remove_all(path_, error);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;

  std::string folder() const { return path_.string(); }
  std::string path(const std::string& name) const { return (path_ / name).string(); }
  std::string read(const std::string& name) const { return read_text(path(name)); }
  /// Writes a file, in a folder that is made where there is none, and returns its path.
  std::string write(const std::string& name, const std::string& bytes) const {
    std::filesystem::create_directories((path_ / name).parent_path());
    write_text(path(name), bytes);
    return path(name);
  }
  /// Replaces the first `old` of a file, which has to be there.
  void replace(const std::string& name, const std::string& old, const std::string& by) const {
    std::string text = read(name);
    const std::size_t place = text.find(old);
    ASSERT_NE(place, std::string::npos) << name << " has no '" << old << "'";
    write(name, text.replace(place, old.size(), by));
  }

 private:
  std::filesystem::path path_;
};

/// A folder of verdicts about devices for one test, in place of the one that all tests share.
class CacheFolder : public ScratchFolder {
 public:
  CacheFolder() { ::setenv("XDG_CACHE_HOME", folder().c_str(), 1); }
  ~CacheFolder() { ::setenv("XDG_CACHE_HOME", old_.c_str(), 1); }

 private:
  std::string old_ = std::getenv("XDG_CACHE_HOME");
};

}  // namespace farcull
