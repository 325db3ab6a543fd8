#include "experiments/check.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "experiments/builtin_scenes.h"
#include "experiments/mesh_text.h"
#include "tests/experiments/error_of.h"
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
    answer.status = check_command(arguments);
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
    record.pairs = all_colliding_pairs(scene).pairs;
    certificate = certificate_of(scene, record, record.pairs);
  }
  std::string written() { return folder.write("certificate.json", to_text(certificate)); }

  Scene scene;
  RunRecord record;
  Certificate certificate;
  ScratchFolder folder;
};

TEST_F(Check, ProvedIsStatus0) {
  const Answer answer = check({written(), {"random-soup"}, ""});
  EXPECT_EQ(answer.status, 0);
  EXPECT_EQ(answer.text.substr(0, 7), "proved\n");
  EXPECT_NE(answer.text.find("unattested"), std::string::npos);
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
  const TrianglePair first = record.pairs.front();
  EXPECT_EQ(scene.objects[json["pair"]["a"]["object"]].first_triangle +
                json["pair"]["a"]["triangle"].get<std::uint32_t>(),
            first.a);
  EXPECT_EQ(scene.objects[json["pair"]["b"]["object"]].first_triangle +
                json["pair"]["b"]["triangle"].get<std::uint32_t>(),
            first.b);
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
  record.options.method = Method::far;
  record.options.resolution = 300;
  record.device = GlInfo{};
  record.device->renderer = "some device";
  record.views.resize(3);
  record.views[0].drawn = record.views[2].drawn = true;
  record.views[0].radius_px = 0.7;
  record.views[2].radius_px = 0.8;
  const Certificate::Run run = certificate_of(scene, record, record.pairs).run;
  EXPECT_EQ(run.method, "far");
  EXPECT_EQ(run.offset, "obb");
  EXPECT_EQ(run.resolution, 300u);
  EXPECT_EQ(run.radius_px, 0.8);
  EXPECT_EQ(run.views.size(), 2u);
  EXPECT_EQ(run.device.value().renderer, "some device");
  EXPECT_EQ(run.assumptions.size(), 7u);
  EXPECT_FALSE(certificate.run.device.has_value());  // of the method exact
  EXPECT_EQ(certificate.run.resolution, 0u);
}

}  // namespace
}  // namespace farcull
