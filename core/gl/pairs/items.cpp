// The scene on the device, and the triangles of it that meet a part of the window. Arrays that fit
// a storage block are mirrored; others are gathered piece by piece. Items are counted first; if
// they do not fit their buffers, these grow and the items are made again.
#include <algorithm>
#include <bit>
#include <cstring>

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

}  // namespace farcull
