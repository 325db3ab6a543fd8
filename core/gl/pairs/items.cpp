// The scene on the device, the triangles of it that meet a part of the window, and their lists.
// Arrays that fit a storage block are mirrored; others are gathered piece by piece. Items are
// counted first; if they do not fit their buffers, these grow and the items are made again.
#include <algorithm>
#include <bit>
#include <cstring>

#include "core/base/stopwatch.h"
#include "core/gl/pairs/finder.h"

namespace farcull {
namespace {

constexpr std::size_t kSentBytes = 3 * 16;  // of a triangle that is sent by itself
constexpr std::size_t kMirrorBlock = std::size_t{64} << 10;
// A first guess, so that few windows make their items twice: a whole item for each triangle and a
// record for one in eight, if that takes little of the memory.
constexpr std::size_t kGuessedRecords = 8, kGuessPart = 16;

}  // namespace

std::size_t DeviceScene::Mirror::update(std::span<const std::byte> data) {
  const bool lost = store.reserve(data.size(), data.size());
  const std::size_t known = lost ? 0 : std::min(sent.size(), data.size());
  sent.resize(data.size());
  std::size_t sent_bytes = 0;
  const auto send = [&](std::size_t begin, std::size_t end) {
    if (begin == end) return;
    std::memcpy(sent.data() + begin, data.data() + begin, end - begin);
    store.write(begin, data.data() + begin, end - begin);
    sent_bytes += end - begin;
  };
  std::size_t from = 0;  // the first byte of the blocks that changed up to here
  for (std::size_t at = 0; at < known; at += kMirrorBlock) {
    const std::size_t end = std::min(at + kMirrorBlock, known);
    if (std::memcmp(sent.data() + at, data.data() + at, end - at) != 0) continue;
    send(from, at);
    from = end;
  }
  send(from, data.size());
  return sent_bytes;
}

PairOwners DeviceScene::begin(const PairTask& t) {
  task_ = &t;
  sent_bytes_ = 0;
  object_words_.assign(8 * t.limits.size(), 0);
  std::uint32_t number = 0;
  bool self = false;
  for (std::size_t o = 0; o < t.limits.size(); ++o) {
    const PixelBox& b = t.limits[o];
    std::uint32_t* const out = &object_words_[8 * o];
    const float words[6] = {b.lo.x, b.lo.y, b.lo.z, b.hi.x, b.hi.y, b.hi.z};
    for (int k = 0; k < 6; ++k) out[k] = std::bit_cast<std::uint32_t>(words[k]);
    out[6] = number << 3 | (t.self[o] != 0 ? 2u : 0u);
    if (!(b.lo.x <= b.hi.x && b.lo.y <= b.hi.y && b.lo.z <= b.hi.z)) continue;
    ++number;
    self |= t.self[o] != 0;
  }
  PairOwners owners;
  const bool masked =
      std::any_of(t.self.begin(), t.self.end(), [](std::uint8_t s) { return s == 0; });
  owners.groups = masked && number > 1 ? 2 : 1;
  owners.same_group = owners.groups == 1 || number > 2 || self;
  owners.bits = static_cast<std::uint32_t>(std::bit_width(number - (number > 0)));

  const std::size_t block = device_.block();
  const auto as_bytes = [](const auto& span) { return std::as_bytes(std::span(span)); };
  gathered_ = t.vertices.size_bytes() > block || t.triangles.size_bytes() > block ||
              t.owners.size_bytes() > block || t.active.size_bytes() > block ||
              object_words_.size() * sizeof(std::uint32_t) > block;
  if (gathered_) return owners;
  send({as_bytes(t.vertices), as_bytes(t.triangles), as_bytes(t.owners), as_bytes(t.active),
        as_bytes(object_words_)});
  return owners;
}

void DeviceScene::send(const std::array<std::span<const std::byte>, 5>& data) {
  std::array<PairQueue::Sent, 5> sent;
  std::size_t bytes = 0;
  for (std::size_t k = 0; k < mirrors_.size(); ++k) {
    const std::size_t of_this = mirrors_[k].update(data[k]);
    bytes += of_this;
    sent[k] = {&mirrors_[k].store, of_this > 0 ? data[k] : std::span<const std::byte>()};
  }
  if (bytes > 0) device_.expect(sent);
  sent_bytes_ += bytes;
}

void DeviceScene::for_each_piece(const std::function<void(std::size_t, std::size_t)>& launch) {
  if (!gathered_) {
    launch(0, task_->active.size());
    return;
  }
  const std::size_t most = std::max<std::size_t>(device_.block() / kSentBytes, 1);
  std::vector<PixelVertex> corners;
  std::vector<std::array<std::uint32_t, 3>> numbers;
  std::vector<std::uint32_t> own, own_words;
  for (std::size_t begin = 0; begin < task_->active.size(); begin += most) {
    const std::size_t n = std::min(most, task_->active.size() - begin);
    corners.clear();
    numbers.clear();
    own.clear();
    own_words.clear();
    std::uint32_t last = 0;
    for (std::size_t k = 0; k < n; ++k) {
      const std::uint32_t t = task_->active[begin + k];
      const auto v = static_cast<std::uint32_t>(3 * k);
      for (const std::uint32_t c : task_->triangles[t]) corners.push_back(task_->vertices[c]);
      numbers.push_back({v, v + 1, v + 2});
      if (own.empty() || task_->owners[t] != last) {
        last = task_->owners[t];
        const auto words = object_words_.begin() + 8 * static_cast<std::ptrdiff_t>(last);
        own_words.insert(own_words.end(), words, words + 8);
      }
      own.push_back(static_cast<std::uint32_t>(own_words.size() / 8 - 1));
    }
    send({std::as_bytes(std::span(corners)), std::as_bytes(std::span(numbers)),
          std::as_bytes(std::span(own)), std::as_bytes(task_->active.subspan(begin, n)),
          std::as_bytes(std::span(own_words))});
    launch(begin, n);
  }
}

std::vector<PairBinding> DeviceScene::bindings(const GlStore& records, const GlStore& record_heads,
                                               std::initializer_list<PairBinding> more) const {
  std::vector<PairBinding> all;
  for (const Mirror& mirror : mirrors_)
    all.push_back({static_cast<GLuint>(all.size()), &mirror.store});
  all.push_back({5, &records});
  all.push_back({6, &record_heads});
  all.insert(all.end(), more.begin(), more.end());
  return all;
}

bool PairFinder::make_items() {
  if (room_ == nullptr) {
    if (!count_items()) return false;
  } else {
    wholes_ = room_->wholes;
    items_ = room_->items;
    large_count_ = room_->large;
    row_items_ = room_->row_items;
  }
  common_.items = static_cast<std::uint32_t>(items_);
  if (!memory_.take(wholes_ * kVec4) || !memory_.take(wholes_ * kWord) ||
      !memory_.take(items_ * kRecord) || !memory_.take(items_ * (kVec4 + 3 * kWord)))
    return false;
  if (room_ != nullptr) {
    const std::size_t records = items_ + room_->shown;
    if (records * kRecord > memory_.block || row_items_ >> 31 != 0) return false;
    reserve_items(wholes_, items_, records);
    launch_items(wholes_, items_);
  }
  shown_list_.reserve(wholes_ * kWord, memory_.block);
  return row_items_ >> 31 == 0 || memory_.last;
}

// Makes the items and reads how many they are; false: too many.
bool PairFinder::count_items() {
  for (GlStore* store : {&heads_, &records_, &record_heads_, &listed_flags_, &shown_list_, &rows_})
    store->reserve(kVec4, kVec4);
  const std::size_t guess = task_->active.size();
  if (guess * kVec4 <= std::min(memory_.left / kGuessPart, memory_.block))
    reserve_items(guess, guess / kGuessedRecords, guess / kGuessedRecords);
  for (int attempt = 0;; ++attempt) {
    const std::size_t whole_capacity = heads_.bytes() / kVec4;
    const std::size_t capacity =
        std::min({records_.bytes() / kRecord, record_heads_.bytes() / kVec4,
                  listed_flags_.bytes() / kWord, rows_.bytes() / kWord});
    device_.reset(kItemTotals);
    launch_items(whole_capacity, capacity);
    const PairTotalWords totals = device_.read("pair items");
    wholes_ = totals[kTotalWholes];
    items_ = totals[kTotalItems];
    large_count_ = totals[kTotalLarge];
    row_items_ = two_words(totals, kTotalRows);
    if (wholes_ <= whole_capacity && items_ <= capacity) return true;
    if (attempt > 0)
      throw_lost("pairs", "the same triangles were counted twice with different results");
    PartMemory trial = memory_;
    if (!trial.take(wholes_ * kVec4) || !trial.take(items_ * kRecord)) return false;
    reserve_items(wholes_, items_, items_);
  }
}

void PairFinder::reserve_items(std::size_t wholes, std::size_t items, std::size_t records) {
  heads_.reserve(wholes * kVec4, memory_.block);
  records_.reserve(records * kRecord, memory_.block);
  record_heads_.reserve(records * kVec4, memory_.block);
  listed_flags_.reserve(items * kWord, memory_.block);
  rows_.reserve(items * kWord, memory_.block);
}

void PairFinder::launch_items(std::size_t whole_capacity, std::size_t capacity) {
  PairUniforms u = common_;
  u.numbers[0] = large_pixels(task_->active.size());
  u.capacity = static_cast<std::uint32_t>(capacity);
  u.extra = {0, scene_.gathered(), static_cast<std::uint32_t>(whole_capacity), 0};
  scene_.for_each_piece([&](std::size_t first, std::size_t count) {
    u.extra[0] = static_cast<std::uint32_t>(first);
    device_.run(PairProgram::items, count, u,
                scene_.bindings(records_, record_heads_,
                                {{8, &heads_}, {9, &listed_flags_}, {10, &rows_}}));
  });
}

// The `shown` whole items that are listed become records.
bool PairFinder::make_records(std::size_t shown) {
  shown_ = shown;
  const std::size_t all = records();
  if (!memory_.take(shown_ * kRecord) || !memory_.take(shown_ * kVec4) ||
      all * kRecord > memory_.block) {
    return false;
  }
  device_.grow(records_, all * kRecord, items_ * kRecord);
  device_.grow(record_heads_, all * kVec4, items_ * kVec4);
  PairUniforms u = common_;
  u.extra[1] = scene_.gathered();
  scene_.for_each_piece([&](std::size_t first, std::size_t count) {
    u.extra[0] = static_cast<std::uint32_t>(first);
    u.extra[2] = static_cast<std::uint32_t>(count);
    device_.run(PairProgram::records, {shown_, kTotalListed}, u,
                scene_.bindings(records_, record_heads_, {{8, &heads_}, {9, &shown_list_}}));
  });
  return true;
}

// Lists are counted, their places are scanned, and they are filled in: three passes over the items.
// Crowded cells are cut in the same way, level by level.

namespace {

constexpr std::size_t kSubCells = kSubdivision * kSubdivision;
constexpr std::size_t kBins = std::size_t{1} << 20;  // the most that are wanted

}  // namespace

bool PairLevel::shape(std::size_t n, std::uint32_t groups, std::uint64_t expected,
                      PartMemory& memory) {
  cells = n;
  std::uint32_t slices = kSlices, shift = 0;
  const std::size_t most = std::min<std::uint64_t>({expected, kBins, memory.left / (8 * kWord)});
  while (slices > 1 && cells * groups * slices > most) {
    slices /= 2;
    ++shift;
  }
  bins = {groups * slices, shift, slices, groups - 1};
  // Lists of smaller cells have one more place for each parent (pair_cut.comp).
  const std::size_t wanted = (all_bins() + cells / kSubCells + 1) * kWord;
  if (!memory.take(wanted) || !memory.take(wanted)) return false;
  if (counts.reserve(wanted, memory.block)) dirty = true;
  if (dirty) counts.clear(counts.bytes());
  dirty = true;  // until all that is counted is filled in
  first.reserve(wanted, memory.block);
  for (GlStore* store : {&entries, &places}) store->reserve(kVec4, kVec4);
  return true;
}

bool PairLevel::fill(std::size_t n, PartMemory& memory) {
  listed = n;
  if (!memory.take(n * kEntry) || !memory.take(n * 2 * kWord)) return false;
  entries.reserve(n * kEntry, memory.block);
  places.reserve(n * 2 * kWord, memory.block);
  return true;
}

bool PairFinder::make_lists() {
  if (!count_entries()) return false;
  PairTotalWords totals{};
  if (room_ == nullptr) {
    PairUniforms u = common_;
    u.bins = levels_[0].bins;
    device_.run(PairProgram::crowded, part_.cells(), u, {{4, &levels_[0].first}});
    totals = device_.read("pair lists");
    if (overflow(totals)) return false;
  }
  const auto entries_of = [&](std::size_t l) -> std::size_t {
    return room_ != nullptr ? room_->entries[l] : totals[of_level(kTotalEntries, l)];
  };
  const auto crowded_of = [&](std::size_t l) -> std::size_t {
    if (room_ != nullptr) return l < room_->levels ? room_->crowded[l] : 0;
    return l < kMaxLevel ? totals[of_level(kTotalCrowded, l)] : 0;
  };
  if (!fill_lists(room_ != nullptr ? room_->shown : totals[kTotalListed], entries_of(0)))
    return false;
  for (std::size_t l = 0;; ++l) {
    const std::size_t crowded = crowded_of(l);
    if (!take_parents(l, crowded)) return false;
    check_cells(l);
    if (crowded == 0) return true;
    cut_cells(l);
    if (room_ == nullptr) {
      totals = device_.read("pair subdivision");
      check_lists(totals);
      if (totals[of_level(kTotalParents, l)] != crowded) {
        throw_lost("pairs", "crowded pixels were counted twice with different results",
                   kLostInvocation);
      }
      if (overflow(totals)) return false;
    }
    if (!fill_cut(l, entries_of(l + 1))) return false;
  }
}

// Counts the entries of the part's pixels, and gives their lists places; false: too much.
bool PairFinder::count_entries() {
  PairLevel& pixels = levels_[0];
  levels_cut_ = 0;
  common_.cells = static_cast<std::uint32_t>(part_.cells());
  rows_before_.reserve(std::max<std::size_t>(items_ * kWord, kVec4), memory_.block);
  if (row_items_ > 0) device_.scan(rows_, rows_before_, items_, kTotalItems, kTotalRowItems);
  const std::size_t mask_bytes =
      common_.masked ? part_.cells() * 8 * (1 + 2 * owners_.bits) : kVec4;
  if (!memory_.take(mask_bytes)) return false;
  masks_.reserve(mask_bytes, memory_.block);
  if (!pixels.shape(part_.cells(), owners_.groups, 2 * wholes_ + 8 * row_items_, memory_))
    return false;
  if (common_.masked) mark(mask_bytes);
  device_.stamp(PairStamp::marked);
  visit(PairProgram::count_wholes, PairProgram::count_rows, 0);
  device_.scan(pixels.counts, pixels.first, pixels.all_bins() + 1, kSerialStart, kTotalEntries);
  return true;
}

// Marks the slices that two owners touch in each pixel.
void PairFinder::mark(std::size_t mask_bytes) {
  const Stopwatch start;
  // If this command is lost, old slices still count as touched: more is listed, never less.
  masks_.clear(mask_bytes);
  visit(PairProgram::mark_wholes, PairProgram::mark_rows, 0);
  PairUniforms u = common_;
  u.extra[0] = owners_.bits;
  device_.run(PairProgram::conflicts, 2 * part_.cells(), u, {{2, &masks_}});
  counts_.mark_ms += start.ms();
}

bool PairFinder::fill_lists(std::size_t shown, std::size_t entries) {
  if (!make_records(shown) || !levels_[0].fill(entries, memory_)) return false;
  visit(PairProgram::fill_wholes, PairProgram::fill_rows, entries);
  return true;
}

// Runs one step of pair_lists.comp.
void PairFinder::visit(PairProgram wholes_program, PairProgram rows_program, std::size_t capacity) {
  PairUniforms u = common_;
  const PairLevel& pixels = levels_[0];
  const bool fill = wholes_program == PairProgram::fill_wholes;
  u.bins = pixels.bins;
  u.capacity = static_cast<std::uint32_t>(capacity);
  u.extra[0] = owners_.bits;
  for (const bool by_rows : {false, true}) {
    device_.run(by_rows ? rows_program : wholes_program,
                by_rows ? PairWork(row_items_, kTotalRowItems)
                        : (fill ? PairWork(shown_, kTotalListed) : PairWork(wholes_, kTotalWholes)),
                u,
                {{0, &records_},
                 {1, &rows_before_},
                 {2, &masks_},
                 {3, &pixels.counts},
                 {4, &pixels.first},
                 {6, by_rows || fill ? &record_heads_ : &heads_},
                 {8, by_rows ? &listed_flags_ : &shown_list_},
                 {9, &pixels.entries},
                 {10, &pixels.places}});
  }
}

// Memory for the cells of level l that are cut, and for the counts of the level below.
bool PairFinder::take_parents(std::size_t l, std::size_t crowded) {
  PairLevel& level = levels_[l];
  level.crowded = crowded;
  level.parents.reserve(kVec4, kVec4);
  if (crowded == 0) return true;
  if (!memory_.take(level.cells * kWord) || !memory_.take(crowded * kVec4)) return false;
  level.state.reserve(level.cells * kWord, memory_.block);
  level.parents.reserve(crowded * kVec4, memory_.block);
  return levels_[l + 1].shape(crowded * kSubCells, owners_.groups, level.listed, memory_);
}

// Runs one step of pair_cut.comp on level l.
void PairFinder::cut_step(PairProgram program, std::size_t l, const PairWork& work,
                          std::size_t capacity) {
  const PairLevel& level = levels_[l];
  const bool checks = program == PairProgram::parents;
  const PairLevel& below = checks ? level : levels_[l + 1];
  PairUniforms u = common_;
  u.bins = below.bins;
  u.capacity = static_cast<std::uint32_t>(capacity);
  u.extra = {static_cast<std::uint32_t>(l), level.bins[0], 0, 0};
  u.numbers[0] = 1;
  for (std::size_t k = 0; k <= l; ++k) u.numbers[0] /= kSubdivision;
  u.numbers[1] = 1 / u.numbers[0];
  device_.run(program, work, u,
              {{0, &records_},
               {1, l > 0 ? &levels_[l - 1].parents : &level.parents},
               {2, &level.parents},
               {3, &below.counts},
               {4, &below.first},
               {5, &level.entries},
               {6, &level.places},
               {8, level.crowded > 0 ? &level.state : &level.parents},
               {9, &below.entries},
               {10, &below.places}});
}

// Lets the device count bins that were not filled in as counted, and list the crowded cells.
void PairFinder::check_cells(std::size_t l) {
  cut_step(PairProgram::parents, l,
           l == 0 ? PairWork(levels_[0].cells)
                  : PairWork(levels_[l - 1].crowded, of_level(kTotalParents, l - 1), 1,
                             static_cast<std::uint32_t>(kSubCells)),
           levels_[l].crowded);
}

// Cuts the crowded cells of level l where that saves tests, and gives the smaller ones places.
void PairFinder::cut_cells(std::size_t l) {
  cut_step(PairProgram::cut_count, l, all_entries(l), 0);
  cut_step(PairProgram::cut_decide, l, {levels_[l].crowded, of_level(kTotalParents, l)}, 0);
  levels_cut_ = l + 1;
}

bool PairFinder::fill_cut(std::size_t l, std::size_t entries) {
  if (!levels_[l + 1].fill(entries, memory_)) return false;
  cut_step(PairProgram::cut_fill, l, all_entries(l), entries);
  return true;
}

}  // namespace farcull
