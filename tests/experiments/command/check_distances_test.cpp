// `farcull check` of certificates of distances: what it prints, its status, and what it refuses.

#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>

#include "experiments/command/command.h"
#include "experiments/scenes/scene_file.h"
#include "tests/experiments/command/check_lab.h"
#include "tests/experiments/system/error_of.h"
#include "tests/verify/certificate/distance_case.h"

namespace farcull {
namespace {

using distance_case::Distances;
using Pairs = DistanceCertificate::Pairs;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Two triangles 2 apart, and a third one that is 3 above them.
class CheckDistances : public testing::Test {
 protected:
  CheckDistances() {
    const std::string face = "f 1 2 3\n";
    files = {folder.write("low.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n" + face),
             folder.write("middle.obj", "v 0 0 2\nv 1 0 2\nv 0 1 2\n" + face),
             folder.write("high.obj", "v 0 0 5\nv 1 0 5\nv 0 1 5\n" + face)};
    scene = load_scene(files);
  }
  ProgramAnswer answer(const DistanceCertificate& c, const std::string& json = "") {
    return check({folder.write("d.json", to_text(c)), files, json});
  }
  DistanceCertificate certificate(Pairs pairs, double within = kInfinity, std::uint64_t k = 0) {
    return Distances(scene).certificate(pairs, within, k);
  }

  ScratchFolder folder;
  std::vector<std::string> files;
  Scene scene;
};

TEST_F(CheckDistances, ProvedIsStatus0AndSaysWhat) {
  const auto says = [&](const DistanceCertificate& c, const std::string& line) {
    const ProgramAnswer found = answer(c);
    EXPECT_EQ(found.status, 0);
    EXPECT_EQ(found.line(), "proved: " + line);
    EXPECT_NE(found.text.find("in integers"), std::string::npos);
  };
  says(certificate(Pairs::objects),
       "these 3 pairs of objects are at exactly these distances, and there are no others");
  says(
      certificate(Pairs::objects, 3),
      "these 2 pairs of objects are at exactly these distances, and no others are at distance 3 or "
      "less");
  says(certificate(Pairs::objects, 2),
       "this pair of objects is at exactly this distance, and no other is at distance 2 or less");
  says(certificate(Pairs::objects, 1), "no two objects are at distance 1 or less");
  says(certificate(Pairs::nearest, kInfinity, 1),
       "these 2 pairs of objects are at exactly these distances, and they are each object's "
       "nearest, and no others");
  says(certificate(Pairs::nearest, 2.5, 2),
       "this pair of objects is at exactly this distance, and it is each object's 2 nearest at "
       "distance 2.5 or less, and no other");
  says(certificate(Pairs::all, 3),
       "these 2 pairs of triangles are at exactly these distances, and no others are at distance 3 "
       "or less");
}

TEST_F(CheckDistances, RefutedIsStatus1AndNamesThePairWithItsDistance) {
  DistanceCertificate c = certificate(Pairs::objects);
  c.distances[0].squared = "5/1";
  const ProgramAnswer found = answer(c);
  EXPECT_EQ(found.status, 1);
  EXPECT_EQ(found.line(),
            "refuted: the square of the distance in distances[0] is not that of its triangles");
  EXPECT_NE(found.text.find("  pair: low triangle 0 and middle triangle 0\n"), std::string::npos);
  EXPECT_NE(found.text.find("  the exact square of its distance: 4/1, so about 2\n"),
            std::string::npos);
  const nlohmann::json json = nlohmann::json::parse(answer(c, "-").text);
  EXPECT_EQ(json["verdict"], "refuted");
  EXPECT_EQ(json["proves"], nullptr);
  EXPECT_EQ(json["squared"], "4/1");
  EXPECT_EQ(json["distance"], 2);
  EXPECT_EQ(json["pair"]["b"]["name"], "middle");
  EXPECT_EQ(json["query"]["pairs"], "objects");

  DistanceCertificate shorter = certificate(Pairs::objects);
  shorter.distances.pop_back();
  EXPECT_EQ(answer(shorter).line(), "refuted: the objects of these triangles are not listed");
}

TEST_F(CheckDistances, NotProvedIsStatus1) {
  DistanceCertificate c = certificate(Pairs::objects);
  c.distances[0].features = {0, 6};
  const ProgramAnswer found = answer(c);
  EXPECT_EQ(found.status, 1);
  EXPECT_EQ(found.line(),
            "not proved: distances[0] does not say where the nearest points lie: vertex 0 and "
            "vertex 0 hold the first two");
  EXPECT_EQ(nlohmann::json::parse(answer(c, "-").text)["verdict"], "not proved");
}

// As a certificate of pairs.
TEST_F(CheckDistances, AnotherSceneIsNotProved) {
  const std::string file = folder.write("d.json", to_text(certificate(Pairs::objects)));
  const ProgramAnswer other = check({file, {files[0], files[1]}, ""});
  EXPECT_EQ(other.status, 1);
  EXPECT_EQ(other.line(), "not proved: the certificate is of another scene: objects 3, given 2");
  EXPECT_EQ(other.text.find("decided"), std::string::npos) << other.text;
  // `self` is part of the scene.
  const ProgramAnswer self = check({file, files, "", true});
  EXPECT_EQ(self.status, 1);
  EXPECT_NE(self.line().find("which objects are self"), std::string::npos);
}

TEST_F(CheckDistances, BadInputIsAnError) {
  const std::string file = folder.write("d.json", to_text(certificate(Pairs::objects)));
  CheckArguments arguments{file, files, ""};
  arguments.clearance = 1;
  EXPECT_EQ(error_of([&] { check(arguments); }).where, "--clearance");
  const std::string half =
      folder.write("half.json", to_text(certificate(Pairs::objects)).substr(0, 200));
  EXPECT_NE(error_of([&] { check({half, files, ""}); }).reason.find("not JSON"), std::string::npos);
}

}  // namespace
}  // namespace farcull
