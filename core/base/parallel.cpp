// Keeps a pool of threads, because starting a new thread can take longer than its work.
#include "core/base/parallel.h"

#include <condition_variable>
#include <deque>
#include <mutex>
#include <utility>

#ifndef _WIN32
#include <pthread.h>

#include <csignal>
#endif

namespace farcull {
namespace {

// The stop flag of the StoppableCall that this thread works for. Null: there is no such call.
thread_local const std::atomic<bool>* stop_requested = nullptr;

// Sets stop_requested to `request` for the lifetime of the object.
class WorksFor {
 public:
  explicit WorksFor(const std::atomic<bool>* request)
      : before_(std::exchange(stop_requested, request)) {}
  ~WorksFor() { stop_requested = before_; }
  WorksFor(const WorksFor&) = delete;
  WorksFor& operator=(const WorksFor&) = delete;

 private:
  const std::atomic<bool>* before_;
};

// A waiting thread spins this long before it sleeps. New work usually arrives sooner than a
// sleeping thread could wake up.
constexpr std::chrono::microseconds kSpin{50};

template <class Done>
bool spin_until(const Done& done) {
  const auto end = std::chrono::steady_clock::now() + kSpin;
  do {
    for (int k = 0; k < 64; ++k) {
      if (done()) return true;
#if defined(__GNUC__) && (defined(__x86_64__) || defined(__i386__))
      __builtin_ia32_pause();
#endif
    }
  } while (std::chrono::steady_clock::now() < end);
  return done();
}

// Blocks all signals in the calling thread while the object exists. A thread started during this
// time inherits the blocked signals. So only threads of farcull's caller receive signals.
class SignalsBlocked {
 public:
#ifndef _WIN32
  SignalsBlocked() {
    sigset_t all;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before_);
  }
  ~SignalsBlocked() { pthread_sigmask(SIG_SETMASK, &before_, nullptr); }

 private:
  sigset_t before_;
#else
  SignalsBlocked() {}
#endif
};

// The parts of one call of run_parts(). The object exists until the call returns.
struct Batch {
  void (*part)(const void*, std::size_t);
  const void* data;
  std::size_t parts;
  const std::atomic<bool>* stop_request;  // the stop flag of the calling thread
  std::size_t next = 0;                   // number of parts begun; guarded by the pool's mutex
  std::atomic<std::size_t> done = 0;      // number of parts finished
};

class Pool {
 public:
  void run(Batch& batch) {
    {
      const std::lock_guard lock(mutex_);
      batch.next = 1;
      need_threads(batch.parts - 1);
      batches_.push_back(&batch);
      waiting_ += batch.parts - 1;
    }
    wake_.notify_all();
    batch.part(batch.data, 0);
    batch.done.fetch_add(1);
    while (std::size_t k = claim_of(batch)) {
      batch.part(batch.data, k);
      batch.done.fetch_add(1);
    }
    const auto finished = [&] { return batch.done.load() == batch.parts; };
    if (spin_until(finished)) return;
    std::unique_lock lock(mutex_);
    finished_.wait(lock, finished);
  }

 private:
  // Claims the next part of the batch and returns its index. Returns 0 if all parts are claimed.
  std::size_t claim_of(Batch& batch) {
    const std::lock_guard lock(mutex_);
    return batch.next < batch.parts ? claim(batch) : 0;
  }
  // Preconditions: the caller holds the mutex, and the batch has an unclaimed part.
  std::size_t claim(Batch& batch) {
    --waiting_;
    const std::size_t k = batch.next++;
    if (batch.next == batch.parts) std::erase(batches_, &batch);
    return k;
  }

  // Starts threads until there are `count`, or until a start fails. The caller holds the mutex.
  void need_threads(std::size_t count) {
    const SignalsBlocked blocked;
    try {
      while (threads_ < count) {
        std::thread([this] { work(); }).detach();
        ++threads_;
      }
    } catch (const std::exception&) {
      // The existing threads and the caller of run_parts() do the work.
    }
  }

  void work() {
    for (;;) {
      spin_until([&] { return waiting_.load(std::memory_order_relaxed) > 0; });
      std::unique_lock lock(mutex_);
      wake_.wait(lock, [&] { return waiting_.load() > 0; });
      Batch& batch = *batches_.front();
      const std::size_t k = claim(batch);
      lock.unlock();
      {
        const WorksFor works_for(batch.stop_request);
        batch.part(batch.data, k);
      }
      lock.lock();
      // Reads `parts` before increasing `done`. When all parts are done, the batch is destroyed.
      const std::size_t parts = batch.parts;
      const bool last = batch.done.fetch_add(1) + 1 == parts;
      lock.unlock();
      if (last) finished_.notify_all();
    }
  }

  std::mutex mutex_;
  std::condition_variable wake_, finished_;
  std::deque<Batch*> batches_;            // batches with unclaimed parts
  std::atomic<std::size_t> waiting_ = 0;  // number of unclaimed parts; written under the mutex
  std::size_t threads_ = 0;
};

// Returns the pool. The pool is never destroyed: its threads sleep until the process ends. A forked
// process has none of these threads, so the fork handler makes a new pool.
Pool& pool() {
  static std::atomic<Pool*> current = [] {
#ifndef _WIN32
    pthread_atfork(nullptr, nullptr, [] { current = new Pool; });
#endif
    return new Pool;
  }();
  return *current;
}

}  // namespace

void run_parts(std::size_t parts, void (*part)(const void*, std::size_t), const void* data) {
  stop_point();
  if (parts == 0) return;
  if (parts == 1) return part(data, 0);
  Batch batch{part, data, parts, stop_requested};
  pool().run(batch);
}

void stop_point() {
  if (stop_requested != nullptr && stop_requested->load(std::memory_order_relaxed)) throw Stopped();
}

struct StoppableCall::State {
  std::function<void()> work;
  std::atomic<bool> stop = false;
  std::exception_ptr failure;  // set before `ended` becomes true
  std::mutex mutex;
  std::condition_variable changed;
  bool ended = false;  // guarded by the mutex
  std::thread thread;

  void run() {
    try {
      const WorksFor works_for(&stop);
      work();
    } catch (...) {
      failure = std::current_exception();
    }
    const std::lock_guard lock(mutex);
    ended = true;
    changed.notify_all();
  }
};

StoppableCall::StoppableCall(std::function<void()> work) : state_(std::make_unique<State>()) {
  state_->work = std::move(work);
  const SignalsBlocked blocked;
  state_->thread = std::thread([state = state_.get()] { state->run(); });
}

StoppableCall::~StoppableCall() {
  if (state_->thread.joinable()) state_->thread.join();
}

void StoppableCall::stop() { state_->stop = true; }

bool StoppableCall::wait_for(std::chrono::milliseconds most) {
  std::unique_lock lock(state_->mutex);
  return state_->changed.wait_for(lock, most, [&] { return state_->ended; });
}

void StoppableCall::finish() {
  if (state_->thread.joinable()) state_->thread.join();
  if (state_->failure) std::rethrow_exception(std::exchange(state_->failure, nullptr));
}

}  // namespace farcull
