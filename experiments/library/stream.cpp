// The stream: candidates in order, some at a time, each decided exactly as it comes.
#include <algorithm>
#include <optional>
#include <thread>
#include <utility>

#include "core/boxes/join.h"
#include "experiments/library/answers.h"
#include "experiments/library/farcull.h"
#include "experiments/library/input.h"
#include "experiments/method/run.h"

namespace farcull {
namespace {

constexpr const char* kName = "ColliderStream";
constexpr std::size_t kPart = std::size_t{1} << 16;  // candidates at a time

}  // namespace

struct ColliderStream::State {
  ColliderOptions options;
  unsigned threads;
  Scene scene;
  std::optional<OrderedPairs> candidates;
  std::vector<TrianglePair> part;
  std::uint64_t decided = 0, given = 0;
  bool complete = false;
  bool failed = false;  // a call began and did not end: what it found is lost
  std::atomic_flag used;

  State(const ColliderInput& input, const ColliderOptions& of)
      : options(of), threads(of.threads > 0 ? of.threads : std::thread::hardware_concurrency()) {
    check(options);
    if (options.device == ColliderDevice::gl)
      throw Error("device", "gl is not used by a stream", "give cpu or best");
    take(input, options.self, options.self_objects, scene);
    candidates.emplace(scene, options.clearance, ignored_of(options, scene.objects.size()),
                       threads);
  }

  bool next(std::vector<ColliderFound>& pairs);
  void decide_part(std::vector<ColliderFound>& pairs);
};

bool ColliderStream::State::next(std::vector<ColliderFound>& pairs) {
  pairs.clear();
  if (!failed && options.limit > 0 && given == options.limit) return false;
  if (!failed && candidates->at_end()) {
    complete = true;
    return false;
  }
  if (std::exchange(failed, true))
    throw Error("stream", "an earlier call failed, and its pairs are lost", "make a new stream");
  decide_part(pairs);
  failed = false;
  return true;
}

void ColliderStream::State::decide_part(std::vector<ColliderFound>& pairs) {
  candidates->next(kPart, part);
  const ExactQuestion question{
      .clearance = options.clearance, .threads = threads, .neighbours = options.neighbours};
  const std::uint64_t limit = part.empty() || options.limit == 0 ? 0 : options.limit - given;
  const auto [found, count, whole] = decide(scene, part, question, limit, nullptr);
  decided += count;
  if (limit > 0) complete = whole && candidates->at_end();
  const auto append = [&](const std::vector<TrianglePair>& those, bool neighbours) {
    const std::vector<ContactShape> contacts =
        contacts_of(scene, those, detail_of(options.contacts), threads);
    for (std::size_t k = 0; k < those.size(); ++k) {
      pairs.push_back({.pair = {those[k].a, those[k].b},
                       .neighbours = neighbours,
                       .contact = contacts.empty() ? ColliderContact() : given_out(contacts[k])});
    }
  };
  append(found.pairs, false);
  append(found.neighbour_pairs, true);
  std::ranges::sort(pairs, {}, &ColliderFound::pair);
  given += pairs.size();
}

ColliderStream::ColliderStream(const ColliderInput& input, const ColliderOptions& options)
    : state_(translated([&] { return std::make_unique<State>(input, options); })) {}
ColliderStream::~ColliderStream() = default;
ColliderStream::ColliderStream(ColliderStream&&) noexcept = default;
ColliderStream& ColliderStream::operator=(ColliderStream&&) noexcept = default;

bool ColliderStream::next(std::vector<ColliderFound>& pairs) {
  return exclusive(state_, kName, [&](State& state) { return state.next(pairs); });
}

std::uint64_t ColliderStream::decided() const {
  return exclusive(state_, kName, [](const State& state) { return state.decided; });
}

bool ColliderStream::complete() const {
  return exclusive(state_, kName, [](const State& state) { return state.complete; });
}

}  // namespace farcull
