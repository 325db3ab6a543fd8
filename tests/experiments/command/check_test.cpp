// `farcull check` of certificates, of lists and of frames: what it prints, its status, and what it
// refuses.
#include "experiments/command/command.h"

#include "experiments/measure/frames.h"
#include "experiments/scenes/mesh/text.h"
#include "experiments/system/text_table.h"
#include "tests/lab/certificates.h"

namespace farcull {
namespace {

struct ProgramAnswer {
  int status = -1;
  std::string text;
  std::string line() const { return text.substr(0, text.find('\n')); }
};

ProgramAnswer check(const CheckArguments& arguments) {
  testing::internal::CaptureStdout();
  ProgramAnswer answer;
  try {
    answer.status = run_check(arguments);
  } catch (...) {
    testing::internal::GetCapturedStdout();
    throw;
  }
  answer.text = testing::internal::GetCapturedStdout();
  return answer;
}

class Check : public testing::Test {
 protected:
  Check() : scene(make_builtin_scene("random-soup")) {
    record.options.method = Method::exact;
    record.collisions.pairs = all_colliding_pairs(scene).pairs;
    certificate = certificate_of(scene, record);
  }
  TrianglePair pair_of(const nlohmann::json& named) const {
    const auto triangle = [&](const nlohmann::json& one) {
      return scene.objects[one["object"]].first_triangle + one["triangle"].get<std::uint32_t>();
    };
    return {triangle(named["a"]), triangle(named["b"])};
  }
  std::string written() { return folder.write("certificate.json", to_text(certificate)); }

