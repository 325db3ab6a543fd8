// Verdicts about devices: made once, kept with all that they depend on, and never believed where
// the file is damaged, foreign or about something else. No device is opened here.
#include "experiments/method/device_verdict.h"

#include "tests/lab/process.h"

namespace farcull {
namespace {

GlInfo device() {
  GlInfo out;
  out.kind = "software";
  out.vendor = "vendor";
  out.renderer = "renderer \xff with an odd byte";
  out.version = "4.5";
  out.glsl = "4.50";
  out.subpixel_bits = 8;
  return out;
}

ProbeResult probe(const std::string& assumption, bool pass) {
  return {.assumption = assumption,
          .name = "a probe",
          .measured = pass ? 0.0 : 2.0,
          .bound = 1,
          .unit = "px",
          .samples = 10,
          .pass = pass,
          .note = "tried"};
}

const ProbeResult kBrokenOff = {
    .assumption = "A4", .name = "x", .unit = "", .note = "no memory", .broke_off = true};

// Asks for a verdict, in a folder of its own; counts how often the probes run, and keeps what was
// said.
struct Asked {
  const CacheFolder folder;
  std::vector<ProbeResult> results = {probe("A2", true), probe("A4", true)};
  int runs = 0;
  std::vector<std::string> said;

  DeviceVerdict operator()(const GlInfo& info) {
    return device_verdict(
        info,
        [this] {
          ++runs;
          return results;
        },
        [this](const std::string& line) { said.push_back(line); });
  }
};

TEST(DeviceVerdict, IsMadeOnceAndKept) {
  Asked ask;
  const DeviceVerdict first = ask(device());
  EXPECT_TRUE(first.holds);
  EXPECT_FALSE(first.remembered);
  EXPECT_EQ(first.probes, 2u);
  EXPECT_TRUE(first.file.starts_with(ask.folder.path("farcull/device-")));
  ASSERT_EQ(ask.said.size(), 1u);
  EXPECT_TRUE(has_text(ask.said[0], "once for this device"));
  const DeviceVerdict again = ask(device());
  EXPECT_TRUE(again.holds);
  EXPECT_TRUE(again.remembered);
  EXPECT_EQ(again.probes, 2u);
  EXPECT_EQ(again.made, first.made);
  const std::string found = "2 probes of A1 to A10 pass on this device (probed " + first.made;
  EXPECT_EQ(to_string(first), found + ")");
  EXPECT_EQ(to_string(again), found + ", remembered)");
  EXPECT_EQ(ask.runs, 1);
  EXPECT_EQ(ask.said.size(), 1u);
  const std::filesystem::directory_iterator files(ask.folder.path("farcull"));
  EXPECT_EQ(std::distance(begin(files), end(files)), 1) << "nothing is left beside the verdict";
}

TEST(DeviceVerdict, AFailureIsKeptAndNamed) {
  Asked ask;
  ask.results[0].pass = false;
  ask.results[0].measured = 2;
  for (const bool remembered : {false, true}) {
    const DeviceVerdict verdict = ask(device());
    EXPECT_FALSE(verdict.holds);
    EXPECT_EQ(verdict.remembered, remembered);
    ASSERT_EQ(verdict.failed.size(), 1u);
    EXPECT_EQ(verdict.failed[0], "A2 a probe: 2 px, bound 1");
    EXPECT_EQ(to_string(verdict), "a probe fails on this device: A2 a probe: 2 px, bound 1");
  }
  EXPECT_EQ(ask.runs, 1);
}

TEST(DeviceVerdict, ABrokenOffProbePromisesNothingAndIsNotKept) {
  Asked ask;
  ask.results[1] = kBrokenOff;
  const DeviceVerdict verdict = ask(device());
  EXPECT_FALSE(verdict.holds);
  EXPECT_EQ(verdict.problem, "A4 x: no memory");
  EXPECT_TRUE(verdict.file.empty());
  ask.results[1] = probe("A4", true);
  EXPECT_TRUE(ask(device()).holds);
  EXPECT_EQ(ask.runs, 2);
}

TEST(DeviceVerdict, NoProbesAreNoVerdict) {
  Asked ask;
  ask.results.clear();
  EXPECT_FALSE(ask(device()).holds);
  EXPECT_FALSE(ask(device()).holds);
  EXPECT_EQ(ask.runs, 2);
}

TEST(DeviceVerdict, DependsOnDeviceDriverAndEnvironment) {
  Asked ask;
  ask(device());
  int runs = 1;
  const auto remade = [&](const GlInfo& info) {
    ask(info);
    return ask.runs == ++runs;
  };
  for (std::string GlInfo::*field :
       {&GlInfo::kind, &GlInfo::vendor, &GlInfo::renderer, &GlInfo::version, &GlInfo::glsl}) {
    GlInfo other = device();
    other.*field += " of another";
    EXPECT_TRUE(remade(other));
  }
  GlInfo other = device();
  other.subpixel_bits = 4;
  EXPECT_TRUE(remade(other));
  for (const char* name :
       {"LP_NATIVE_VECTOR_WIDTH", "lower_depth_range_rate"}) {  // Mesa's, driconf's
    const SetVariable set(name, "0.5");
    EXPECT_TRUE(remade(device()));
  }
  // Other variables change nothing, and the first verdict is still there.
  const SetVariable set("no_proxy", "localhost");
  EXPECT_TRUE(ask(device()).remembered);
  EXPECT_EQ(ask.runs, runs);
}

TEST(DeviceVerdict, InputsNameTheSourcesAndTheProcessor) {
  std::string names;
  for (const auto& [name, value] : verdict_inputs(device())) {
    names += name + ",";
    if (name == "sources") {
      EXPECT_EQ(value.size(), 16u);
    }
    if (name == "processor") {
      EXPECT_FALSE(value.empty());
    }
  }
  EXPECT_EQ(names,
            "kind,vendor,renderer,version,glsl,subpixel bits,limits,sources,threads,processor,"
            "environment,");
}

// Every byte of the file flipped, one at a time, and every length: never believed, made anew.
TEST(DeviceVerdict, ADamagedFileIsMadeAnew) {
  Asked ask;
  ask.results[0].pass = false;
  const std::string file = ask(device()).file, good = read_text(file);
  ASSERT_GT(good.size(), 200u);
  for (std::size_t i = 0; i < good.size(); ++i) {
    std::string bad = good;
    bad[i] = static_cast<char>(bad[i] ^ (i % 2 ? 1 : 32));
    write_text(file, bad);
    const int runs = ask.runs;
    const DeviceVerdict verdict = ask(device());
    EXPECT_FALSE(verdict.holds) << i;
    EXPECT_EQ(ask.runs, runs + 1) << i;
  }
  for (std::size_t length = 0; length < good.size(); length += 7) {
    write_text(file, good.substr(0, length));
    const int runs = ask.runs;
    ask(device());
    EXPECT_EQ(ask.runs, runs + 1) << length;
  }
  EXPECT_EQ(ask(device()).remembered, true);
}

TEST(DeviceVerdict, AFileOfAnotherDeviceInItsPlaceIsMadeAnew) {
  Asked ask;
  const std::string file = ask(device()).file;
  GlInfo other = device();
  other.version = "9.9";
  const std::string others = ask(other).file;
  ASSERT_NE(file, others);
  write_text(file, read_text(others));
  const DeviceVerdict verdict = ask(device());
  EXPECT_FALSE(verdict.remembered);
  EXPECT_EQ(ask.runs, 3);
  EXPECT_TRUE(ask(device()).remembered);
}

TEST(DeviceVerdict, ALinkIsNotFollowed) {
  Asked ask;
  const std::string file = ask(device()).file;
  std::filesystem::rename(file, file + ".elsewhere");
  std::filesystem::create_symlink(file + ".elsewhere", file);
  EXPECT_FALSE(ask(device()).remembered);
  EXPECT_FALSE(std::filesystem::is_symlink(file));
  EXPECT_TRUE(ask(device()).remembered);
}

TEST(DeviceVerdict, WithoutAFolderEveryRunProbesAndSaysSo) {
  Asked ask;
  ask.folder.write("farcull", "a file where the folder should be");
  for (int run = 1; run <= 2; ++run) {
    const DeviceVerdict verdict = ask(device());
    EXPECT_TRUE(verdict.holds);
    EXPECT_TRUE(verdict.file.empty());
    EXPECT_FALSE(verdict.note.empty());
    EXPECT_EQ(ask.runs, run);
  }
  ASSERT_EQ(ask.said.size(), 4u);
  EXPECT_TRUE(has_text(ask.said[1], "cannot be kept, so every run probes the device"));
}

TEST(DeviceVerdict, AResultOfTheDoctorReplacesWhatIsKept) {
  Asked ask;
  ask(device());
  keep_verdict(device(), {probe("A6", false)}, 5);
  const DeviceVerdict verdict = ask(device());
  EXPECT_TRUE(verdict.remembered);
  EXPECT_FALSE(verdict.holds);
  EXPECT_EQ(ask.runs, 1);
}

// A later run of the probes that does not pass leaves nothing of an older promise, whatever becomes
// of its own verdict. The twin: one that passes leaves it in place where it cannot be written.
TEST(DeviceVerdict, NoOlderPromiseOutlivesProbesThatBreakOff) {
  Asked ask;
  const std::string file = ask(device()).file;
  keep_verdict(device(), {probe("A2", true), kBrokenOff}, 5);
  EXPECT_FALSE(std::filesystem::exists(file));
  EXPECT_FALSE(ask(device()).remembered);
  EXPECT_TRUE(ask(device()).remembered);
  keep_verdict(device(), {}, 5);
  EXPECT_FALSE(std::filesystem::exists(file));
}

TEST(DeviceVerdict, AFailureIsKeptThoughAnotherProbeBrokeOff) {
  Asked ask;
  ask(device());
  const DeviceVerdict now = keep_verdict(device(), {kBrokenOff, probe("A2", false)}, 5);
  EXPECT_EQ(now.problem, "A4 x: no memory");
  EXPECT_FALSE(now.file.empty());
  const DeviceVerdict later = ask(device());
  EXPECT_TRUE(later.remembered);
  EXPECT_FALSE(later.holds);
  EXPECT_EQ(to_string(later), to_string(now));
  EXPECT_EQ(ask.runs, 1);
}

TEST(DeviceVerdict, NoOlderPromiseOutlivesAFailureThatCannotBeWritten) {
  for (const bool pass : {false, true}) {
    Asked ask;
    ask(device());
    DeviceVerdict full;
    {
      const FileSizeLimit full_disk(0);
      full = keep_verdict(device(), {probe("A2", pass)}, 5);
    }
    EXPECT_TRUE(full.file.empty());
    EXPECT_FALSE(full.note.empty());
    EXPECT_EQ(ask(device()).remembered, pass);
  }
}

}  // namespace
}  // namespace farcull
