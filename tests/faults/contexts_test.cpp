// Sessions that draw on GL beside each other, beside contexts of the caller's own, and in several
// threads.
#include <epoxy/egl.h>

#include "experiments/method/run.h"
#include "experiments/scenes/builtin/scenes.h"
#include "tests/faults/gl_calls.h"

namespace farcull {
namespace {

// A session with a context of its own, in which FAR draws.
class Drawer {
 public:
  Drawer() : session_(std::make_unique<Session>("software")) { session_->context(); }
  // Whether the pairs are those that the first one of all found.
  bool right() {
    static const Scene scene = make_builtin_scene("two-spheres");
    RunOptions options{.method = Method::far, .resolution = 32};
    options.verify = false;
    const std::vector<TrianglePair> found = run(scene, options, *session_).collisions.pairs;
    static const std::vector<TrianglePair> first = found;
    return !first.empty() && found == first;
  }

 private:
  std::unique_ptr<Session> session_;
};

// A context as a host program has one, of OpenGL or OpenGL ES, made with EGL alone.
class HostContext {
 public:
  explicit HostContext(EGLenum api = EGL_OPENGL_API) : api_(api) {
    std::array<EGLDeviceEXT, 16> devices;
    EGLint count = 0;
    if (!eglQueryDevicesEXT(devices.size(), devices.data(), &count)) return;
    for (EGLint d = 0; d < count && context_ == EGL_NO_CONTEXT; ++d) {
      display_ = eglGetPlatformDisplayEXT(EGL_PLATFORM_DEVICE_EXT, devices[d], nullptr);
      if (display_ == EGL_NO_DISPLAY || !eglInitialize(display_, nullptr, nullptr)) continue;
      eglBindAPI(api);
      const EGLint version[] = {EGL_CONTEXT_MAJOR_VERSION, 3, EGL_NONE};
      context_ = eglCreateContext(display_, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, version);
    }
    eglBindAPI(EGL_OPENGL_API);
  }
  ~HostContext() {
    release();
    if (context_ != EGL_NO_CONTEXT) eglDestroyContext(display_, context_);
  }
  bool make_current() const {
    return eglBindAPI(api_) && eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_);
  }
  void release() const {
    eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    eglBindAPI(EGL_OPENGL_API);
  }
  bool is_current() const { return eglQueryAPI() == api_ && eglGetCurrentContext() == context_; }

 private:
  EGLenum api_;
  EGLDisplay display_ = EGL_NO_DISPLAY;
  EGLContext context_ = EGL_NO_CONTEXT;
};

// The host's context, its rendering API and what it has bound are as they were.
TEST(Contexts, TheCallersContextStaysCurrent) {
  for (const EGLenum api : {EGL_OPENGL_API, EGL_OPENGL_ES_API}) {
    HostContext host(api);
    ASSERT_TRUE(host.make_current());
    GLuint buffer = 0;
    glGenBuffers(1, &buffer);
    glBindBuffer(GL_ARRAY_BUFFER, buffer);
    {
      Drawer drawer;
      EXPECT_TRUE(host.is_current());
      EXPECT_TRUE(drawer.right());
      EXPECT_TRUE(host.is_current());
      GlContext::list_devices();
      EXPECT_TRUE(host.is_current());
    }
    EXPECT_TRUE(host.is_current());
    GLint bound = 0;
    glGetIntegerv(GL_ARRAY_BUFFER_BINDING, &bound);
    EXPECT_EQ(bound, static_cast<GLint>(buffer));
    EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR));
  }
}

TEST(Contexts, TwoThreadsAtOnceAreRefusedByName) {
  const GlContext context;
  const GlCurrent here(context);
  std::string said;
  std::thread([&] {
    try {
      const GlCurrent there(context);
    } catch (const Error& error) {
      said = error.what();
    }
  }).join();
  EXPECT_TRUE(has_text(said, "another thread is using it"));
}

TEST(Contexts, ContextsNest) {
  const GlContext a, b;
  const GlCurrent outer(a);
  const EGLContext current = eglGetCurrentContext();
  {
    const GlCurrent inner(b);
    EXPECT_NE(eglGetCurrentContext(), current);
    const GlCurrent innermost(a);
    EXPECT_EQ(eglGetCurrentContext(), current);
  }
  EXPECT_EQ(eglGetCurrentContext(), current);
}

// Twins: what the tests above would find without the guard.
EGLBoolean make_nothing_current(EGLDisplay, EGLSurface, EGLSurface, EGLContext) { return EGL_TRUE; }

TEST(ContextsTwin, AContextThatIsNotMadeCurrentIsNoticed) {
  Drawer a, b;
  const auto before = epoxy_eglMakeCurrent;
  epoxy_eglMakeCurrent = make_nothing_current;
  EXPECT_THROW(a.right(), Error);
  EXPECT_THROW(b.right(), Error);
  epoxy_eglMakeCurrent = before;
  EXPECT_TRUE(a.right());
  EXPECT_TRUE(b.right());
}

// Any order of making, using, moving and destroying, in two threads, beside two hosts' contexts.
TEST(Contexts, AnyOrderOfUse) {
  std::mt19937 random(20261122);
  const auto below = [&](int n) { return static_cast<int>(random() % n); };
  const HostContext gl, es(EGL_OPENGL_ES_API);
  const HostContext* current = nullptr;
  std::array<std::optional<Drawer>, 4> drawers;
  int answers = 0;
  for (int step = 0; step < 120; ++step) {
    std::optional<Drawer>& one = drawers[below(4)];
    std::optional<Drawer>& other = drawers[below(4)];
    const int kind = below(10);
    if (kind == 0 && (!one || below(3) == 0)) one.emplace();
    if (kind == 1 && below(3) == 0) one.reset();
    if (kind == 2 && &one != &other) std::swap(one, other);
    if (kind == 3) {
      if (current != nullptr) current->release();
      current = below(3) == 0 ? nullptr : below(2) == 0 ? &gl : &es;
      ASSERT_TRUE(current == nullptr || current->make_current());
    }
    if (kind > 4 && !one) one.emplace();
    if (kind >= 4 && one) {
      bool right = false;
      if (kind == 4)
        std::thread([&] { right = one->right(); }).join();
      else
        right = one->right();
      EXPECT_TRUE(right) << step;
      ++answers;
    }
    EXPECT_TRUE(current != nullptr ? current->is_current()
                                   : eglGetCurrentContext() == EGL_NO_CONTEXT)
        << step;
  }
  if (current != nullptr) current->release();
  EXPECT_GT(answers, 50);
  std::printf("contexts interleaved: 120 steps, 4 sessions, 2 hosts' contexts, %d answers\n",
              answers);
}

using lab::GlFault, lab::GlFaultOutcome;

TEST(SessionFaults, ASessionGoesOnAfterAFailure) {
  const Scene scene = make_builtin_scene("two-spheres");
  {
    RunOptions options;
    options.method = Method::far;
    options.resolution = 32;
    options.verify = false;
    Session session("software");
    const auto right = run(scene, options, session).collisions.pairs;
    ASSERT_GT(right.size(), 0u);
    const auto outcomes = lab::try_gl_faults(
        GlFault::out_of_memory, [&] { session.forget_device(); },
        [&] { return run(scene, options, session).collisions.pairs == right; });
    EXPECT_GT(outcomes.size(), 4u);
    for (const GlFaultOutcome& o : outcomes) EXPECT_TRUE(o.threw) << o.at;
    lab::expect_no_wrong_answer("failed allocations of a session", outcomes);
  }
}

}  // namespace
}  // namespace farcull