  Scene scene;
  Record record;
  Certificate certificate;
  ScratchFolder folder;
};

TEST_F(Check, RefutedIsStatus1AndNamesThePair) {
  for (std::uint8_t& byte : certificate.evidence) {
    if (byte == (kKept | kMeets)) {
      byte = kMeets;
      break;
    }
  }
  const ProgramAnswer answer = check({written(), {"random-soup"}, "-"});
  EXPECT_EQ(answer.status, 1);
  const nlohmann::json json = nlohmann::json::parse(answer.text);
  EXPECT_EQ(json["verdict"], "refuted");
  EXPECT_EQ(json["culled_meeting"], 1);
  EXPECT_EQ(pair_of(json["pair"]), record.collisions.pairs.front());
}

// The list that a run wrote is proved with the certificate, or shown not to be the one.
TEST_F(Check, ComparesTheListThatIsGiven) {
  const auto check_list = [&](const std::string& list, bool with_certificate) {
    CheckArguments arguments{.certificate = "",
                             .scene = {"random-soup"},
                             .json = "-",
                             .pairs = folder.write("pairs.csv", list)};
    if (with_certificate) arguments.certificate = written();
    return check(arguments);
  };
  const std::string list = pair_list(scene, record.collisions.pairs);
  const std::size_t second = list.find('\n') + 1;
  const std::size_t third = list.find('\n', second) + 1;
  for (const bool with : {true, false}) {
    SCOPED_TRACE(with);
    for (const std::string& same :
         {pairs_csv(scene, record), list, list.substr(0, list.size() - 1)}) {
      const ProgramAnswer answer = check_list(same, with);
      EXPECT_EQ(answer.status, 0);
      const nlohmann::json json = nlohmann::json::parse(answer.text);
      EXPECT_EQ(json["verdict"], "proved");
      EXPECT_EQ(json["certificate"].is_null(), !with);
      EXPECT_EQ(json["list"]["given_is_found"], true);
      EXPECT_EQ(json["list"]["lines"], record.collisions.pairs.size());
      EXPECT_EQ(json["list"]["found_sha256"], certificate.list_sha256);
      EXPECT_EQ(json["unattested"].empty(), !with);
    }
    const std::string last = "line " + std::to_string(record.collisions.pairs.size() + 2);
    for (const auto& [other, reason, wrong, missing] :
         {std::tuple(list.substr(0, second), std::string("a pair is missing"), 0u,
                     record.collisions.pairs.size()),
          std::tuple(list.substr(0, second) + list.substr(third), std::string("a pair is missing"),
                     0u, std::size_t{1}),
          std::tuple(list + "0,0,0,0\n", last + ": ", 1u, std::size_t{0}),
          std::tuple(list + list.substr(second, third - second),
                     last + ": the pair is that of line 2", 1u, std::size_t{0})}) {
      const ProgramAnswer answer = check_list(other, with);
      EXPECT_EQ(answer.status, 1);
      const nlohmann::json json = nlohmann::json::parse(answer.text);
      EXPECT_EQ(json["verdict"], with ? "not proved" : "refuted");
      EXPECT_EQ(json["list"]["given_is_found"], false);
      EXPECT_EQ(json["list"]["wrong"]["lines"], wrong);
      EXPECT_EQ(json["list"]["missing"]["pairs"], missing);
      EXPECT_TRUE(json["proves"].is_null());
      EXPECT_TRUE(has_text(json["reason"].get<std::string>(), reason));
      if (missing == 0) continue;
      for (const auto& pair : {json["pair"], json["list"]["missing"]["first"]})
        EXPECT_EQ(pair_of(pair), record.collisions.pairs.front());
    }
    EXPECT_EQ(error_of([&] { check_list("", with); }).where, folder.path("pairs.csv"));
    EXPECT_EQ(error_of([&] { check_list(list + "9,9,9,9\n", with); }).line,
              static_cast<long>(record.collisions.pairs.size() + 2));
    EXPECT_EQ(error_of([&] { check_list("frame," + list, with); }).where, folder.path("pairs.csv"));
  }
}

TEST_F(Check, ListsAndCertificatesOfAClearance) {
  const double clearance = 0.01;
  record.options.clearance = clearance;
  record.collisions.pairs = all_colliding_pairs(scene, {.clearance = clearance}).pairs;
  ASSERT_GT(record.collisions.pairs.size(), certificate.claims.meeting);
  const std::string plain = written();
  certificate = certificate_of(scene, record);
  EXPECT_EQ(certificate.clearance, clearance);
  const std::string list = folder.write("pairs.csv", pairs_csv(scene, record));
  const std::string near = folder.write("near.json", to_text(certificate));
  const std::vector<std::string> soup = {"random-soup"};
  const ProgramAnswer proved = check({.certificate = near, .scene = soup, .pairs = list});
  EXPECT_EQ(proved.status, 0);
  EXPECT_EQ(proved.text.substr(0, proved.text.find('\n')),
            "proved: these " + grouped(record.collisions.pairs.size()) +
                " pairs of the scene are at distance 0.01 or less, and no others");
  EXPECT_EQ(
      check({.certificate = near, .scene = soup, .pairs = list, .clearance = clearance}).status, 0);
  EXPECT_EQ(check({.certificate = "", .scene = soup, .pairs = list, .clearance = clearance}).status,
            0);
  // The twins: another clearance of the question, by one unit in the last place.
  const ProgramAnswer other =
      check({.certificate = near, .scene = soup, .clearance = std::nextafter(clearance, 1)});
  EXPECT_EQ(other.status, 1);
  EXPECT_TRUE(has_text(other.text, "another clearance: 0.01, not 0.01000"));
  EXPECT_EQ(check({.certificate = plain, .scene = soup, .clearance = clearance}).status, 1);
  const ProgramAnswer none = check({.certificate = "", .scene = soup, .pairs = list});
  EXPECT_EQ(none.status, 1);
  EXPECT_EQ(none.text.substr(0, 8), "refuted:");
  EXPECT_EQ(check({.certificate = plain, .scene = soup, .pairs = list}).status, 1);
}

// ---- frames ----

class CheckFrames : public testing::Test {
 protected:
  void SetUp() override {
    FramesQuestion question;
    question.options.method = Method::boxes;
    question.options.device = "cpu";
    question.range = range;
    question.pairs = question.certificates = true;
    std::string list;
    run_frames(scene, question, {}, [&](const FrameReport& report) {
      write_output(numbered(pattern, report.number), report.certificate);
      list += report.pairs_csv;
    });
    pairs = folder.write("pairs.csv", list);
  }
  CheckArguments arguments() const {
    return {.certificate = pattern, .scene = scene, .frames = range};
  }

