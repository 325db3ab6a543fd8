// Cases of public trackers, motions and loads: their labels by both oracles, and our own answers.
#include <numeric>
#include <regex>

#include "embedded/reported_txt.h"
#include "experiments/generators/pair_generators.h"
#include "experiments/library/farcull.h"
#include "experiments/method/run.h"
#include "experiments/suite/writer.h"
#include "tests/lab/test.h"
#include "verify/certificate/integer_distance.h"
#include "verify/inside.h"

namespace farcull {
namespace {

using Lists = std::vector<TrianglePair>;

Lists listed(const SuiteMesh& mesh) {
  Lists out;
  for (const SuiteMeshPair& pair : mesh.pairs) out.push_back(pair.pair);
  return out;
}

/// The objects of a case as a scene, without labels.
Scene scene_of(const ReportedCase& one) {
  Scene out;
  out.name = one.source;
  for (const SuiteObject& object : one.objects) {
    const auto first = static_cast<std::uint32_t>(out.vertices.size());
    out.objects.push_back({.name = std::to_string(out.objects.size()),
                           .first_triangle = static_cast<std::uint32_t>(out.triangles.size()),
                           .triangle_count = static_cast<std::uint32_t>(object.triangles.size()),
                           .self = one.self});
    out.vertices.insert(out.vertices.end(), object.vertices.begin(), object.vertices.end());
    for (const auto& [i, j, k] : object.triangles)
      out.triangles.push_back({first + i, first + j, first + k});
  }
  out.source_face.resize(out.triangles.size());
  return out;
}

/// Whether the point is inside the object and not on it: by both oracles, which have to agree.
bool is_inside(const Scene& scene, std::uint32_t object, const Vec3& point) {
  Scene with = scene;
  const auto v = static_cast<std::uint32_t>(with.vertices.size());
  const auto t = static_cast<std::uint32_t>(with.triangles.size());
  with.vertices.push_back(point);
  with.triangles.push_back({v, v, v});
  with.objects.push_back({.name = "point", .first_triangle = t, .triangle_count = 1});
  const auto number = static_cast<std::uint32_t>(scene.objects.size());
  const std::optional<InsideClaim> claim = IntegerInside(with).which(object, number);
  const bool out = inside(scene, object, point) == Inside::yes;
  EXPECT_EQ(out, claim == InsideClaim::b) << scene.name << ", object " << object;
  return out;
}

/// Sets of vertices of an object that triangles connect, each as a box.
std::vector<Box> pieces(const SuiteObject& object) {
  std::vector<std::uint32_t> root(object.vertices.size());
  std::iota(root.begin(), root.end(), 0u);
  const auto find = [&](std::uint32_t v) {
    while (root[v] != v) v = root[v];
    return v;
  };
  for (const auto& [i, j, k] : object.triangles) {
    root[find(i)] = find(k);
    root[find(j)] = find(k);
  }
  std::map<std::uint32_t, Box> boxes;
  for (std::uint32_t v = 0; v < root.size(); ++v)
    boxes.try_emplace(find(v), Box::empty()).first->second.add(object.vertices[v]);
  std::vector<Box> out;
  for (const auto& [v, box] : boxes) out.push_back(box);
  return out;
}

/// "touch" if each two pieces are apart along an axis of the coordinates, or touch there: then
/// their insides have no common point. "meets" if the middle of what two boxes have in common is
/// inside both objects. Objects that are not closed have no inside, and meet. Else "?".
std::string how_they_meet(const ReportedCase& one, const Scene& scene) {
  std::string out = "touch";
  for (std::uint32_t i = 0; i < one.objects.size(); ++i) {
    for (std::uint32_t j = i + 1; j < one.objects.size(); ++j) {
      if (!is_closed(scene, i) || !is_closed(scene, j)) return "meets";
      for (const Box& a : pieces(one.objects[i])) {
        for (const Box& b : pieces(one.objects[j])) {
          const Box both = intersection(a, b);
          if ((both.lo.array() >= both.hi.array()).any()) continue;
          const Vec3 middle = (both.lo + both.hi) / 2;
          if (is_inside(scene, i, middle) && is_inside(scene, j, middle)) return "meets";
          out = "?";
        }
      }
    }
  }
  return out;
}

/// Whether an object is inside another one, by both oracles.
bool one_is_inside(const Scene& scene) {
  bool out = false;
  for (std::uint32_t i = 0; i < scene.objects.size(); ++i) {
    for (std::uint32_t j = 0; j < scene.objects.size(); ++j) {
      const Vec3& corner = scene.corners(scene.objects[j].first_triangle)[0];
      out = out || (i != j && is_closed(scene, i) && is_inside(scene, i, corner));
    }
  }
  return out;
}

std::string decided(const ReportedCase& one) {
  if (one.objects.empty()) {
    SuitePair pair;
    pair.a = one.pair.a;
    pair.b = one.pair.b;
    if (one.pair.neighbours) pair.shared = equal_corners(pair.a, pair.b);
    return to_string(decide(pair, one.source));
  }
  const Scene scene = scene_of(one);
  if (!decide_mesh(scene, one.source).empty())
    return one.self ? "meets" : how_they_meet(one, scene);
  return !one.self && one_is_inside(scene) ? "inside" : "apart";
}

std::vector<ReportedCase> wrongly_labelled(const std::vector<ReportedCase>& cases) {
  std::vector<ReportedCase> out;
  for (const ReportedCase& one : cases) {
    if (decided(one) != one.label) out.push_back(one);
  }
  return out;
}

TEST(Reported, LabelsAreThoseOfBothOracles) {
  for (const ReportedCase& one : wrongly_labelled(reported_cases()))
    ADD_FAILURE() << one.source << " is " << decided(one) << ", not " << one.label << "\n"
                  << one.why;
}

// The twin: the table with every label exchanged for another one.
TEST(Reported, LabelsThatAreFlippedAreFound) {
  const std::map<std::string, std::string> other = {{"apart", "meets"},
                                                    {"inside", "apart"},
                                                    {"touch", "meets"},
                                                    {"meets", "touch"},
                                                    {"crossing", "touch-face"},
                                                    {"coplanar", "apart"},
                                                    {"equal", "coplanar"},
                                                    {"touch-vertex", "apart"},
                                                    {"touch-edge", "touch-vertex"},
                                                    {"neighbours-meet", "neighbours-apart"},
                                                    {"neighbours-apart", "neighbours-meet"}};
  const std::regex label("label ([a-z-]+)\n");
  std::string table = embedded::reported_txt, flipped;
  for (std::smatch at; std::regex_search(table, at, label); table = at.suffix())
    flipped += at.prefix().str() + "label " + other.at(at[1]) + "\n";
  const std::vector<ReportedCase> cases = parse_reported(flipped + table);
  EXPECT_EQ(cases.size(), reported_cases().size());
  EXPECT_EQ(wrongly_labelled(cases).size(), cases.size());
}

TEST(Reported, EveryCaseNamesItsSourceAndItsReasons) {
  std::set<std::string> sources, repositories, expected;
  for (const ReportedCase& one : reported_cases()) {
    EXPECT_TRUE(std::regex_match(one.source, std::regex("[\\w.-]+/[\\w.-]+#[1-9][0-9]*")))
        << one.source;
    EXPECT_TRUE(one.expected.ends_with('.')) << one.source;
    EXPECT_TRUE(one.why.ends_with('.')) << one.source;
    EXPECT_TRUE(expected.insert(one.expected).second) << one.expected;
    sources.insert(one.source);
    repositories.insert(one.source.substr(0, one.source.find('#')));
  }
  EXPECT_GE(reported_cases().size(), 80u);
  EXPECT_GE(sources.size(), 60u);
  EXPECT_GE(repositories.size(), 30u);
}

TEST(Reported, AMalformedTableNamesItsLine) {
  const auto refused = [](const std::string& line) {
    try {
      parse_reported("# a comment\n\ncase a/b#1\nobject box 0 0 0 1 1 1\n" + line + "\n");
    } catch (const std::logic_error& error) {
      return std::string(error.what()).find("line 5") != std::string::npos;
    }
    return false;
  };
  for (const char* line :
       {"label", "pair 1 2 3", "object box 0 0 0 1 1", "object ball 1", "part mesh 0 0 0 / 0 0 1",
        "object mesh 0 0 0 0 1 2", "object prism 0 1 2 3", "turn 1 2 3", "move 1 2 x", "colour red",
        "neighbours 1 2 3 4 5 6 7 8 9 1 2 3 4 5 6 7 8 nine"})
    EXPECT_TRUE(refused(line)) << line;
  EXPECT_FALSE(refused("part box 1 1 1 2 2 2"));
}

TEST(Reported, AreInTheFilesWithTheirReasons) {
  const std::string pairs = pairs_text(make_pairs("reported", {}));
  EXPECT_TRUE(has_text(pairs, "# source: elalish/manifold#186\n# expected: The gap"));
  const SuiteMesh mesh = make_mesh("reported-1", {});
  const ScratchFolder folder;
  for (const SuiteText& text : mesh_texts(mesh)) folder.write("reported-1/" + text.name, text.text);
  EXPECT_EQ(read_mesh(folder.path("reported-1")).note, mesh.note);
  EXPECT_TRUE(mesh.note.starts_with("source: IfcOpenShell/IfcOpenShell#4594\nexpected: "));
}

// ---- Our own answers

Lists pairs_by(Method method, Session& session, const Scene& scene) {
  RunOptions options;
  options.method = method;
  options.device = "native";
  options.verify = false;
  Lists out = run(scene, options, session).collisions.all();
  std::ranges::sort(out);
  return out;
}

Lists pairs_by(Collider& collider, const Scene& scene) {
  std::vector<std::uint32_t> triangles, starts;
  for (const auto& t : scene.triangles) triangles.insert(triangles.end(), t.begin(), t.end());
  for (const Object& object : scene.objects) starts.push_back(object.first_triangle);
  const Result result =
      collider.find({.vertices = {scene.vertices.front().data(), 3 * scene.vertices.size()},
                     .triangles = triangles,
                     .object_starts = starts});
  Lists out;
  for (const auto* some : {&result.pairs, &result.neighbour_pairs}) {
    for (const Pair& pair : *some) out.push_back({pair.a, pair.b});
  }
  std::ranges::sort(out);
  return out;
}

/// The meshes of the families in the small suite, in the order of their numbers.
std::vector<SuiteMesh> meshes_of(const std::set<std::string>& families) {
  std::vector<SuiteMesh> out;
  for (const MeshFamily& family : mesh_families()) {
    if (!families.contains(family.name)) continue;
    for (std::size_t i = 0; i < family.small; ++i)
      out.push_back(make_mesh(fmt::format("{}-{}", family.name, i + 1), {}));
  }
  return out;
}

void expect_right(Session& session, const SuiteMesh& mesh) {
  for (const Method method : {Method::far, Method::boxes, Method::exact}) {
    EXPECT_EQ(pairs_by(method, session, mesh.scene), listed(mesh))
        << to_string(method) << ", " << mesh.name << "\n"
        << mesh.note;
  }
}

TEST(Reported, OurMethodsAreRightAboutEveryMesh) {
  Session session("native", 1, {});
  for (const SuiteMesh& mesh : meshes_of({"reported", "reported-self"}))
    expect_right(session, mesh);
}

TEST(Loads, AreFoundWithAllTheContactsThatTheyPromise) {
  Session session("native", 1, {});
  std::size_t most = 0;
  for (const SuiteMesh& mesh : meshes_of({"bars", "hub"})) {
    EXPECT_EQ(static_cast<double>(mesh.pairs.size()), mesh.parameter) << mesh.name;
    expect_right(session, mesh);
    most = std::max(most, mesh.pairs.size());
  }
  EXPECT_GT(most, 65535u);  // what 16 bits can count
}

/// The frames of each motion.
std::vector<std::vector<SuiteMesh>> motions() {
  std::vector<std::vector<SuiteMesh>> out;
  for (const MeshFamily& family : mesh_families()) {
    if (family.motion) out.push_back(meshes_of({family.name}));
  }
  return out;
}

TEST(Motions, KeepTheirTrianglesAndChangeTheirContacts) {
  EXPECT_EQ(motions().size(), 4u);
  for (const std::vector<SuiteMesh>& frames : motions()) {
    ASSERT_EQ(frames.size(), 12u);
    int changes = 0;
    for (std::size_t i = 1; i < frames.size(); ++i) {
      EXPECT_EQ(frames[i].scene.triangles, frames[0].scene.triangles) << frames[i].name;
      // The twin of the next test: who repeats the answer of the frame before is wrong here.
      changes += frames[i].pairs != frames[i - 1].pairs;
    }
    EXPECT_GE(changes, 4) << frames[0].family;
  }
}

TEST(Motions, AreAnsweredRightlyByWhatKeepsItsState) {  // forwards and backwards
  for (const std::vector<SuiteMesh>& frames : motions()) {
    Session session("native", 1, {});
    Collider collider({.threads = 1});
    std::vector<const SuiteMesh*> asked;
    for (const SuiteMesh& mesh : frames) asked.push_back(&mesh);
    for (const SuiteMesh& mesh : frames) asked.insert(asked.begin() + 12, &mesh);
    for (const SuiteMesh* mesh : asked) {
      EXPECT_EQ(pairs_by(collider, mesh->scene), listed(*mesh)) << mesh->name;
      for (const Method method : {Method::far, Method::boxes, Method::exact, Method::i_collide})
        EXPECT_EQ(pairs_by(method, session, mesh->scene), listed(*mesh))
            << to_string(method) << ", " << mesh->name;
    }
  }
}

}  // namespace
}  // namespace farcull
