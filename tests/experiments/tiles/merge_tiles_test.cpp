// What is merged is the list of one run; whatever is missing, doubled, foreign or cut short is
// refused, and then no file is written.

#include "experiments/tiles/run_tile.h"
#include "tests/lab/test.h"

namespace farcull {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr std::size_t kTiles = 3;

class MergeTiles : public testing::Test {
 protected:
  MergeTiles() {
    for (std::size_t k = 1; k <= kTiles; ++k) run(k, kTiles, "field:9000");
  }

  std::string record(std::size_t k) const { return folder_.path(fmt::format("t{}.json", k)); }
  fs::path list(std::size_t k) const { return folder_.path(fmt::format("t{}.csv", k)); }
  std::string out() const { return folder_.path("all.csv"); }

  void run(std::size_t k, std::size_t n, const std::string& scene, double clearance = 0) {
    TileQuestion question{.options = {.device = "native", .clearance = clearance},
                          .number = {k, n}};
    const SceneSource source = [&](const TakePart& take) { return stream_scene({scene}, take); };
    const TileRun tile = run_tile(source, question, session_);
    const TileList text{
        .text = tile_list(tile, {}), .file = list(k).filename().string(), .columns = {}};
    write_text(list(k), text.text);
    write_text(record(k), tile_json(tile, &text).dump());
  }

  void change(std::size_t k, const std::function<void(Json&)>& how) {
    Json json = Json::parse(read_text(record(k)));
    how(json);
    write_text(record(k), json.dump());
  }

  // The reason for which the records are refused; nothing is left in the folder then.
  std::string refusal(const std::vector<std::string>& records) {
    const auto files = [&] {
      return std::distance(fs::directory_iterator(folder_.folder()), fs::directory_iterator());
    };
    const auto before = files();
    try {
      merge_tiles(records, out());
    } catch (const Error& error) {
      EXPECT_EQ(files(), before);
      return error.what();
    }
    ADD_FAILURE() << "was merged";
    return "";
  }
  std::string refusal() { return refusal({record(1), record(2), record(3)}); }
  void expect_refused(const std::string& reason) { EXPECT_TRUE(has_text(refusal(), reason)); }

