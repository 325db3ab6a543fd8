#include "core/gl_objects.h"

#include <algorithm>

#include "core/error.h"
#include "core/gl_context.h"

namespace farcull {
namespace {

constexpr const char* kReport = "report this driver's log with the output of `farcull doctor`";

// Shaders write out and inout parameters through these names, so that kernels compile as C++ too
// (core/glsl_shim.h).
constexpr const char* kKernelNames =
    "#define FAR_OUT(type) out type\n#define FAR_INOUT(type) inout type\n#define FAR_PRECISE "
    "precise\n#define FAR_FIXED(x) (x)\n#define FAR_KERNEL\n";

template <class Get, class Log>
std::string log_of(GLuint object, Get get, Log log) {
  GLint length = 0;
  get(object, GL_INFO_LOG_LENGTH, &length);
  std::string text(static_cast<std::size_t>(std::max(length, 1)), '\0');
  log(object, length, nullptr, text.data());
  while (!text.empty() && (text.back() == '\0' || text.back() == '\n')) text.pop_back();
  return text;
}

}  // namespace

GlProgram gl_program(const std::string& name, const std::vector<std::string>& defines,
                     const std::vector<ShaderText>& stages) {
  GlProgram program(glCreateProgram());
  for (const ShaderText& stage : stages) {
    std::string text = std::string("#version 430 core\n") + kKernelNames;
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
  if (bytes < 16) {
    glBufferData(GL_SHADER_STORAGE_BUFFER, 16, nullptr, GL_STREAM_DRAW);
    if (bytes > 0 && data)
      glBufferSubData(GL_SHADER_STORAGE_BUFFER, 0, static_cast<GLsizeiptr>(bytes), data);
  } else {
    glBufferData(GL_SHADER_STORAGE_BUFFER, static_cast<GLsizeiptr>(bytes), data, GL_STREAM_DRAW);
  }
}

}  // namespace farcull
