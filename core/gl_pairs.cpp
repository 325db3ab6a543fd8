#include "core/gl_pairs.h"

#include <algorithm>
#include <bit>
#include <chrono>
#include <stdexcept>

#include "core/error.h"
#include "core/gl_pairs_parts.h"
#include "core/pair_sort.h"

namespace farcull {
namespace {

using Clock = std::chrono::steady_clock;

// Pairs that are held although they may repeat: this part of the memory, or so many, or as many as
// are distinct.
constexpr std::size_t kBufferPart = 8;
constexpr std::size_t kLeastBuffer = 4096;

constexpr std::size_t kSentBytes = 3 * kVec4;  // of a triangle that is sent by itself

}  // namespace

bool PairRoom::take(std::size_t bytes) {
  if (bytes > block && last) {
    throw Error("GL pairs", "one pixel needs a buffer of " + std::to_string(bytes) + " bytes",
                "use --device cpu or a larger --resolution");
  }
  if (last) return true;
  if (bytes > block || bytes > left) return false;
  left -= bytes;
  return true;
}

// What all parts of the window share.
void GlPairs::State::begin(const PairTask& t) {
  task = &t;
  // An emission, up to a quarter of the memory, may come on top of it.
  found.emplace(1, std::max(options.memory / kBufferPart / sizeof(TrianglePair), kLeastBuffer));
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
  send(vertices, as_bytes(t.vertices));
  send(triangles, as_bytes(t.triangles));
  send(owners, as_bytes(t.owners));
  send(active, as_bytes(t.active));
  send(objects, as_bytes(object_words));
  if (sent > 0) device.read("pairs upload");
}

// Brings a buffer up to date; what it then holds is compared with the data when totals are read.
void GlPairs::State::send(PairMirror& mirror, std::span<const std::byte> data) {
  const std::size_t bytes = mirror.update(data);
  if (bytes > 0) device.expect(mirror.store(), data);
  sent += bytes;
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
                              const PairRoom& room) const {
  if (totals[kTotalOverflow] == 0) return false;
  if (room.last) {
    throw Error("GL pairs", "one pixel has more work than can be counted in 32 bits",
                "use --device cpu or a larger --resolution");
  }
  return true;
}

// Calls launch(first, count) for the active triangles, all at once or as many as a block holds,
// when they are there.
void GlPairs::State::send(const std::function<void(std::size_t, std::size_t)>& launch) {
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
    send(vertices, std::as_bytes(std::span(corners)));
    send(triangles, std::as_bytes(std::span(numbers)));
    send(owners, std::as_bytes(std::span(own)));
    send(active, std::as_bytes(task->active.subspan(begin, n)));
    send(objects, std::as_bytes(std::span(own_words)));
    launch(begin, n);
  }
}

// The triangles that meet the part; false: too many.
bool GlPairs::State::make_items(PairRoom& room) {
  PairUniforms u = common;
  u.extra[1] = gathered;
  u.numbers[0] = std::max<float>(kLargePixels, 0.125f * static_cast<float>(task->active.size()));
  for (GlStore* store : {&heads, &records, &record_heads, &listed, &shown}) {
    store->reserve(kVec4, kVec4);
  }
  for (int attempt = 0;; ++attempt) {
    const std::size_t whole_capacity = heads.bytes() / kVec4;
    const std::size_t capacity =
        std::min({records.bytes() / kRecord, record_heads.bytes() / kVec4, listed.bytes() / kWord});
    u.capacity = static_cast<std::uint32_t>(capacity);
    u.extra[2] = static_cast<std::uint32_t>(whole_capacity);
    device.reset(kItemTotals);
    send([&](std::size_t first, std::size_t count) {
      u.extra[0] = static_cast<std::uint32_t>(first);
      device.run(PairProgram::items, count, u, with_scene({{8, &heads}, {9, &listed}}));
    });
    const auto totals = device.read("pair items");
    wholes = totals[kTotalWholes];
    items = totals[kTotalItems];
    large_ones = totals[kTotalLarge];
    row_items = two_words(totals, kTotalRows);
    if (wholes <= whole_capacity && items <= capacity) break;
    if (attempt > 0) {
      throw Error("GL pairs", "the same triangles were counted twice with different results",
                  "a command was lost: run again, or with another --device");
    }
    PairRoom trial = room;
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

// One part of the window; false: too much for the memory.
bool GlPairs::State::run(const PairPart& tile) {
  PairRoom room{options.memory, device.block(), tile.cells() == 1};
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
  settle(room);
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
  for (PairLevel& level : levels) level.dirty = false;
  counts.large = std::max<std::uint64_t>(counts.large, large_ones);
  counts.pair_ms += since(pairing);
  return true;
}

void GlPairs::State::split(const PairPart& tile) {
  const PairCounts before = counts;
  counts.crowded = 0;
  if (run(tile)) {
    counts.crowded += before.crowded;
    ++counts.bands;
    return;
  }
  // What was sent to be used by the part is believed by the next ones, so it is checked first.
  device.read("pairs");
  counts = before;
  for (PairLevel& level : levels) level.dirty = true;
  PairPart low = tile, high = tile;
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
    : context_(context), options_(options) {
  const GlCurrent current(context);
  state_ = std::make_unique<State>(context, options);
}

GlPairs::~GlPairs() { forget(); }

// Everything on the device is deleted, or where the context cannot be had, left to go with it.
void GlPairs::forget() {
  try {
    const GlCurrent current(context_);
    state_.reset();
    // What the flags say concerns nobody any more. A lost context may report errors without end.
    for (int i = 0; i < 16 && glGetError() != GL_NO_ERROR; ++i) {
    }
  } catch (const Error&) {
    static_cast<void>(state_.release());
  }
}

std::string GlPairs::name() const { return context_.info().renderer; }

std::vector<TrianglePair> GlPairs::raw_pairs(const PairTask& task, PairCounts& counts) {
  if (task.width < 1 || task.height < 1 || task.width > 65536 || task.height > 65536) {
    throw std::logic_error("GlPairs: a window of no pixels, or of more than 65536 along a side");
  }
  const GlCurrent current(context_);
  try {
    if (!state_) state_ = std::make_unique<State>(context_, options_);
    State& s = *state_;
    const auto start = Clock::now();
    s.begin(task);
    s.counts.mark_ms = std::chrono::duration<double, std::milli>(Clock::now() - start).count();
    if (!task.active.empty()) s.split({0, task.width - 1, 0, task.height - 1});
    s.device.fault = PairFault::none;
    counts = s.counts;
    std::vector<TrianglePair> pairs = s.found->take(0);
    s.found.reset();
    return pairs;
  } catch (...) {
    // After a failure nothing that lies on the device is believed.
    forget();
    throw;
  }
}

void GlPairs::inject(PairFault fault, std::size_t at) {
  if (!state_) {
    const GlCurrent current(context_);
    state_ = std::make_unique<State>(context_, options_);
  }
  state_->device.fault = fault;
  state_->device.fault_at = at;
}

std::size_t GlPairs::dispatches() const { return state_ ? state_->device.dispatches : 0; }
std::size_t GlPairs::uploaded_bytes() const { return state_ ? state_->sent : 0; }

std::unique_ptr<PairBackend> gl_pair_backend(const GlContext& context, std::size_t memory) {
  return std::make_unique<GlPairs>(context, GlPairOptions{.memory = memory});
}

}  // namespace farcull
