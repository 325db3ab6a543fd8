// Arrays that fit a storage block are mirrored; others are gathered piece by piece.
#include "core/gl/pairs_scene.h"

#include <algorithm>
#include <array>
#include <bit>

namespace farcull {
namespace {

constexpr std::size_t kSentBytes = 3 * 16;  // of a triangle that is sent by itself

}  // namespace

PairOwners PairSceneStores::begin(const PairTask& t) {
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

void PairSceneStores::send(const std::array<std::span<const std::byte>, 5>& data) {
  const std::array<PairMirror*, 5> mirrors = {&vertices_, &triangles_, &owners_, &active_,
                                              &objects_};
  std::array<PairQueue::Sent, 5> sent;
  std::size_t bytes = 0;
  for (std::size_t k = 0; k < mirrors.size(); ++k) {
    const std::size_t of_this = mirrors[k]->update(data[k]);
    bytes += of_this;
    sent[k] = {&mirrors[k]->store(), of_this > 0 ? data[k] : std::span<const std::byte>()};
  }
  if (bytes > 0) device_.expect(sent);
  sent_bytes_ += bytes;
}

void PairSceneStores::for_each_piece(const std::function<void(std::size_t, std::size_t)>& launch) {
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

std::vector<PairBinding> PairSceneStores::bindings(const GlStore& records,
                                                   const GlStore& record_heads,
                                                   std::initializer_list<PairBinding> more) const {
  std::vector<PairBinding> all = {{0, &vertices_.store()}, {1, &triangles_.store()},
                                  {2, &owners_.store()},   {3, &active_.store()},
                                  {4, &objects_.store()},  {5, &records},
                                  {6, &record_heads}};
  all.insert(all.end(), more.begin(), more.end());
  return all;
}

}  // namespace farcull
