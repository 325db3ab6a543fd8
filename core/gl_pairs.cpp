#include "core/gl_pairs.h"

#include <algorithm>
#include <bit>
#include <chrono>
#include <stdexcept>
#include <utility>

#include "core/error.h"
#include "core/gl_pairs_device.h"
#include "core/pair_sort.h"

namespace farcull {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t kWord = sizeof(std::uint32_t);
constexpr std::size_t kVec4 = 16;
constexpr std::size_t kRecord = 5 * kVec4;
constexpr std::size_t kEntry = 2 * kVec4;
constexpr std::size_t kSubCells = kSubdivision * kSubdivision;
constexpr std::size_t kBins = std::size_t{1} << 20;         // that are wanted at most
constexpr std::uint64_t kEmitted = std::uint64_t{1} << 22;  // work items of one emission
constexpr std::size_t kLeastPairs = std::size_t{64} << 10;  // bytes for pairs
constexpr std::size_t kSentBytes = 3 * kVec4;               // of a triangle that is sent by itself

struct Tile {
  int i0, i1, j0, j1;  // pixels, inclusive
  int width() const { return i1 - i0 + 1; }
  int height() const { return j1 - j0 + 1; }
  std::size_t cells() const { return static_cast<std::size_t>(width()) * height(); }
};

// The memory of one part of the window.
struct Room {
  std::size_t left;
  std::size_t block;
  bool last;  // a single pixel, which is done whatever it takes

  // False: the part must be split. `bytes` of one buffer.
  bool take(std::size_t bytes) {
    if (bytes > block && last) {
      throw Error("GL pairs", "one pixel needs a buffer of " + std::to_string(bytes) + " bytes",
                  "use --device cpu or a larger --resolution");
    }
    if (last) return true;
    if (bytes > block || bytes > left) return false;
    left -= bytes;
    return true;
  }
};

// Lists of the cells of one level: pixels, then parts of crowded ones.
struct Level {
  PairStore counts, first, entries, places, state, parents;
  std::size_t cells = 0;
  std::size_t listed = 0;                         // entries
  std::array<std::uint32_t, 4> bins{1, 6, 1, 0};  // as u_bins
  bool dirty = false;                             // counts are not all 0

  std::size_t all_bins() const { return cells * bins[0]; }
  /// About as many bins as entries are `expected`, within the memory, and room for their counts.
  bool shape(std::size_t n, std::uint32_t groups, std::uint64_t expected, Room& room) {
    cells = n;
    std::uint32_t slices = kSlices, shift = 0;
    const std::size_t most = std::min<std::uint64_t>({expected, kBins, room.left / (8 * kWord)});
    while (slices > 1 && cells * groups * slices > most) {
      slices /= 2;
      ++shift;
    }
    bins = {groups * slices, shift, slices, groups - 1};
    const std::size_t wanted = (all_bins() + 1) * kWord;
    if (!room.take(wanted) || !room.take(wanted)) return false;
    if (counts.reserve(wanted, room.block)) dirty = true;
    if (dirty) {
      glBindBuffer(GL_SHADER_STORAGE_BUFFER, counts.name);
      glClearBufferData(GL_SHADER_STORAGE_BUFFER, GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT,
                        nullptr);
    }
    dirty = true;  // until all that is counted is filled in
    first.reserve(wanted, room.block);
    for (PairStore* store : {&entries, &places}) store->reserve(kVec4, kVec4);
    return true;
  }
  /// Room for n entries.
  bool fill(std::size_t n, Room& room) {
    listed = n;
    if (!room.take(n * kEntry) || !room.take(n * 2 * kWord)) return false;
    entries.reserve(n * kEntry, room.block);
    places.reserve(n * 2 * kWord, room.block);
    return true;
  }
};

std::uint64_t two_words(const std::array<std::uint32_t, kTotals>& totals, PairTotal low) {
  return std::uint64_t{totals[low]} | std::uint64_t{totals[low + 1]} << 32;
}

}  // namespace

struct GlPairs::State {
  const GlContext& context;
  GlPairOptions options;
  PairDevice device;
  PairMirror vertices, triangles, owners, active, objects;
  PairStore heads, records, record_heads, listed, shown, rows, rows_before, masks, large, pairs,
      units, units_before;
  std::array<Level, kMaxLevel + 1> levels;
  bool gathered = false;  // triangles are sent one by one, since an array is beyond a block
  std::size_t sent = 0;

