#include "experiments/command/check.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "experiments/record/certificate.h"
#include "experiments/record/output.h"
#include "experiments/scenes/builtin/scenes.h"
#include "experiments/scenes/mesh/text.h"
#include "experiments/system/text_table.h"
#include "tests/experiments/system/error_of.h"
#include "verify/certificate/pair_list.h"
#include "verify/exact.h"

namespace farcull {
namespace {

/// The command's status and what it printed.
struct Answer {
  int status = -1;
  std::string text;
};

Answer check(const CheckArguments& arguments) {
  testing::internal::CaptureStdout();
  Answer answer;
  try {
    answer.status = check_certificate_file(arguments);
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
  std::string written() { return folder.write("certificate.json", to_text(certificate)); }

  Scene scene;
  Record record;
  Certificate certificate;
  ScratchFolder folder;
};

TEST_F(Check, ProvedIsStatus0) {
  const Answer answer = check({written(), {"random-soup"}, ""});
  EXPECT_EQ(answer.status, 0);
  EXPECT_EQ(answer.text.substr(0, answer.text.find('\n')),
            "proved: these " + grouped(record.collisions.pairs.size()) +
                " pairs of the scene meet, and no others");
  EXPECT_NE(answer.text.find("unattested"), std::string::npos);
  EXPECT_NE(answer.text.find("about the scene and not about the run"), std::string::npos);
  EXPECT_NE(answer.text.find("  which pairs the run kept"), std::string::npos);
  EXPECT_NE(answer.text.find("ns per pair"), std::string::npos);
}

TEST_F(Check, RefutedIsStatus1AndNamesThePair) {
  for (std::uint8_t& byte : certificate.evidence) {
    if (byte == (kKept | kMeets)) {
      byte = kMeets;
      break;
    }
  }
  const Answer answer = check({written(), {"random-soup"}, "-"});
  EXPECT_EQ(answer.status, 1);
  const nlohmann::json json = nlohmann::json::parse(answer.text);
  EXPECT_EQ(json["verdict"], "refuted");
  EXPECT_EQ(json["culled_meeting"], 1);
  const TrianglePair first = record.collisions.pairs.front();
  EXPECT_EQ(scene.objects[json["pair"]["a"]["object"]].first_triangle +
                json["pair"]["a"]["triangle"].get<std::uint32_t>(),
            first.a);
  EXPECT_EQ(scene.objects[json["pair"]["b"]["object"]].first_triangle +
                json["pair"]["b"]["triangle"].get<std::uint32_t>(),
            first.b);
}

// The list that a run wrote is proved with the certificate, or shown not to be the one.
TEST_F(Check, ComparesTheListThatIsGiven) {
  const auto check_list = [&](const std::string& list) {
    return check({.certificate = written(),
                  .scene = {"random-soup"},
                  .json = "-",
                  .pairs = folder.write("pairs.csv", list)});
  };
  const std::string list = pairs_csv(scene, record);
  ASSERT_EQ(list, pair_list(scene, record.collisions.pairs));
  const Answer same = check_list(list);
  EXPECT_EQ(same.status, 0);
  nlohmann::json json = nlohmann::json::parse(same.text);
  EXPECT_EQ(json["verdict"], "proved");
  EXPECT_EQ(json["list"]["given_is_found"], true);
  EXPECT_EQ(json["list"]["found_sha256"], certificate.list_sha256);

  const std::size_t second = list.find('\n') + 1;
  const std::size_t third = list.find('\n', second) + 1;
  for (const auto& [other, reason] :
       {std::pair(list.substr(0, second), "line 2 is nothing"),               // lacks every pair
        std::pair(list.substr(0, second) + list.substr(third), "line 2 is"),  // lacks one
        std::pair(list + "0,0,1,0\n", "it is nothing"),                       // one too many
        std::pair(list.substr(0, list.size() - 1), "other bytes"),
        std::pair(std::string(), "line 1 is nothing")}) {
    const Answer answer = check_list(other);
    EXPECT_EQ(answer.status, 1);
    json = nlohmann::json::parse(answer.text);
    EXPECT_EQ(json["verdict"], "not proved");
    EXPECT_EQ(json["list"]["given_is_found"], false);
    EXPECT_TRUE(json["proves"].is_null());
    EXPECT_NE(json["reason"].get<std::string>().find(reason), std::string::npos) << json["reason"];
  }
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
  for (std::uint8_t& byte : certificate.evidence) {
    if (byte == kMeets) byte |= kKept;
  }
  certificate.claims.kept += record.collisions.pairs.size();
  certificate.claims.culled -= record.collisions.pairs.size();
  certificate.run.method = "far";
  const Answer forged = check({written(), {"random-soup"}});
  EXPECT_EQ(forged.status, 1);
  EXPECT_EQ(forged.text.substr(0, 58),
            "not proved: the certificate is of another list of pairs: l");
  certificate.list_sha256 = pair_list_hash(scene, record.collisions.pairs);
  const Answer of_the_scene = check({written(), {"random-soup"}});
  EXPECT_EQ(of_the_scene.status, 0);
  EXPECT_NE(of_the_scene.text.find("  that the method was far\n  which pairs the run kept"),
            std::string::npos);
  EXPECT_EQ(check({.certificate = written(), .scene = {"random-soup"}, .pairs = list}).status, 1);
}

TEST_F(Check, SaysWhatWasNotAsked) {
  const Answer answer = check({written(), {"random-soup"}, "-"});
  const nlohmann::json unasked = nlohmann::json::parse(answer.text)["scene"]["self_not_asked"];
  EXPECT_EQ(unasked["objects"], scene.objects.size());
  EXPECT_EQ(unasked["pairs"], certificate.not_asked.pairs);
  EXPECT_GT(certificate.not_asked.pairs, 0u);
  EXPECT_NE(check({written(), {"random-soup"}}).text.find("\nnot asked  whether an object meets"),
            std::string::npos);
}

TEST_F(Check, AnotherSceneIsStatus1) {
  const std::string json = folder.path("result.json");
  const Answer answer = check({written(), {"two-tori"}, json});
  EXPECT_EQ(answer.status, 1);
  EXPECT_EQ(answer.text.substr(0, 11), "not proved:");
  EXPECT_EQ(nlohmann::json::parse(read_file(json, 1 << 20))["verdict"], "not proved");
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
  ASSERT_EQ(run.assumptions.size(), 8u);
  for (std::size_t a = 0; a < 8; ++a)
    EXPECT_TRUE(run.assumptions[a].starts_with("A" + std::to_string(a + 1))) << run.assumptions[a];
  EXPECT_FALSE(certificate.run.device.has_value());  // of the method exact
  EXPECT_EQ(certificate.run.resolution, 0u);
}

}  // namespace
}  // namespace farcull
