// Compiles GL programs. Checks that GL has executed each binding and each allocation of a buffer.
#include "core/gl/base/objects.h"

#include <algorithm>
#include <atomic>

#include "core/base/error.h"

namespace farcull {
namespace {

constexpr const char* kReport = "report this driver's log with the output of `{doctor}`";

// Macros for differences between GLSL and C++, such as out parameters. core/base/glsl_shim.h
// defines the same macros for C++, so kernels compile in both languages.
constexpr const char* kKernelNames =
    "#define FAR_OUT(type) out type\n#define FAR_INOUT(type) inout type\n#define FAR_PRECISE "
    "precise\n#define FAR_FIXED(x) (x)\n#define FAR_KERNEL\n#define FAR_CONSTANT const float\n"
    "#define FAR_BOOL bool\n#define FAR_SELECT(c, a, b) ((c) ? (a) : (b))\n"
    "#define FAR_UNIFORM(c) (c)\n";

// FAR_AT(array, index) is an element of the array at the end of a storage block, or the last
// element if the index is past the end. After a lost command, a shader can read a wrong index from
// a buffer before the host detects the loss. The macro keeps the access inside the array. The
// storage buffers of farcull are never empty.
constexpr const char* kElement =
    "#define FAR_AT(array, index) array[min(uint(index), uint(array.length()) - 1u)]\n";

template <class Get, class Log>
std::string log_of(GLuint object, Get get, Log log) {
  GLint length = 0;
  get(object, GL_INFO_LOG_LENGTH, &length);
  std::string text(static_cast<std::size_t>(std::max(length, 1)), '\0');
  log(object, length, nullptr, text.data());
  while (!text.empty() && (text.back() == '\0' || text.back() == '\n')) text.pop_back();
  return text;
}

// Binds the buffer `name`. Throws Error if GL reports another binding, because an update would
// change the wrong buffer.
void bind_storage(GLuint name) {
  glBindBuffer(GL_SHADER_STORAGE_BUFFER, name);
  GLint bound = 0;
  glGetIntegerv(GL_SHADER_STORAGE_BUFFER_BINDING, &bound);
  if (static_cast<GLuint>(bound) != name || name == 0)
    throw_lost("buffer", "a buffer was not bound");
}

}  // namespace

void throw_lost(const std::string& stage, const std::string& reason) {
  throw Error("GL " + stage, reason, "a command was lost: run again, or with another {device}");
}

// Returns numbers that look random, so that a sum of a few numbers is unlikely to be 0. Each step
// of the function is a bijection, so the first 2^32 numbers are all different.
std::uint32_t gl_number() {
  static std::atomic<std::uint32_t> last{0};
  std::uint32_t tag = last += 1;
  tag = (tag ^ tag >> 16) * 0x85ebca6bu;
  tag = (tag ^ tag >> 13) * 0xc2b2ae35u;
  return tag ^ tag >> 16;
}

bool GlStore::reserve(std::size_t wanted, std::size_t most) {
  wanted = std::max<std::size_t>(wanted, 16);
  if (name_ != 0 && wanted <= bytes_) return false;
  const std::size_t grown_to = std::max(wanted, std::min(most, bytes_ + bytes_ / 2));
  const std::size_t bytes = (grown_to + 15) / 16 * 16;
  const auto size = static_cast<GLsizeiptr>(kTagBytes + bytes);
  GlBuffer grown = gl_make<GlBuffer>(glGenBuffers);
  bind_storage(grown);
  glBufferData(GL_SHADER_STORAGE_BUFFER, size, nullptr, GL_DYNAMIC_COPY);
  GLint64 given = 0;
  glGetBufferParameteri64v(GL_SHADER_STORAGE_BUFFER, GL_BUFFER_SIZE, &given);
  check_gl("buffer of " + std::to_string(size) + " bytes");
  if (given != size) throw_lost("buffer", "a buffer has not the size that was asked for");
  const std::uint32_t head[4] = {gl_number(), 0, 0, 0};
  glBufferSubData(GL_SHADER_STORAGE_BUFFER, 0, sizeof head, head);
  std::swap(name_, grown);
  tag_ = head[0];
  bytes_ = bytes;
  return true;
}

void GlStore::write(std::size_t at, const void* data, std::size_t bytes) {
  if (bytes == 0) return;
  bind_storage(name_);
  glBufferSubData(GL_SHADER_STORAGE_BUFFER, static_cast<GLintptr>(kTagBytes + at),
                  static_cast<GLsizeiptr>(bytes), data);
}

void GlStore::clear(std::size_t bytes) {
  bind_storage(name_);
  glClearBufferSubData(GL_SHADER_STORAGE_BUFFER, GL_R32UI, kTagBytes,
                       static_cast<GLsizeiptr>(bytes), GL_RED_INTEGER, GL_UNSIGNED_INT, nullptr);
}

void GlStore::read(std::size_t at, void* out, std::size_t bytes) const {
  if (bytes == 0) return;
  bind_storage(name_);
  glGetBufferSubData(GL_SHADER_STORAGE_BUFFER, static_cast<GLintptr>(kTagBytes + at),
                     static_cast<GLsizeiptr>(bytes), out);
}

GlTexture gl_texture(GLenum format, int width, int height) {
  GlTexture out = gl_make<GlTexture>(glGenTextures);
  glBindTexture(GL_TEXTURE_2D, out);
  glTexStorage2D(GL_TEXTURE_2D, 1, format, width, height);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  return out;
}

GlProgram gl_program(const std::string& name, const std::vector<std::string>& defines,
                     const std::vector<ShaderText>& stages) {
  GlProgram program(glCreateProgram());
  for (const ShaderText& stage : stages) {
    std::string text = std::string("#version 430 core\n") + kKernelNames + kElement;
    for (const std::string& define : defines) text += "#define " + define + "\n";
    for (const std::string& part : stage.texts) text += part;
    const GLuint shader = glCreateShader(stage.stage);
    const char* source = text.c_str();
    glShaderSource(shader, 1, &source, nullptr);
    glCompileShader(shader);
    GLint ok = GL_FALSE;
    glGetShaderiv(shader, GL_COMPILE_STATUS, &ok);
    const std::string log = ok ? "" : log_of(shader, glGetShaderiv, glGetShaderInfoLog);
    if (ok) glAttachShader(program, shader);
    glDeleteShader(shader);
    if (!ok) throw Error("GL shader " + name, "it does not compile: " + log, kReport);
  }
  GLint attached = 0;
  glGetProgramiv(program, GL_ATTACHED_SHADERS, &attached);
  if (attached != static_cast<GLint>(stages.size()))
    throw_lost("shader " + name, "it lacks a stage");
  glLinkProgram(program);
  GLint ok = GL_FALSE;
  glGetProgramiv(program, GL_LINK_STATUS, &ok);
  if (!ok) {
    throw Error("GL shader " + name,
                "it does not link: " + log_of(program, glGetProgramiv, glGetProgramInfoLog),
                kReport);
  }
  check_gl("shader " + name);
  return program;
}

void gl_fill(GLuint buffer, const void* data, std::size_t bytes) {
  glBindBuffer(GL_SHADER_STORAGE_BUFFER, buffer);
  const bool small = bytes < 16;
  const auto size = static_cast<GLsizeiptr>(bytes);
  glBufferData(GL_SHADER_STORAGE_BUFFER, small ? 16 : size, small ? nullptr : data, GL_STREAM_DRAW);
  if (small && bytes > 0 && data) glBufferSubData(GL_SHADER_STORAGE_BUFFER, 0, size, data);
}

}  // namespace farcull