  const PairTask* task = nullptr;
  PairUniforms common;                      // of the part
  std::uint32_t owner_bits = 0;             // of an owner's number
  std::uint32_t groups = 1;                 // of entries, by owner
  bool same_group = true;                   // entries of one group may collide
  std::vector<std::uint32_t> object_words;  // as in pair_source.glsl
  std::size_t wholes = 0, items = 0, large_ones = 0, shown_ones = 0;  // of the part
  std::uint64_t row_items = 0;
  std::vector<TrianglePair> found;
  PairCounts counts;

  State(const GlContext& c, const GlPairOptions& o) : context(c), options(o), device(c, o) {}

  void begin(const PairTask& t);
  void split(const Tile& tile);
  bool run(const Tile& tile);
  template <class Launch>
  void send(const Launch& launch);
  bool make_items(Room& room);
  bool lists(const Tile& tile, Room& room);
  void visit(PairProgram wholes_program, PairProgram rows_program, std::size_t capacity);
  bool make_records(Room& room);
  bool cut(std::size_t l, std::size_t crowded, Room& room, std::size_t& crowded_below);
  bool test(std::size_t l, bool some_cut, Room& room);
  void compare_large(const Room& room);
  template <class Launch>
  std::uint32_t emit(std::uint64_t count, const Room& room, const Launch& launch);
  void check(const std::array<std::uint32_t, kTotals>& totals) const;
  bool overflow(const std::array<std::uint32_t, kTotals>& totals, const Room& room) const;
};

// What all parts of the window share.
void GlPairs::State::begin(const PairTask& t) {
  task = &t;
  found.clear();
  counts = {};
  counts.bands = 0;
  sent = 0;
  device.start(true);
  common = {};
  common.widen = {t.widening.x, t.widening.y, t.widening.z, 0};
  common.window = {t.width, t.height};
  // As in PairGrid.
  common.depth = {t.near_px, kSlices / std::max(t.far_px - t.near_px, 0x1p-20f)};
  common.masked =
      std::any_of(t.self.begin(), t.self.end(), [](std::uint8_t self) { return self == 0; });

  object_words.assign(8 * t.limits.size(), 0);
  std::uint32_t number = 0;
  bool self = false;
  for (std::size_t o = 0; o < t.limits.size(); ++o) {
    const PixelBox& b = t.limits[o];
    std::uint32_t* const out = &object_words[8 * o];
    const float words[6] = {b.lo.x, b.lo.y, b.lo.z, b.hi.x, b.hi.y, b.hi.z};
    for (int k = 0; k < 6; ++k) out[k] = std::bit_cast<std::uint32_t>(words[k]);
    out[6] = number << 3 | (t.self[o] != 0 ? 2u : 0u);
    if (!(b.lo.x <= b.hi.x && b.lo.y <= b.hi.y && b.lo.z <= b.hi.z)) continue;
    ++number;
    self |= t.self[o] != 0;
  }
  groups = common.masked && number > 1 ? 2 : 1;
  same_group = groups == 1 || number > 2 || self;
  owner_bits = static_cast<std::uint32_t>(std::bit_width(number - (number > 0)));

  const std::size_t block = device.block();
  const auto as_bytes = [](const auto& span) { return std::as_bytes(std::span(span)); };
  gathered = t.vertices.size_bytes() > block || t.triangles.size_bytes() > block ||
             t.owners.size_bytes() > block || t.active.size_bytes() > block ||
             object_words.size() * kWord > block;
  if (gathered) return;
  sent += vertices.update(as_bytes(t.vertices));
  sent += triangles.update(as_bytes(t.triangles));
  sent += owners.update(as_bytes(t.owners));
  sent += active.update(as_bytes(t.active));
  sent += objects.update(as_bytes(object_words));
  check_gl("pairs upload");
}

void GlPairs::State::check(const std::array<std::uint32_t, kTotals>& totals) const {
  if (totals[kTotalMismatches] == 0) return;
  throw Error("GL pairs",
              std::to_string(totals[kTotalMismatches]) +
                  " lists were not filled with as many entries as were counted",
              "a compute invocation was lost: run again, or with another --device");
}