  ScratchFolder folder;
  const std::vector<std::string> scene = {"two-spheres"};
  const FrameRange range = {3, 6};
  const std::string pattern = folder.path("c_%03d.json");
  std::string pairs;
};

TEST_F(CheckFrames, EachIsProved) {
  const ProgramAnswer answer = check(arguments());
  EXPECT_EQ(answer.status, 0);
  EXPECT_TRUE(has_text(answer.text,
                       "\nproved: in each of 4 frames these pairs of the scene meet, and no "
                       "others: "));
  for (const char* row : {"\n      3  proved ", "\n      6  proved "})
    EXPECT_TRUE(has_text(answer.text, row));

  CheckArguments with_list = arguments();
  with_list.pairs = pairs;
  with_list.json = "-";
  const nlohmann::json json = nlohmann::json::parse(check(with_list).text);
  ASSERT_EQ(json["frames"].size(), 4u);
  for (int i = 0; i < 4; ++i) {
    EXPECT_EQ(json["frames"][i]["frame"], 3 + i);
    EXPECT_EQ(json["frames"][i]["verdict"], "proved");
    EXPECT_EQ(json["frames"][i]["list"]["given_is_found"], true);
  }
  EXPECT_EQ(json["summary"]["verdict"], "proved");
  EXPECT_EQ(json["summary"]["proved"], 4);
  with_list.certificate = "";
  EXPECT_EQ(check(with_list).status, 0);
  with_list.frames = FrameRange{3, 5};
  EXPECT_EQ(error_of([&] { check(with_list); }).where, pairs);  // of a frame that is not checked
  with_list.frames.reset();
  EXPECT_EQ(error_of([&] { check(with_list); }).where, pairs);
}

TEST_F(CheckFrames, OfAnotherFrameIsNotProved) {
  const std::string of_4 = read_file(numbered(pattern, 4), 1 << 24);
  folder.write("c_005.json", of_4);
  const ProgramAnswer answer = check(arguments());
  EXPECT_EQ(answer.status, 1);
  EXPECT_TRUE(has_text(answer.text, "\n      5  not proved "));
  EXPECT_TRUE(has_text(answer.text, "of another scene"));
  EXPECT_TRUE(has_text(answer.text, "\nnot proved: 1 of 4 frames, the first is frame 5\n"));
}

TEST_F(CheckFrames, APairThatIsDroppedIsNamedWithItsFrame) {
  std::string list = read_file(pairs, 1 << 24);
  const std::size_t at = list.find("\n4,") + 1;
  ASSERT_NE(at, 0u);
  list.erase(at, list.find('\n', at) + 1 - at);
  folder.write("pairs.csv", list);
  CheckArguments fewer = arguments();
  fewer.certificate = "";
  fewer.pairs = pairs;
  fewer.json = "-";
  const ProgramAnswer answer = check(fewer);
  EXPECT_EQ(answer.status, 1);
  const nlohmann::json json = nlohmann::json::parse(answer.text);
  EXPECT_EQ(json["frames"][0]["verdict"], "proved");
  EXPECT_EQ(json["frames"][1]["verdict"], "refuted");
  EXPECT_EQ(json["frames"][1]["list"]["missing"]["pairs"], 1);
  EXPECT_EQ(json["frames"][2]["verdict"], "proved");
  EXPECT_EQ(json["summary"]["verdict"], "refuted");
  EXPECT_EQ(json["summary"]["first"], 4);
}

TEST_F(CheckFrames, OneThatIsNotThereIsAnErrorAfterTheFramesBefore) {
  std::filesystem::remove(numbered(pattern, 5));
  CheckArguments json = arguments();
  json.json = folder.path("checked.json");
  EXPECT_EQ(error_of([&] { check(json); }).where, numbered(pattern, 5));
  EXPECT_EQ(nlohmann::json::parse(read_file(json.json, 1 << 20))["frames"].size(), 2u);
}

// A run that missed every pair: what it wrote is refuted; forged to call them kept, the certificate
// is at most true of the scene, and the list of the run is still not the one.
TEST_F(Check, AForgedCertificateClaimsNothingOfTheRun) {
  Record missed = record;
  missed.options.method = Method::quick_cullide;
  missed.collisions.pairs.clear();
  missed.found.pairs.clear();
  const std::string list = folder.write("pairs.csv", pairs_csv(scene, missed));
  certificate = certificate_of(scene, missed);
  EXPECT_EQ(check({written(), {"random-soup"}}).text.substr(0, 8), "refuted:");
  for (std::uint8_t& byte : certificate.evidence)
    if (byte == kMeets) byte |= kKept;
  certificate.claims.kept += record.collisions.pairs.size();
  certificate.claims.culled -= record.collisions.pairs.size();
  certificate.run.method = "far";
  const ProgramAnswer forged = check({written(), {"random-soup"}});
  EXPECT_EQ(forged.status, 1);
  EXPECT_EQ(forged.text.substr(0, 58),
            "not proved: the certificate is of another list of pairs: l");
  certificate.list_sha256 = pair_list_hash(scene, record.collisions.pairs);
  const ProgramAnswer of_the_scene = check({written(), {"random-soup"}});
  EXPECT_EQ(of_the_scene.status, 0);
  EXPECT_TRUE(has_text(of_the_scene.text, "  that the method was far\n  which pairs the run kept"));
  EXPECT_EQ(check({.certificate = written(), .scene = {"random-soup"}, .pairs = list}).status, 1);
}

TEST_F(Check, WhatCannotBeReadIsAnError) {
  EXPECT_EQ(error_of([&] {
              check({folder.path("absent.json"), {"random-soup"}, ""});
            }).where,
            folder.path("absent.json"));
  const std::string bad = folder.write("bad.json", "{\"format\": 1}");
  EXPECT_EQ(error_of([&] { check({bad, {"random-soup"}, ""}); }).where, bad);
  EXPECT_EQ(error_of([&] { check({written(), {"no-such-scene"}, ""}); }).where, "no-such-scene");
}

TEST_F(Check, CertificateOfARunTellsWhatDrew) {
  record.found.pairs = record.collisions.pairs;
  record.options.method = Method::far;
  record.options.resolution = 300;
  record.found.device.gl = GlInfo{};
  record.found.device.gl->renderer = "some device";
  std::vector<ViewReport> views(3);
  views[0].drawn = views[2].drawn = true;
  views[0].radius_px = 0.7;
  views[2].radius_px = 0.8;
  record.found.by = views;
  const Certificate::Run run = certificate_of(scene, record).run;
  EXPECT_EQ(run.method, "far");
  EXPECT_EQ(run.offset, "obb");
  EXPECT_EQ(run.resolution, 300u);
  EXPECT_EQ(run.radius_px, 0.8);
  EXPECT_EQ(run.views.size(), 2u);
  EXPECT_EQ(run.device.value().renderer, "some device");
  ASSERT_EQ(run.assumptions.size(), 10u);
  for (std::size_t a = 0; a < 10; ++a)
    EXPECT_TRUE(run.assumptions[a].starts_with("A" + std::to_string(a + 1) + ": "))
        << run.assumptions[a];
  EXPECT_FALSE(has_text(run.assumptions.back(), "thread"));
  record.found.device.gl->kind = "software";
  const std::string last = certificate_of(scene, record).run.assumptions.back();
  EXPECT_TRUE(last.ends_with("; it drew in 0 threads of its own")) << last;
  EXPECT_FALSE(certificate.run.device.has_value());  // of the method exact
  EXPECT_EQ(certificate.run.resolution, 0u);
}

}  // namespace
}  // namespace farcull
