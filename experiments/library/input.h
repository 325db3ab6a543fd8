// Converts and checks the input, the options and the answers of the library's functions.
#pragma once

#include <atomic>
#include <chrono>
#include <mutex>

#include "core/base/floating_point.h"
#include "core/base/parallel.h"
#include "core/base/stage.h"
#include "core/boxes/rigid.h"
#include "experiments/library/farcull.h"
#include "experiments/method/options.h"
#include "experiments/record/stage_words.h"
#include "verify/contact.h"

namespace farcull {

/// True if two enumerators have the same value, so that a cast converts the first to the second.
template <class Given, class Own>
constexpr bool same(Given given, Own own) {
  return static_cast<int>(given) == static_cast<int>(own);
}

/// Runs the call in the floating-point environment that the proofs assume. Then restores the
/// caller's environment.
template <class Call>
auto as_proved(const Call& call) {
  const FloatingPointGuard guard;
  return call();
}

/// Runs call(progress) in another thread, and calls may_go_on as described at MayGoOn in farcull.h.
template <class Call>
auto watched(const MayGoOn& may_go_on, const Call& call) {
  if (!may_go_on) return call(Progress());
  constexpr std::chrono::milliseconds kBetween{50};
  std::mutex mutex;
  std::string step;  // guarded by the mutex
  std::optional<decltype(call(Progress()))> out;
  StoppableCall running([&] {
    out.emplace(call([&](const ProgressStep& next) {
      stop_point();
      const std::lock_guard lock(mutex);
      step = text_of(next);
    }));
  });
  try {
    do {
      const std::string now = [&] {
        const std::lock_guard lock(mutex);
        return step;
      }();
      if (!may_go_on(now)) throw Cancelled();
    } while (!running.wait_for(kBetween));
  } catch (...) {
    running.stop();  // the destructor of `running` waits for the end
    throw;
  }
  running.finish();
  return std::move(*out);
}

/// Runs the call, which uses the state of a Collider or DistanceFinder. The flag State::used is set
/// while a call runs. Throws Error naming the object if the object was moved from, or if another
/// call uses the state.
template <class State, class Call>
auto exclusive(const std::unique_ptr<State>& state, const char* object, const Call& call) {
  return as_proved([&] {
    if (!state)
      throw Error(object, "was moved from",
                  "use the object that it was moved to, or make a new one");
    if (state->used.test_and_set(std::memory_order_acquire))
      throw Error(object, "is in use by another thread or call", "make one for each thread");
    struct Mark {
      std::atomic_flag& used;
      ~Mark() { used.clear(std::memory_order_release); }
    };
    const Mark mark{state->used};
    return call(*state);
  });
}

/// The input of the last call, and the poses of its objects.
struct TakenInput {
  Scene scene;                    // with vertices after the poses, unless `stale`
  std::uint64_t passed_over = 0;  // vertices that are not finite and that no triangle uses
  // The members below are empty if the last call had no poses.
  std::vector<Vec3> unmoved;  // the vertices before the poses
  std::vector<std::uint32_t>
      object_of;  // the object of each vertex; kNoObject: no triangle uses it
  std::vector<Pose> poses;
  /// True if `poses` moved the vertices of some blocks only; older poses moved the other vertices.
  bool stale = false;
  std::optional<RigidBlocks> rigid;  // made from `unmoved`; null: not made yet
  double loss = 0;                   // lost time, in triangles; see pays() in input.cpp
  /// skips: how many of the next calls of load_poses() return null at once. next_skips: the value
  /// of `skips` after the next failure; doubled by each failure, and 1 after a success.
  int skips = 0, next_skips = 1;
};
inline constexpr std::uint32_t kNoObject = ~std::uint32_t{0};
inline constexpr int kMostSkips = 32;

/// Copies the input into `taken`, which holds the input of the last call. self, self_objects: as in
/// Options. change: receives the changes since the last call; may be null. asked: true if a scene
/// with nothing to test is an error. Throws Error if the input breaks a condition of Input;
/// `taken` is then empty.
void load_input(const Input& input, bool self, const std::vector<bool>& self_objects,
                TakenInput& taken, FrameChange* change = nullptr, bool asked = true);

/// Settings of the search for colliding pairs, for load_poses().
struct PosesQuestion {
  double clearance = 0;
  std::span<const ObjectPair> ignored;  // result of ignored_of()
  unsigned threads = 0;
  bool keeps_frames = false;  // the results of the last call are kept
};
/// Takes input that has only poses. Moves only the vertices of blocks that overlap, and returns
/// these blocks of triangles. Returns null if the caller must call load_input() instead:
/// - the input has other arrays, or the last call had another number of poses,
/// - a pose is bad, or an object is tested against itself,
/// - decide_by_motions() returns null, too many boxes overlap, or load_input() takes less time,
/// - an earlier call failed (TakenInput::skips).
std::optional<BlockDecision> load_poses(const Input& input, const PosesQuestion& question,
                                        TakenInput& taken);

/// Throws Error if `threads` is more than 1024.
void require_threads(unsigned threads);

/// Returns the ignored pairs of a scene with this many objects. Throws Error if a pair names an
/// object that the scene does not have, or one object twice.
std::vector<ObjectPair> ignored_of(const std::vector<std::array<std::uint32_t, 2>>& ignore,
                                   std::size_t objects);

Contact to_public(const ContactShape& shape);
std::vector<Contact> to_public(const std::vector<ContactShape>& shapes);

}  // namespace farcull