// Whether a sum went beyond 32 bits, so that the part must be split.
bool GlPairs::State::overflow(const std::array<std::uint32_t, kTotals>& totals,
                              const Room& room) const {
  if (totals[kTotalOverflow] == 0) return false;
  if (room.last) {
    throw Error("GL pairs", "one pixel has more work than can be counted in 32 bits",
                "use --device cpu or a larger --resolution");
  }
  return true;
}

// Calls launch(first, count) for the active triangles, all at once or as many as a block holds,
// when they are there.
template <class Launch>
void GlPairs::State::send(const Launch& launch) {
  if (!gathered) {
    launch(0, task->active.size());
    return;
  }
  const std::size_t most = std::max<std::size_t>(device.block() / kSentBytes, 1);
  std::vector<PixelVertex> corners;
  std::vector<std::array<std::uint32_t, 3>> numbers;
  std::vector<std::uint32_t> own, own_words;
  for (std::size_t begin = 0; begin < task->active.size(); begin += most) {
    const std::size_t n = std::min(most, task->active.size() - begin);
    corners.clear();
    numbers.clear();
    own.clear();
    own_words.clear();
    std::uint32_t last = 0;
    for (std::size_t k = 0; k < n; ++k) {
      const std::uint32_t t = task->active[begin + k];
      const auto v = static_cast<std::uint32_t>(3 * k);
      for (const std::uint32_t c : task->triangles[t]) corners.push_back(task->vertices[c]);
      numbers.push_back({v, v + 1, v + 2});
      if (own.empty() || task->owners[t] != last) {
        last = task->owners[t];
        const auto words = object_words.begin() + 8 * static_cast<std::ptrdiff_t>(last);
        own_words.insert(own_words.end(), words, words + 8);
      }
      own.push_back(static_cast<std::uint32_t>(own_words.size() / 8 - 1));
    }
    sent += vertices.update(std::as_bytes(std::span(corners)));
    sent += triangles.update(std::as_bytes(std::span(numbers)));
    sent += owners.update(std::as_bytes(std::span(own)));
    sent += active.update(std::as_bytes(task->active.subspan(begin, n)));
    sent += objects.update(std::as_bytes(std::span(own_words)));
    launch(begin, n);
  }
}

// The triangles that meet the part; false: too many.
bool GlPairs::State::make_items(Room& room) {
  PairUniforms u = common;
  u.extra[1] = gathered;
  u.numbers[0] = std::max<float>(kLargePixels, 0.125f * static_cast<float>(task->active.size()));
  for (PairStore* store : {&heads, &records, &record_heads, &listed, &shown}) {
    store->reserve(kVec4, kVec4);
  }
  for (;;) {
    const std::size_t whole_capacity = heads.bytes / kVec4;
    const std::size_t capacity =
        std::min({records.bytes / kRecord, record_heads.bytes / kVec4, listed.bytes / kWord});
    u.capacity = static_cast<std::uint32_t>(capacity);
    u.extra[2] = static_cast<std::uint32_t>(whole_capacity);
    device.reset(kTotalWholes, kTotalOverflow);
    send([&](std::size_t first, std::size_t count) {
      u.extra[0] = static_cast<std::uint32_t>(first);
      device.run(PairProgram::items, count, u,
                 {{0, vertices.name()},
                  {1, triangles.name()},
                  {2, owners.name()},
                  {3, active.name()},
                  {4, objects.name()},
                  {5, records.name},
                  {6, record_heads.name},
                  {8, heads.name},
                  {9, listed.name}});
    });
    const auto totals = device.read("pair items");
    wholes = totals[kTotalWholes];
    items = totals[kTotalItems];
    large_ones = totals[kTotalLarge];
    row_items = two_words(totals, kTotalRows);
    if (wholes <= whole_capacity && items <= capacity) break;
    Room trial = room;
    if (!trial.take(wholes * kVec4) || !trial.take(items * kRecord)) return false;
    heads.reserve(wholes * kVec4, room.block);
    records.reserve(items * kRecord, room.block);
    record_heads.reserve(items * kVec4, room.block);
    listed.reserve(items * kWord, room.block);
  }
  common.items = static_cast<std::uint32_t>(items);
  if (!room.take(wholes * kVec4) || !room.take(wholes * kWord) || !room.take(items * kRecord) ||
      !room.take(items * (kVec4 + 3 * kWord))) {
    return false;
  }
  shown.reserve(wholes * kWord, room.block);
  return row_items >> 31 == 0 || room.last;
}

