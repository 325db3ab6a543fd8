// Owners of GL objects, programs, storage buffers, and the echo (a checksum that reveals lost
// commands). Only core/gl and its tests include this file.
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

/// Throws Error because the driver lost a command in `stage`. reason: how the loss was detected.
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

/// Deletes one object. Delete: libepoxy's pointer to a GL function that deletes several objects.
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

/// Makes a texture of one level with the nearest filter. The texture stays bound.
GlTexture gl_texture(GLenum format, int width, int height);

struct ShaderText {
  GLenum stage;
  std::vector<std::string> texts;
};
/// Compiles and links a program. The source of each stage is the version, macros for kernels, one
/// #define line for each of `defines`, and the stage's texts. Throws Error with the log on failure.
GlProgram gl_program(const std::string& name, const std::vector<std::string>& defines,
                     const std::vector<ShaderText>& stages);

/// Replaces the contents of a shader storage buffer. The new size is at least 16 bytes, because an
/// empty buffer cannot be bound. data: `bytes` bytes; null leaves the contents undefined.
void gl_fill(GLuint buffer, const void* data, std::size_t bytes);

/// Returns a number that is unique in this process, for the first 2^32 calls.
std::uint32_t gl_number();

/// Number of bytes before the data of a GlStore: the tag and three zero words.
constexpr std::size_t kTagBytes = 16;

/// A shader storage buffer that can grow but never shrinks. The buffer begins with a tag: a number
/// that no other buffer of the process has. Programs include the tag in their echo, so the echo
/// shows which buffer was bound. Programs declare the buffer as { uvec4 tag; T data[]; }. Offsets
/// are relative to the data. Each access first checks the binding, and throws Error if another
/// buffer is bound. So a lost binding cannot damage another buffer.
class GlStore {
 public:
  /// Makes room for `wanted` bytes of data. If the store has to grow, its new size is the larger of
  /// `wanted` and 1.5 times the old size (but at most `most`). Returns true if the store has grown;
  /// the contents are then undefined. If the function throws, the store is unchanged.
  bool reserve(std::size_t wanted, std::size_t most);
  void write(std::size_t at, const void* data, std::size_t bytes);
  /// Sets the first `bytes` bytes of data, a multiple of 4, to 0.
  void clear(std::size_t bytes);
  void read(std::size_t at, void* out, std::size_t bytes) const;

  GLuint name() const { return name_; }
  std::uint32_t tag() const { return tag_; }
  std::size_t bytes() const { return bytes_; }  // size of the data

 private:
  GlBuffer name_;
  std::uint32_t tag_ = 0;
  std::size_t bytes_ = 0;
};

// The echo (assumption A7) is a hash that the device computes from values that a program has read,
// or from data on the device. The host computes the expected hash. A difference reveals a lost
// command.

/// Hashes a word with its position, by the finalizer of MurmurHash3. For a fixed position, the hash
/// is a bijection, and each bit of the word can change every bit of the result. So if a few words
/// change, the sum of all hashes very probably changes.
inline std::uint32_t gl_mixed(std::uint32_t word, std::uint32_t place) {
  std::uint32_t mixed = word ^ place * 0x9e3779b9u;
  mixed = (mixed ^ mixed >> 16) * 0x85ebca6bu;
  mixed = (mixed ^ mixed >> 13) * 0xc2b2ae35u;
  return mixed ^ mixed >> 16;
}

/// The same hash in GLSL. FAR_ADD adds the hash of a word to the variable `sum` of the shader.
inline constexpr char kEchoGlsl[] = R"glsl(
uint far_mixed(uint word, uint place) {
  uint mixed = word ^ place * 0x9e3779b9u;
  mixed = (mixed ^ mixed >> 16) * 0x85ebca6bu;
  mixed = (mixed ^ mixed >> 13) * 0xc2b2ae35u;
  return mixed ^ mixed >> 16;
}
#define FAR_ADD(place, word) sum += far_mixed((word), (place));
)glsl";

/// The sum of the hashes of some words with their positions.
struct GlEcho {
  std::uint32_t sum = 0;
  std::uint32_t place = 0;  // position of the next word

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
