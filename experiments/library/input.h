// For the functions of the library: converts and checks their input, options, answers and errors.
#pragma once

#include <atomic>
#include <memory>
#include <vector>

#include "core/base/error.h"
#include "core/base/floating_point.h"
#include "core/scene/scene.h"
#include "experiments/library/farcull.h"
#include "experiments/method/options.h"
#include "verify/contact.h"

namespace farcull {

/// Whether two enumerators have the same value, so that a cast converts the first to the second.
template <class Given, class Own>
constexpr bool same(Given given, Own own) {
  return static_cast<int>(given) == static_cast<int>(own);
}

inline constexpr unsigned kMostThreads = 1024;

/// Runs the call in the floating-point environment of the proofs, and then restores the caller's.
/// Turns every Error into a ColliderError.
template <class Call>
auto translated(const Call& call) {
  try {
    const FloatingPointGuard guard;
    return call();
  } catch (const Error& error) {
    throw ColliderError(error.what(), error.where, error.reason, error.remedy);
  }
}

/// Runs the call with the state of an object of the library, one call at a time. Throws
/// ColliderError naming the object if it was moved from, or if another call uses it: one of another
/// thread, or one of this thread that a signal handler interrupted. State has a member
/// `std::atomic_flag used`, which is set while the call runs.
template <class State, class Call>
auto exclusive(const std::unique_ptr<State>& state, const char* object, const Call& call) {
  return translated([&] {
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

/// Copies the input into `scene`, which holds the scene of the last call, and reuses its memory.
/// self: every object is tested against itself; self_objects: the same for each object, empty or
/// one for each. change: receives what is new since the last call; may be null. asked: a scene in
/// which there is nothing to test is an error. passed_over: receives the number of vertices that
/// are not finite and that no triangle uses; may be null. Throws Error for input that is not as
/// ColliderInput says, and leaves the scene empty then.
void take(const ColliderInput& input, bool self, const std::vector<bool>& self_objects,
          Scene& scene, FrameChange* change = nullptr, bool asked = true,
          std::uint64_t* passed_over = nullptr);

/// Throws Error naming an option that is bad for any input.
void check(const ColliderOptions& options);

ContactDetail detail_of(ColliderContacts contacts);

/// The ignored pairs of a scene with so many objects. Throws Error if a pair names an object that
/// the scene does not have.
std::vector<ObjectPair> ignored_of(const ColliderOptions& options, std::size_t objects);

ColliderContact given_out(const ContactShape& shape);
std::vector<ColliderContact> given_out(const std::vector<ContactShape>& shapes);

}  // namespace farcull