// One step of pair_lists.comp.
void GlPairs::State::visit(PairProgram wholes_program, PairProgram rows_program,
                           std::size_t capacity) {
  PairUniforms u = common;
  const Level& pixels = levels[0];
  const bool fill = wholes_program == PairProgram::fill_wholes;
  u.bins = pixels.bins;
  u.capacity = static_cast<std::uint32_t>(capacity);
  u.extra[0] = owner_bits;
  for (const bool by_rows : {false, true}) {
    device.run(by_rows ? rows_program : wholes_program,
               by_rows ? row_items : (fill ? shown_ones : wholes), u,
               {{0, records.name},
                {1, rows_before.name},
                {2, masks.name},
                {3, pixels.counts.name},
                {4, pixels.first.name},
                {6, by_rows || fill ? record_heads.name : heads.name},
                {8, by_rows ? listed.name : shown.name},
                {9, pixels.entries.name},
                {10, pixels.places.name}});
  }
}

// The whole items that are listed become records; false: too many.
bool GlPairs::State::make_records(Room& room) {
  if (shown_ones == 0) return true;
  const std::size_t all = items + shown_ones;
  if (!room.take(shown_ones * kRecord) || !room.take(shown_ones * kVec4) ||
      all * kRecord > room.block) {
    return false;
  }
  records.reserve(all * kRecord, room.block, items * kRecord);
  record_heads.reserve(all * kVec4, room.block, items * kVec4);
  PairUniforms u = common;
  u.extra[1] = gathered;
  send([&](std::size_t first, std::size_t count) {
    u.extra[0] = static_cast<std::uint32_t>(first);
    u.extra[2] = static_cast<std::uint32_t>(count);
    device.run(PairProgram::records, shown_ones, u,
               {{0, vertices.name()},
                {1, triangles.name()},
                {2, owners.name()},
                {3, active.name()},
                {4, objects.name()},
                {5, records.name},
                {6, record_heads.name},
                {8, heads.name},
                {9, shown.name}});
  });
  return true;
}

// Runs launch(first, count) over work items that append pairs, in as many parts as the memory for
// pairs asks for, and takes the pairs; the sum of kTotalMore.
template <class Launch>
std::uint32_t GlPairs::State::emit(std::uint64_t count, const Room& room, const Launch& launch) {
  const std::size_t most = std::max(std::min(options.memory / 4, room.block), kLeastPairs);
  std::uint32_t more = 0;
  std::uint64_t size = std::min(count, kEmitted);
  for (std::uint64_t first = 0; first < count;) {
    const std::uint64_t n = std::min(size, count - first);
    pairs.reserve(kLeastPairs, most);
    const std::size_t capacity = std::min(pairs.bytes, most) / sizeof(TrianglePair);
    device.reset(kTotalPairs, 4);
    launch(first, n, static_cast<std::uint32_t>(capacity));
    const auto totals = device.read("pairs");
    check(totals);
    const std::size_t emitted = totals[kTotalPairs];
    if (emitted > capacity) {
      if (emitted * sizeof(TrianglePair) <= most) {
        pairs.reserve(emitted * sizeof(TrianglePair), most);
      } else {
        size = std::max<std::uint64_t>(n / 2, 1);
      }
      continue;
    }
    const std::size_t before = found.size();
    found.resize(before + emitted);
    if (emitted > 0) {
      glBindBuffer(GL_SHADER_STORAGE_BUFFER, pairs.name);
      glGetBufferSubData(GL_SHADER_STORAGE_BUFFER, 0,
                         static_cast<GLsizeiptr>(emitted * sizeof(TrianglePair)),
                         found.data() + before);
    }
    counts.tests += two_words(totals, kTotalTests);
    more += totals[kTotalMore];
    first += n;
  }
  return more;
}

