// The GL objects that core/gl shares: names that are deleted with their owners, programs, storage
// buffers, and the echo (a checksum that reveals lost commands). For core/gl and its tests alone.
#pragma once

#include <epoxy/gl.h>

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

#include "core/gl/base/context.h"

namespace farcull {

/// Throws Error naming the GL stage: a command was lost, and `reason` says how it was noticed.
[[noreturn]] void throw_lost(const std::string& stage, const std::string& reason);

template <void (*Delete)(GLuint)>
class GlName {
 public:
  GlName() = default;
  explicit GlName(GLuint name) : name_(name) {}
  GlName(GlName&& other) noexcept : name_(std::exchange(other.name_, 0)) {}
  GlName& operator=(GlName&& other) noexcept {
    std::swap(name_, other.name_);
    return *this;
  }
  ~GlName() {
    if (name_ != 0) Delete(name_);
  }
  operator GLuint() const { return name_; }

 private:
  GLuint name_ = 0;
};

/// Deletes one object by a GL function that deletes several. Delete: a function pointer of
/// libepoxy.
template <auto* Delete>
void delete_one(GLuint name) {
  (*Delete)(1, &name);
}
inline void delete_program(GLuint name) { glDeleteProgram(name); }

using GlBuffer = GlName<delete_one<&epoxy_glDeleteBuffers>>;
using GlTexture = GlName<delete_one<&epoxy_glDeleteTextures>>;
using GlFramebuffer = GlName<delete_one<&epoxy_glDeleteFramebuffers>>;
using GlVertexArray = GlName<delete_one<&epoxy_glDeleteVertexArrays>>;
using GlQuery = GlName<delete_one<&epoxy_glDeleteQueries>>;
using GlProgram = GlName<delete_program>;

template <class Object>
Object gl_make(void (*generate)(GLsizei, GLuint*)) {
  GLuint name = 0;
  generate(1, &name);
  return Object(name);
}

/// A texture of one level, bound, with the nearest filter.
GlTexture gl_texture(GLenum format, int width, int height);

struct ShaderText {
  GLenum stage;
  std::vector<std::string> texts;
};
/// Compiles and links a program. The source of each stage is "#version 430 core", `defines` (one
/// #define line each) and the stage's texts. Throws Error with the driver's log and the name.
GlProgram gl_program(const std::string& name, const std::vector<std::string>& defines,
                     const std::vector<ShaderText>& stages);

/// Gives a shader storage buffer new contents. Its size is at least 16 bytes, so that it can be
/// bound.
void gl_fill(GLuint buffer, const void* data, std::size_t bytes);

/// Returns a number that is unique in this process (for the first 2^32 calls).
std::uint32_t gl_number();

/// Bytes of a storage buffer before its data: its tag and three zero words.
constexpr std::size_t kTagBytes = 16;

/// A shader storage buffer that grows and never shrinks. It begins with a tag, a number that no
/// other buffer of the process has. Programs add the tag to their echo, so the echo shows which
/// buffer was bound. Programs declare it as { uvec4 tag; T data[]; }; offsets here count from the
/// data. Every function asks GL whether the buffer is bound before it touches contents, so that a
/// lost binding cannot spoil another buffer. Each function throws Error if GL fails.
class GlStore {
 public:
  /// Makes room for `wanted` bytes of data. If the store has to grow, its new size is `wanted` or
  /// 1.5 times the old size (at most `most`), whichever is larger. Returns true if the store has
  /// grown. Its contents are then undefined. If this throws, the store is unchanged.
  bool reserve(std::size_t wanted, std::size_t most);
  void write(std::size_t at, const void* data, std::size_t bytes);
  /// Sets the first `bytes` bytes of data, a multiple of 4, to 0.
  void clear(std::size_t bytes);
  void read(std::size_t at, void* out, std::size_t bytes) const;

  GLuint name() const { return name_; }
  std::uint32_t tag() const { return tag_; }
  std::size_t bytes() const { return bytes_; }  // of data

 private:
  GlBuffer name_;
  std::uint32_t tag_ = 0;
  std::size_t bytes_ = 0;
};

// The echo (assumption A7) is a hash that the device returns: of the values that a program read,
// and of the data that were sent. A wrong echo reveals a lost command. kEchoGlsl computes it in
// shaders.

/// Mixes a word with its place (the finalizer of MurmurHash3). The result is a bijection of the
/// word, and each bit of the word can change every bit of the result. So changes of a few words
/// hardly ever cancel in a sum.
inline std::uint32_t gl_mixed(std::uint32_t word, std::uint32_t place) {
  std::uint32_t mixed = word ^ place * 0x9e3779b9u;
  mixed = (mixed ^ mixed >> 16) * 0x85ebca6bu;
  mixed = (mixed ^ mixed >> 13) * 0xc2b2ae35u;
  return mixed ^ mixed >> 16;
}

/// For shaders that write a hash of the values they read. FAR_ADD adds a mixed word to `sum`.
inline constexpr char kEchoGlsl[] = R"glsl(
uint far_mixed(uint word, uint place) {
  uint mixed = word ^ place * 0x9e3779b9u;
  mixed = (mixed ^ mixed >> 16) * 0x85ebca6bu;
  mixed = (mixed ^ mixed >> 13) * 0xc2b2ae35u;
  return mixed ^ mixed >> 16;
}
#define FAR_ADD(place, word) sum += far_mixed((word), (place));
)glsl";

/// The sum of words, each mixed with its place.
struct GlEcho {
  std::uint32_t sum = 0;
  std::uint32_t place = 0;  // place of the next word

  template <class Number, std::size_t N>
  void add(const std::array<Number, N>& words) {
    for (const Number word : words) sum += gl_mixed(std::bit_cast<std::uint32_t>(word), place++);
  }
  void add(std::initializer_list<std::uint32_t> words) {
    for (const std::uint32_t word : words) sum += gl_mixed(word, place++);
  }
  void add_at(std::uint32_t at, std::uint32_t word) { sum += gl_mixed(word, at); }
};

}  // namespace farcull
