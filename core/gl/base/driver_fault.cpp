// Replaces the GL functions that should fail, for each kind of fault. The thread-local `plan` tells
// which call fails. In threads without a plan, the replacements call the driver's functions.
#include "core/gl/base/driver_fault.h"

#include <optional>
#include <stdexcept>
#include <string>

namespace farcull {
namespace {

using Kind = DriverFaultKind;

struct Plan {
  Kind kind;
  std::optional<std::size_t> strike;  // number of the failing call; empty: no call fails
  std::size_t calls = 0;              // number of calls since DriverFault::strike()
  bool query_lost = false;            // glBeginQuery was not called, so glEndQuery must be skipped

  bool now() { return strike && calls++ == *strike; }
};
std::mutex one_at_a_time;
thread_local std::optional<Plan> plan;

using DrawArrays = GlEntryPoint<&epoxy_glDrawArrays>;
using Dispatch = GlEntryPoint<&epoxy_glDispatchCompute>;
using BeginQuery = GlEntryPoint<&epoxy_glBeginQuery>;
using EndQuery = GlEntryPoint<&epoxy_glEndQuery>;
using ShaderSource = GlEntryPoint<&epoxy_glShaderSource>;

void draw(GLenum mode, GLint first, GLsizei count) {
  if (!plan || !plan->now()) DrawArrays::original(mode, first, count);
}

// In every compute program of farcull, the line kEnd ends an invocation after its last work item.
// The fault unfinished_item replaces this line by kEarlierEnd, which also ends the invocation
// before work item far_lost_item - 1. If far_lost_item is 0, no invocation ends early.
constexpr const char* kEnd = "if (w >= u_count) break;";
constexpr const char* kEarlierEnd = "if (w >= u_count || w + 1u == far_lost_item) break;";
constexpr const char* kSize = "layout(local_size_x = 64) in;";
constexpr const char* kSizeAndItem =
    "layout(local_size_x = 64) in;\nlayout(location = 64) uniform uint far_lost_item;";
constexpr GLint kCount = 0, kLostItem = 64;  // locations of u_count and far_lost_item

void dispatch(GLuint x, GLuint y, GLuint z) {
  if (!plan || !plan->now()) return Dispatch::original(x, y, z);
  if (plan->kind == Kind::lost_dispatch) return;
  if (plan->kind == Kind::oversized_dispatch) {
    GLint most = 0;
    glGetIntegeri_v(GL_MAX_COMPUTE_WORK_GROUP_COUNT, 0, &most);
    return Dispatch::original(static_cast<GLuint>(most) + 1, y, z);
  }
  GLint program = 0;
  glGetIntegerv(GL_CURRENT_PROGRAM, &program);
  if (glGetUniformLocation(static_cast<GLuint>(program), "far_lost_item") != kLostItem)
    throw std::logic_error("driver fault: the program was not compiled with this fault");
  GLuint count = 0;
  glGetUniformuiv(static_cast<GLuint>(program), kCount, &count);
  glProgramUniform1ui(static_cast<GLuint>(program), kLostItem, count / 2 + 1);
  Dispatch::original(x, y, z);
  glProgramUniform1ui(static_cast<GLuint>(program), kLostItem, 0);
}

void begin_query(GLenum target, GLuint query) {
  if (target != GL_ANY_SAMPLES_PASSED || !plan || !plan->strike)
    return BeginQuery::original(target, query);
  if (plan->kind == Kind::lost_query) {
    plan->query_lost = plan->now();
    if (!plan->query_lost) BeginQuery::original(target, query);
    return;
  }
  BeginQuery::original(target, query);
  EndQuery::original(target);
}

void end_query(GLenum target) {
  const bool ours = target == GL_ANY_SAMPLES_PASSED && plan && plan->strike;
  if (ours && (plan->kind == Kind::blind_queries || plan->query_lost)) return;
  EndQuery::original(target);
}

void replace(std::string& text, const std::string& from, const std::string& to) {
  for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size())
    text.replace(at, from.size(), to);
}

// Changes only sources that are one null-terminated string, as in gl_program().
void shader_source(GLuint shader, GLsizei count, const GLchar* const* texts, const GLint* lengths) {
  if (!plan || count != 1 || lengths != nullptr)
    return ShaderSource::original(shader, count, texts, lengths);
  std::string text = texts[0];
  if (plan->kind == Kind::unfinished_item && text.find(kEnd) != std::string::npos) {
    replace(text, kSize, kSizeAndItem);
    replace(text, kEnd, kEarlierEnd);
  }
  const GLchar* const changed = text.c_str();
  ShaderSource::original(shader, count, &changed, lengths);
}

}  // namespace

DriverFault::DriverFault(DriverFaultKind kind) : alone_(one_at_a_time) {
  plan = Plan{.kind = kind, .strike = {}};
  switch (kind) {
    case Kind::lost_draw:
      replaced_ = {std::make_shared<DrawArrays>(draw)};
      break;
    case Kind::unfinished_item:
      replaced_.push_back(std::make_shared<ShaderSource>(shader_source));
      [[fallthrough]];
    case Kind::lost_dispatch:
    case Kind::oversized_dispatch:
      replaced_.push_back(std::make_shared<Dispatch>(dispatch));
      break;
    case Kind::lost_query:
    case Kind::blind_queries:
      replaced_ = {std::make_shared<BeginQuery>(begin_query),
                   std::make_shared<EndQuery>(end_query)};
      break;
  }
}

DriverFault::~DriverFault() {
  replaced_.clear();
  plan.reset();
}

void DriverFault::strike(std::size_t call) {
  plan->strike = call;
  plan->calls = 0;
}

}  // namespace farcull