// The lists of the part's pixels; false: too much.
bool GlPairs::State::lists(const Tile& tile, Room& room) {
  Level& pixels = levels[0];
  common.cells = static_cast<std::uint32_t>(tile.cells());
  rows_before.reserve(std::max<std::size_t>(items * kWord, kVec4), room.block);
  if (row_items > 0) {
    rows.reserve(items * kWord, room.block);
    device.run(PairProgram::spans, items, common, {{3, rows.name}, {6, record_heads.name}});
    device.scan(rows.name, rows_before.name, items);
  }
  const std::size_t mask_bytes = common.masked ? tile.cells() * 8 * (1 + 2 * owner_bits) : kVec4;
  if (!room.take(mask_bytes)) return false;
  masks.reserve(mask_bytes, room.block);
  if (!pixels.shape(tile.cells(), groups, wholes + 4 * row_items, room)) return false;
  if (common.masked) {
    const auto start = Clock::now();
    glBindBuffer(GL_SHADER_STORAGE_BUFFER, masks.name);
    glClearBufferSubData(GL_SHADER_STORAGE_BUFFER, GL_R32UI, 0, static_cast<GLsizeiptr>(mask_bytes),
                         GL_RED_INTEGER, GL_UNSIGNED_INT, nullptr);
    visit(PairProgram::mark_wholes, PairProgram::mark_rows, 0);
    PairUniforms u = common;
    u.extra[0] = owner_bits;
    device.run(PairProgram::conflicts, 2 * tile.cells(), u, {{2, masks.name}});
    counts.mark_ms += std::chrono::duration<double, std::milli>(Clock::now() - start).count();
  }
  visit(PairProgram::count_wholes, PairProgram::count_rows, 0);
  if (device.fault == PairFault::corrupted_count) {
    const std::size_t at = device.fault_at % pixels.all_bins() * kWord;
    std::uint32_t count = 0;
    glBindBuffer(GL_SHADER_STORAGE_BUFFER, pixels.counts.name);
    glGetBufferSubData(GL_SHADER_STORAGE_BUFFER, static_cast<GLintptr>(at), kWord, &count);
    ++count;
    glBufferSubData(GL_SHADER_STORAGE_BUFFER, static_cast<GLintptr>(at), kWord, &count);
    device.fault = PairFault::none;
  }
  device.scan(pixels.counts.name, pixels.first.name, pixels.all_bins() + 1);
  PairUniforms u = common;
  u.bins = pixels.bins;
  device.run(PairProgram::crowded, tile.cells(), u,
             {{3, pixels.counts.name}, {4, pixels.first.name}});
  const auto totals = device.read("pair lists");
  if (overflow(totals, room)) return false;
  shown_ones = totals[kTotalListed];
  counts.crowded += totals[kTotalCrowded];
  if (!make_records(room) || !pixels.fill(totals[kTotalScanned], room)) return false;
  visit(PairProgram::fill_wholes, PairProgram::fill_rows, pixels.listed);
  device.run(PairProgram::filled, pixels.all_bins(), u,
             {{3, pixels.counts.name}, {4, pixels.first.name}});
  counts.listed += totals[kTotalListed] + totals[kTotalListedRows];
  return true;
}

