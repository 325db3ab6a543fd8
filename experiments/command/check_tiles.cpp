// Checks the certificates of the tiles of a scene, and that the tiles cover the scene. The proved
// list consists of the rows of all tiles, sorted.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string_view>

#include "core/base/bytes.h"
#include "experiments/command/command.h"
#include "experiments/record/check.h"
#include "experiments/record/output.h"
#include "experiments/scenes/mesh/text.h"
#include "experiments/system/output_file.h"
#include "experiments/tiles/run_tile.h"
#include "verify/certificate/pair_list.h"

namespace farcull {
namespace {

using Json = nlohmann::ordered_json;

// A row of a list of pairs: the numbers of both objects and triangles, and the line of text.
using ListRow = std::pair<std::array<std::uint64_t, 4>, std::string>;

ListRow row_of(const PairListRows& rows, const TrianglePair& pair) {
  ListRow out;
  rows.append(pair, out.second);
  std::string_view rest = out.second;
  for (std::uint64_t& number : out.first) {
    number = take_number<std::uint64_t>(rest).value_or(0);
    rest.remove_prefix(1);
  }
  return out;
}

struct CheckedTile {
  std::string file;
  Tile tile;
  double clearance = 0;
  CheckResult result;  // its list `meeting` is empty
  std::string pair;    // names the pair that refutes the certificate, if there is one
};

// Returns the reason why the tiles do not cover the scene. Returns "" if each tile begins where the
// previous tile ends, the first tile has no lower bound, and the last tile has no upper bound. Each
// pair then belongs to exactly one tile (docs/tiles.md).
std::string not_whole(const std::vector<CheckedTile>& tiles) {
  double place = -HUGE_VAL;
  for (const CheckedTile& tile : tiles) {
    if (tile.tile.axis != tiles.front().tile.axis)
      return fmt::format("{} is of a tile along another axis than the first", tile.file);
    if (tile.clearance != tiles.front().clearance)
      return fmt::format("{} is of another clearance than the first", tile.file);
    if (tile.tile.from != place) {
      return fmt::format("{} is of the tile {}, which does not begin where the tile before it ends",
                         tile.file, interval_text(tile.tile));
    }
    place = tile.tile.to;
  }
  return place == HUGE_VAL ? ""
                           : fmt::format("a tile is missing: {}, the last one, has an end",
                                         interval_text(tiles.back().tile));
}

// Returns how the file differs from the list; empty if both are equal byte for byte.
std::string other_list(const std::string& path, std::string_view list) {
  const std::string text = read_file(path, kMaxCheckedBytes);
  if (text == list) return "";
  std::string_view given = text;
  for (std::uint64_t line = 1;; ++line) {
    const auto next = [](std::string_view& from) {
      const std::size_t end = std::min(from.find('\n'), from.size());
      const std::string_view out = from.substr(0, end);
      from.remove_prefix(std::min(end + 1, from.size()));
      return std::string(out);
    };
    const std::string is = next(given), should = next(list);
    if (is == should && !(given.empty() && list.empty())) continue;
    return fmt::format("{} is another list: line {} is '{}' and should be '{}'", clean_name(path),
                       line, clean_name(is), should);
  }
}

}  // namespace

int check_tiles(const CheckArguments& arguments, const std::vector<std::string>& files,
                bool whole) {
  const SceneSource source = scene_in_parts(arguments.scene, arguments.self);
  Census census = take_census(source, 0);
  require_nothing_ignored(names_of(census), "a check");
  std::vector<CheckedTile> tiles;
  std::vector<ListRow> rows;
  std::string hash_of_scene;
  Certificate::Unasked unasked;
  for (const std::string& file : files) {
    const Certificate certificate = read_certificate(file);
    if (!certificate.tile) {
      throw Error(clean_name(file), "is about a whole scene, and not about a tile",
                  "check it without --tiles");
    }
    census.clearance = certificate.clearance;
    const TileScene part = gather_tile(source, census, *certificate.tile);
    const WholeScene scene = whole_scene(census, *certificate.tile, part);
    hash_of_scene = part.hash;
    unasked = scene.not_asked;
    tiles.push_back({clean_name(file), *certificate.tile, certificate.clearance,
                     check_certificate(certificate, part.scene, &scene), ""});
    CheckedTile& tile = tiles.back();
    const PairListRows numbered_rows(part.scene, &part.numbers);
    for (const TrianglePair& pair : tile.result.meeting)
      rows.push_back(row_of(numbered_rows, pair));
    tile.result.meeting = {};
    if (tile.result.pair) {
      const auto [a, i, b, j] = row_of(numbered_rows, *tile.result.pair).first;
      tile.pair = fmt::format("object {} triangle {} and object {} triangle {}", a, i, b, j);
    }
  }
  std::ranges::sort(rows, {}, &ListRow::first);
  std::string list = pair_list_header(census.self_objects > 0);
  for (const ListRow& row : rows) list += row.second;
  Verdict verdict = Verdict::proved;
  std::string reason, table;
  Json each = Json::array();
  using Claims = Certificate::Claims;
  Claims sum;
  double ms = 0;
  for (const CheckedTile& tile : tiles) {
    const CheckResult& result = tile.result;
    const std::string why =
        result.reason + (tile.pair.empty() ? "" : fmt::format(": {}", tile.pair));
    table += fmt::format("tile       {}, {}: {}\n", tile.file, interval_text(tile.tile),
                         result.verdict == Verdict::proved
                             ? counted(result.found.meeting, "pair", "pairs")
                             : to_string(result.verdict) + ": " + why);
    each.push_back({{"certificate", tile.file},
                    {"tile", interval_text(tile.tile)},
                    {"verdict", to_string(result.verdict)},
                    {"reason", text_json(why)},
                    {"list", {{"found_sha256", text_json(result.list_sha256)}}},
                    {"found", claims_json(result.found)},
                    {"ms", result.ms}});
    for (const auto count : {&Claims::box_pairs, &Claims::kept, &Claims::culled, &Claims::separated,
                             &Claims::neighbours, &Claims::meeting})
      sum.*count += result.found.*count;
    ms += result.ms;
    if (result.verdict == Verdict::proved || verdict == Verdict::refuted) continue;
    if (verdict == Verdict::not_proved && result.verdict != Verdict::refuted) continue;
    verdict = result.verdict;
    reason = tile.file + ": " + why;
  }
  if (reason.empty() && whole) reason = not_whole(tiles);
  const int certified = reason.empty() ? kExitDone : kExitBroken;
  const std::string other = arguments.pairs.empty() ? "" : other_list(arguments.pairs, list);
  if (reason.empty()) reason = other;
  if (!reason.empty() && verdict == Verdict::proved) verdict = Verdict::not_proved;
  const std::string proves = (whole ? "" : "of the pairs that belong to the tile, ") +
                             proved_text(rows.size(), tiles.front().clearance) +
                             proved_limits(tiles.front().clearance, census.self_objects > 0, false);
  const std::string list_sha256 = sha256(list);
  const int status = verdict == Verdict::proved ? kExitDone : kExitBroken;
  if (arguments.json != "-") {
    SceneCheck last;
    last.result.unattested = tiles.back().result.unattested;
    std::string left;
    if (unasked.pairs > 0) {
      left = fmt::format("not asked  {} of triangles inside {} of {} (add --self)\n",
                         counted(unasked.pairs, "pair", "pairs"), grouped(unasked.objects),
                         counted(census.objects, "object", "objects"));
    }
    print(clean_lines(fmt::format(
        "{}: {}\n{}list       {} (SHA-256 of the pairs)\nboxes      {} decided\n{}{}"
        "time       {:.1f} ms without reading the scene\n",
        to_string(verdict), status == kExitDone ? proves : one_line(reason), table, list_sha256,
        counted(sum.box_pairs, "pair", "pairs"), left, unattested_text(last), ms)));
  }
  if (arguments.verified) {
    const auto words = [&](const TakeWord& take) {
      take(census.objects);
      for (const auto& [word, times] : census.sizes) {
        for (std::uint64_t k = 0; k < times; ++k) take(word);
      }
      source([&](Scene& part) { give_coordinates(part, take); });
    };
    check_again(arguments, files, words, certified);
  }
  if (!arguments.json.empty()) {
    // The keys are the same as in check_json(), which makes the record of one certificate.
    write_json({{"certificate", clean_name(arguments.certificate)},
                {"scene",
                 {{"name", census.name},
                  {"hash", hash_of_scene},
                  {"self_not_asked", {{"objects", unasked.objects}, {"pairs", unasked.pairs}}}}},
                {"clearance", tiles.front().clearance},
                {"verdict", to_string(verdict)},
                {"proves", json_if(status == kExitDone, proves)},
                {"reason", text_json(reason)},
                {"list",
                 {{"found_sha256", list_sha256},
                  {"given", text_json(clean_name(arguments.pairs))},
                  {"given_is_found", json_if(!arguments.pairs.empty(), other.empty())}}},
                {"found", claims_json(sum)},
                {"unattested", tiles.back().result.unattested},
                {"ms", ms},
                {"tiles", each}},
               arguments.json);
  }
  return status;
}

}  // namespace farcull