  const ScratchFolder folder_;
  Session session_{"native"};
};

TEST_F(MergeTiles, GiveTheListOfOneRunInAnyOrder) {
  const Scene scene = load_scene({"field:9000"});
  const Record whole = farcull::run(scene, {.device = "native"}, session_);
  const MergedTiles merged = merge_tiles({record(3), record(1), record(2)}, out());
  EXPECT_EQ(read_text(out()), pairs_csv(scene, whole));
  EXPECT_EQ(merged.tiles, kTiles);
  EXPECT_EQ(merged.rows, whole.collisions.pairs.size());
  EXPECT_GT(merged.rows, 100);
  EXPECT_TRUE(merged.verified);
  EXPECT_EQ(merged.false_negatives, 0);
}

TEST_F(MergeTiles, RefuseTilesThatAreMissingOrThereTwice) {
  EXPECT_TRUE(has_text(refusal({record(1), record(3)}), "of its 3 tiles one is missing: 2"));
  EXPECT_TRUE(has_text(refusal({record(2)}), "2 are missing: 1, 3"));
  EXPECT_TRUE(has_text(refusal({record(1), record(2), record(2)}), "is tile 2 of 3, and so is"));
  EXPECT_TRUE(has_text(refusal({record(1), record(2), record(4)}), "does not exist"));
  fs::remove(list(2));
  expect_refused("does not exist, and");
}

TEST_F(MergeTiles, RefuseWhatIsNotOfOneScene) {
  run(2, kTiles, "field:9000@seed8");
  expect_refused("is of another scene");
  run(2, kTiles, "field:9000", 1e-3);
  expect_refused("was run with other options");
  run(2, 4, "field:9000");
  expect_refused("is of another number of tiles");
  const auto changed = [&](const char* place, const Json& value, const char* reason) {
    run(2, kTiles, "field:9000");
    change(2, [&](Json& json) { json[Json::json_pointer(place)] = value; });
    expect_refused(reason);
  };
  changed("/tile/cuts/0", 1e9, "is cut elsewhere");
  changed("/commit", "0123456", "is of another version");
  changed("/tile/options/clearance", 1, "was run with other options");
  changed("/tile/list/columns", "a,b", "has other columns in its list");
  changed("/tile/list/kinds", {"crossing"}, "has other kinds of contact in its list");
  changed("/tile/list", nullptr, "without --pairs FILE");
  changed("/tile/home_triangles", -1, "/tile/home_triangles is missing or wrong");
  changed("/tile/home_triangles", "1", "/tile/home_triangles is missing or wrong");
  changed("/tile/n", std::uint64_t{1} << 40, "says that it is tile 2 of 1099511627776");
  changed("/tile/list/file", std::string(300, 'x'), "does not exist, and");
}

TEST_F(MergeTiles, NoticeATriangleThatNoTileHas) {
  change(1, [](Json& json) {
    json["tile"]["home_triangles"] = json["tile"]["home_triangles"].get<int>() - 1;
  });
  expect_refused("the tiles together hold");
}

TEST_F(MergeTiles, RefuseListsThatWereCutShortOrChanged) {
  const std::string whole = read_text(list(2));
  write_text(list(2), whole.substr(0, whole.size() - 3));
  expect_refused("ends within a line");
  write_text(list(2), whole.substr(0, whole.rfind('\n', whole.size() - 2) + 1));
  expect_refused("it was cut short or changed");
  write_text(list(2), whole + whole.substr(whole.rfind('\n', whole.size() - 2) + 1));
  expect_refused("is not sorted");
  std::string other = whole;
  other[other.size() - 2] = other[other.size() - 2] == '9' ? '8' : '9';
  write_text(list(2), other);
  EXPECT_FALSE(refusal().empty());
  write_text(list(2), "");
  expect_refused("does not begin as its record says");
  write_text(list(2), whole);
  EXPECT_EQ(merge_tiles({record(1), record(2), record(3)}, out()).tiles, kTiles);
}

TEST_F(MergeTiles, RefuseAPairThatTwoTilesHave) {
  // As if tile 2 were tile 1 once more: all is consistent but for the pairs.
  write_text(list(2), read_text(list(1)));
  const Json one = Json::parse(read_text(record(1)));
  change(2, [&](Json& json) {
    json["tile"]["list"]["rows"] = one["tile"]["list"]["rows"];
    json["tile"]["list"]["sha256"] = one["tile"]["list"]["sha256"];
  });
  expect_refused("holds a pair that the list of another tile holds as well");
}

TEST_F(MergeTiles, RefuseWhatIsNoRecord) {
  write_text(record(2), "{\"tile\": ");
  expect_refused("is no JSON, or was cut short");
  write_text(record(2), "{}");
  expect_refused("it has no entry `tile`");
  run(2, kTiles, "field:9000");
  change(2, [](Json& json) { json["tile"].erase("k"); });
  expect_refused("/tile/k is missing or wrong");
  run(2, kTiles, "field:9000");
}

TEST_F(MergeTiles, DoNotWriteOverWhatIsRead) {
  const std::string before = read_text(list(1));
  EXPECT_THROW(merge_tiles({record(1), record(2), record(3)}, list(1).string()), Error);
  EXPECT_FALSE(fs::exists(out()));
  EXPECT_EQ(read_text(list(1)), before);
}

// Longer than what is read, and written, at a time.
TEST_F(MergeTiles, JoinLongLists) {
  constexpr std::size_t kRows = 100'000;
  const std::string columns = Json::parse(read_text(record(1)))["tile"]["list"]["columns"];
  std::array<std::string, kTiles> texts;
  std::array<std::size_t, kTiles> rows{};
  texts.fill(columns + "\n");
  std::string whole = columns + "\n";
  for (std::size_t row = 0; row < kRows * kTiles; ++row) {
    const std::string line = std::to_string(row / 7) + "," + std::to_string(row) + ",1000000000," +
                             std::to_string(row * row) + "\n";
    const std::size_t to = row * row % 7 % kTiles;
    texts[to] += line;
    ++rows[to];
    whole += line;
  }
  for (std::size_t k = 1; k <= kTiles; ++k) {
    ASSERT_GT(texts[k - 1].size(), std::size_t{1} << 20);
    write_text(list(k), texts[k - 1]);
    change(k, [&](Json& json) {
      json["tile"]["list"]["rows"] = rows[k - 1];
      json["tile"]["list"]["sha256"] = sha256(texts[k - 1]);
    });
  }
  EXPECT_EQ(merge_tiles({record(1), record(2), record(3)}, out()).rows, kRows * kTiles);
  EXPECT_TRUE(read_text(out()) == whole);
}

TEST_F(MergeTiles, PromiseWhatEveryTilePromises) {
  EXPECT_TRUE(merge_tiles({record(1), record(2), record(3)}, out()).guaranteed);
  change(2, [](Json& json) { json["promises"] = false; });
  EXPECT_FALSE(merge_tiles({record(1), record(2), record(3)}, out()).guaranteed);
}

TEST_F(MergeTiles, AddUpMissedPairs) {
  change(2, [](Json& json) { json["verification"]["false_negatives"] = 2; });
  change(3, [](Json& json) { json["verification"]["false_negatives"] = 1; });
  EXPECT_EQ(merge_tiles({record(1), record(2), record(3)}, out()).false_negatives, 3);
  change(1, [](Json& json) { json["verification"] = nullptr; });
  EXPECT_FALSE(merge_tiles({record(1), record(2), record(3)}, out()).verified);
}

}  // namespace
}  // namespace farcull