// Cuts the crowded cells of level l into those of the next; false: too much.
bool GlPairs::State::cut(std::size_t l, std::size_t crowded, Room& room,
                         std::size_t& crowded_below) {
  Level& level = levels[l];
  Level& below = levels[l + 1];
  if (!room.take(level.cells * kWord) || !room.take(crowded * kVec4)) return false;
  level.state.reserve(level.cells * kWord, room.block);
  level.parents.reserve(crowded * kVec4, room.block);
  if (!below.shape(crowded * kSubCells, groups, level.listed, room)) return false;

  PairUniforms u = common;
  u.bins = below.bins;
  u.capacity = static_cast<std::uint32_t>(crowded);
  u.extra = {static_cast<std::uint32_t>(l), level.bins[0], 0, 0};
  u.numbers[0] = 1;
  for (std::size_t k = 0; k <= l; ++k) u.numbers[0] /= kSubdivision;
  const auto step = [&](PairProgram program, std::size_t n) {
    device.run(program, n, u,
               {{0, records.name},
                {1, l > 0 ? levels[l - 1].parents.name : level.parents.name},
                {2, level.parents.name},
                {3, below.counts.name},
                {4, program == PairProgram::parents ? level.first.name : below.first.name},
                {5, level.entries.name},
                {6, level.places.name},
                {8, level.state.name},
                {9, below.entries.name},
                {10, below.places.name}});
  };
  device.reset(kTotalCrowded, 1);
  device.reset(kTotalParents, 1);
  step(PairProgram::parents, level.cells);
  step(PairProgram::cut_count, level.listed);
  step(PairProgram::cut_decide, crowded);
  device.scan(below.counts.name, below.first.name, below.all_bins() + 1);
  device.run(PairProgram::crowded, below.cells, u, {{3, below.counts.name}, {4, below.first.name}});
  const auto totals = device.read("pair subdivision");
  if (totals[kTotalParents] != crowded) {
    throw Error("GL pairs", "crowded pixels were counted twice with different results",
                "a compute invocation was lost: run again, or with another --device");
  }
  if (overflow(totals, room)) return false;
  crowded_below = totals[kTotalCrowded];
  if (!below.fill(totals[kTotalScanned], room)) return false;
  u.capacity = static_cast<std::uint32_t>(below.listed);
  if (below.listed > 0) step(PairProgram::cut_fill, level.listed);
  device.run(PairProgram::filled, below.all_bins(), u,
             {{3, below.counts.name}, {4, below.first.name}});
  return true;
}

// The tests of a level's cells that are not cut; false: too many.
bool GlPairs::State::test(std::size_t l, bool some_cut, Room& room) {
  Level& level = levels[l];
  if (level.listed == 0) return true;
  if (!room.take(level.listed * kWord) || !room.take(level.listed * kWord)) return false;
  units.reserve(level.listed * kWord, room.block);
  PairUniforms u = common;
  u.bins = level.bins;
  u.extra = {l == 0, same_group, static_cast<std::uint32_t>(level.listed), 0};
  const auto launch = [&](PairProgram program, GLuint unit_buffer) {
    return [&, program, unit_buffer](std::uint64_t first, std::uint64_t n, std::uint32_t capacity) {
      u.capacity = capacity;
      u.extra[3] = static_cast<std::uint32_t>(first);
      device.run(program, n, u,
                 {{2, pairs.name},
                  {3, unit_buffer},
                  {4, level.first.name},
                  {8, some_cut ? level.state.name : level.first.name},
                  {9, level.entries.name},
                  {10, level.places.name}});
    };
  };
  const std::uint32_t more =
      emit(level.listed, room,
           launch(some_cut ? PairProgram::uncut_tests : PairProgram::tests, units.name));
  if (more == 0) return true;
  units_before.reserve(level.listed * kWord, room.block);
  device.scan(units.name, units_before.name, level.listed);
  const auto totals = device.read("pair tests");
  if (overflow(totals, room)) return false;
  emit(totals[kTotalScanned], room,
       launch(some_cut ? PairProgram::more_uncut_tests : PairProgram::more_tests,
              units_before.name));
  return true;
}

void GlPairs::State::compare_large(const Room& room) {
  if (large_ones == 0) return;
  large.reserve(large_ones * kWord, room.block);
  PairUniforms u = common;
  u.capacity = static_cast<std::uint32_t>(large_ones);
  device.reset(kTotalParents, 1);
  device.run(PairProgram::find_large, items, u,
             {{5, records.name}, {6, record_heads.name}, {8, large.name}});
  u.extra = {0, gathered, 0, static_cast<std::uint32_t>(large_ones)};
  send([&](std::size_t, std::size_t sent_ones) {
    for (std::size_t first = 0; first < large_ones; first += kLargeBatch) {
      u.extra[2] = static_cast<std::uint32_t>(first);
      emit(sent_ones, room, [&](std::uint64_t begin, std::uint64_t count, std::uint32_t capacity) {
        u.items = static_cast<std::uint32_t>(begin);
        u.capacity = capacity;
        device.run(PairProgram::large, count, u,
                   {{0, vertices.name()},
                    {1, triangles.name()},
                    {2, owners.name()},
                    {3, active.name()},
                    {4, objects.name()},
                    {5, records.name},
                    {6, record_heads.name},
                    {8, large.name},
                    {9, pairs.name}});
      });
    }
  });
}

