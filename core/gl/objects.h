// Move-only GL objects: a name that is deleted with its owner. Only core/gl includes this.
#pragma once

#include <epoxy/gl.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace farcull {

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

inline void delete_buffer(GLuint name) { glDeleteBuffers(1, &name); }
inline void delete_texture(GLuint name) { glDeleteTextures(1, &name); }
inline void delete_framebuffer(GLuint name) { glDeleteFramebuffers(1, &name); }
inline void delete_vertex_array(GLuint name) { glDeleteVertexArrays(1, &name); }
inline void delete_program(GLuint name) { glDeleteProgram(name); }
inline void delete_query(GLuint name) { glDeleteQueries(1, &name); }

using GlBuffer = GlName<delete_buffer>;
using GlTexture = GlName<delete_texture>;
using GlFramebuffer = GlName<delete_framebuffer>;
using GlVertexArray = GlName<delete_vertex_array>;
using GlProgram = GlName<delete_program>;
using GlQuery = GlName<delete_query>;

template <class Object>
Object gl_make(void (*generate)(GLsizei, GLuint*)) {
  GLuint name = 0;
  generate(1, &name);
  return Object(name);
}

/// Compiles and links "#version 430 core", `defines` (one #define line each) and the texts of each
/// stage. Throws Error with the driver's log and the name.
struct ShaderText {
  GLenum stage;
  std::vector<std::string> texts;
};
GlProgram gl_program(const std::string& name, const std::vector<std::string>& defines,
                     const std::vector<ShaderText>& stages);

/// Replaces the contents of a shader storage buffer (at least 16 bytes long, so that it can always
/// be bound).
void gl_fill(GLuint buffer, const void* data, std::size_t bytes);

/// A number that no other call in the process has returned, before the first 2^32 of them.
std::uint32_t gl_number();

/// Bytes of a storage buffer that stand before its data: its tag and three words 0.
constexpr std::size_t kTagBytes = 16;

/// A shader storage buffer that grows and never shrinks. It begins with a tag, a number that no
/// other buffer of the process has: a program that reads it knows that this buffer is bound.
/// Programs declare it as { uvec4 tag; T data[]; }; offsets here count from the data. Every
/// function asks GL whether the buffer is bound before it touches contents, so that a lost binding
/// cannot spoil another buffer. Each throws Error where GL fails.
class GlStore {
 public:
  /// Grows to hold `wanted` bytes of data, up to half as much again within `most`. True where the
  /// contents are lost: they are undefined then. The store is as before where it throws.
  bool reserve(std::size_t wanted, std::size_t most);
  void write(std::size_t at, const void* data, std::size_t bytes);
  /// Zeros, from the beginning; a multiple of 4.
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

/// Waits until the device has done all that it was told. Throws Error naming `stage` where that
/// takes longer than kLongestWait, or the device cannot say.
void gl_wait(const std::string& stage);
constexpr int kLongestWait = 600;  // s

}  // namespace farcull
