// Timestamps of the device: each is a query object of its own.
#include "core/gl/clock.h"

#include <array>

#include "core/gl/context.h"

namespace farcull {

GlClock::GlClock(std::size_t stamps) : stamps_(stamps) {
  GLint bits = 0;
  glGetQueryiv(GL_TIMESTAMP, GL_QUERY_COUNTER_BITS, &bits);
  ticks_ = bits > 0;
}

void GlClock::forget() {
  for (GlQuery& stamp : stamps_) stamp = GlQuery();
}

// A new name each time: a stamp that is lost then has no object, and no stale time to give.
void GlClock::stamp(std::size_t place) {
  if (!ticks_) return;
  GlQuery& query = stamps_.at(place);
  query = gl_make<GlQuery>(glGenQueries);
  glQueryCounter(query, GL_TIMESTAMP);
}

double GlClock::between(std::size_t from, std::size_t to) const {
  std::array<GLuint64, 2> ns{};
  for (std::size_t k = 0; k < ns.size(); ++k) {
    const GlQuery& query = stamps_.at(k == 0 ? from : to);
    if (query == 0) return -1;
    GLuint ready = GL_FALSE;
    glGetQueryObjectuiv(query, GL_QUERY_RESULT_AVAILABLE, &ready);
    if (ready == GL_TRUE) glGetQueryObjectui64v(query, GL_QUERY_RESULT, &ns[k]);
    check_gl("clock");
    if (ns[k] == 0) return -1;
  }
  return ns[1] >= ns[0] ? static_cast<double>(ns[1] - ns[0]) / 1e6 : -1;
}

}  // namespace farcull