// One part of the window; false: too much for the memory.
bool GlPairs::State::run(const Tile& tile) {
  Room room{options.memory, device.block(), tile.cells() == 1};
  // What every pixel needs, before any work is done.
  const std::size_t fixed =
      tile.cells() * (2 * groups * kWord + (common.masked ? 8 + 16 * owner_bits : 0));
  if (!room.last && (fixed > room.left / 2 || fixed > room.block)) return false;

  const auto start = Clock::now();
  const auto since = [](Clock::time_point from) {
    return std::chrono::duration<double, std::milli>(Clock::now() - from).count();
  };
  device.start(false);
  common.tile = {tile.i0, tile.i1, tile.j0, tile.j1};
  if (!make_items(room)) return false;
  counts.mark_ms += since(start);
  if (wholes + items == 0) return true;

  const double marked = counts.mark_ms;
  const auto listing = Clock::now();
  if (!lists(tile, room)) return false;
  counts.list_ms += since(listing) - (counts.mark_ms - marked);

  const auto pairing = Clock::now();
  std::size_t crowded = counts.crowded;
  for (std::size_t l = 0;; ++l) {
    std::size_t crowded_below = 0;
    const bool some_cut = crowded > 0 && l < kMaxLevel;
    if (some_cut && !cut(l, crowded, room, crowded_below)) return false;
    if (!test(l, some_cut, room)) return false;
    counts.entries += levels[l].listed;
    if (!some_cut) break;
    crowded = crowded_below;
  }
  compare_large(room);
  check(device.read("pairs"));
  for (Level& level : levels) level.dirty = false;
  counts.large = std::max<std::uint64_t>(counts.large, large_ones);
  counts.pair_ms += since(pairing);
  return true;
}

void GlPairs::State::split(const Tile& tile) {
  const PairCounts before = counts;
  counts.crowded = 0;
  if (run(tile)) {
    counts.crowded += before.crowded;
    ++counts.bands;
    return;
  }
  counts = before;
  for (Level& level : levels) level.dirty = true;
  Tile low = tile, high = tile;
  if (tile.height() > 1) {
    low.j1 = tile.j0 + tile.height() / 2 - 1;
    high.j0 = low.j1 + 1;
  } else {
    low.i1 = tile.i0 + tile.width() / 2 - 1;
    high.i0 = low.i1 + 1;
  }
  split(low);
  split(high);
}

GlPairs::GlPairs(const GlContext& context, const GlPairOptions& options)
    : state_(std::make_unique<State>(context, options)) {}

GlPairs::~GlPairs() = default;

std::string GlPairs::name() const { return state_->context.info().renderer; }

std::vector<TrianglePair> GlPairs::raw_pairs(const PairTask& task, PairCounts& counts) {
  State& s = *state_;
  if (task.width < 1 || task.height < 1 || task.width > 65536 || task.height > 65536) {
    throw std::logic_error("GlPairs: a window of no pixels, or of more than 65536 along a side");
  }
  try {
    const auto start = Clock::now();
    s.begin(task);
    s.counts.mark_ms = std::chrono::duration<double, std::milli>(Clock::now() - start).count();
    if (!task.active.empty()) s.split({0, task.width - 1, 0, task.height - 1});
  } catch (...) {
    for (Level& level : s.levels) level.dirty = true;
    s.device.fault = PairFault::none;
    while (glGetError() != GL_NO_ERROR) {
    }
    throw;
  }
  s.device.fault = PairFault::none;
  counts = s.counts;
  return sorted_unique(std::span(&s.found, 1), 0);
}

void GlPairs::inject(PairFault fault, std::size_t at) {
  state_->device.fault = fault;
  state_->device.fault_at = at;
}

std::size_t GlPairs::dispatches() const { return state_->device.dispatches; }
std::size_t GlPairs::uploaded_bytes() const { return state_->sent; }

std::unique_ptr<PairBackend> gl_pair_backend(const GlContext& context, std::size_t memory) {
  return std::make_unique<GlPairs>(context, GlPairOptions{.memory = memory});
}

}  // namespace farcull
