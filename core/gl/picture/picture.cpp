// Draws a picture at several times its resolution. The CPU averages the texels of each pixel.
#include "core/gl/picture/picture.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/base/error.h"
#include "core/gl/base/objects.h"

namespace farcull {
namespace {

// Draws triangles whose colours were computed on the CPU. Each corner has x, y and depth in
// normalized device coordinates, and a colour (RGBA8 in 32 bits).
constexpr char kTriangles[] = R"glsl(
#ifdef FAR_VERTEX
layout(std430, binding = 0) readonly buffer Corners { uvec4 corners[]; };

flat out vec4 v_colour;

void main() {
  uvec4 corner = corners[gl_VertexID];
  v_colour = unpackUnorm4x8(corner.w);
  gl_Position = vec4(uintBitsToFloat(corner.xyz), 1.0);
}
#else
flat in vec4 v_colour;
out vec4 o_colour;

void main() { o_colour = v_colour; }
#endif
)glsl";

// Direction to the light, which is behind, above and left of the viewer. x: right, y: up, z: away.
const Vec3 kLight = Vec3(-0.45, 0.60, -0.66).normalized();
constexpr double kAmbient = 0.42;
constexpr std::size_t kBatch = 1 << 18;  // largest number of corners in one upload

struct Corner {
  float x, y, z;
  std::uint32_t colour;
};
static_assert(sizeof(Corner) == 16);

std::uint32_t packed(const Rgba& colour, double light) {
  const auto channel = [light](std::uint8_t c) {
    return static_cast<std::uint32_t>(std::lround(std::clamp(c * light, 0.0, 255.0)));
  };
  return channel(colour.r) | channel(colour.g) << 8 | channel(colour.b) << 16 | 255u << 24;
}

// Returns the factor by which light scales a triangle's colour. Both sides of the triangle have the
// same factor. Returns 1 for a degenerate triangle, which has no normal.
double light_on(const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 normal = (b - a).cross(c - a);
  const double length = normal.norm();
  if (!(length > 0) || !std::isfinite(length)) return 1;
  // Ambient light keeps surfaces at grazing angles from being nearly black.
  const double facing = std::abs(normal.dot(kLight)) / length;
  return kAmbient + (1.08 - kAmbient) * facing;
}

// Collects the corners of triangles, and draws them when a batch is full.
class Batch {
 public:
  Batch(const Window& window, GLuint buffer) : window_(window), buffer_(buffer) {
    corners_.reserve(kBatch);
  }

  void add(const std::array<Vec3, 3>& world, const PictureTriangle& how) {
    Window region = window_;
    const double reach = 2 + how.outline;
    region.lo.head<2>() = -0.5 * Eigen::Vector2d(window_.width, window_.height).array() - reach;
    region.hi.head<2>() = -region.lo.head<2>();
    const Patch patch = clip_to_region(region, world);
    if (!patch.drawable() || patch.count == 0) return;
    const double light = how.shaded ? light_on(window_.map * (world[0] - window_.origin),
                                               window_.map * (world[1] - window_.origin),
                                               window_.map * (world[2] - window_.origin))
                                    : 1;
    colour_ = packed(how.colour, light);
    lift_ = how.lift;
    for (int i = 2; i < patch.count; ++i)
      put({patch.corners[0], patch.corners[i - 1], patch.corners[i]});
    if (how.outline > 0) {
      for (int i = 0; i < patch.count; ++i)
        strip(patch.corners[i], patch.corners[(i + 1) % patch.count], 0.5 * how.outline);
    }
  }

  void draw() {
    if (corners_.empty()) return;
    gl_fill(buffer_, corners_.data(), corners_.size() * sizeof(Corner));
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, buffer_);
    glDrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>(corners_.size()));
    corners_.clear();
  }

 private:
  // Adds a rectangle: the segment from a to b, widened by `half` px on all sides.
  void strip(const Vec3& a, const Vec3& b, double half) {
    Eigen::Vector2d along = (b - a).head<2>();
    const double length = along.norm();
    along = length > 0 ? Eigen::Vector2d(along * (half / length)) : Eigen::Vector2d(half, 0);
    const Vec3 forth(along[0], along[1], 0), aside(-along[1], along[0], 0);
    const Vec3 p = a - forth - aside, q = b + forth - aside, r = b + forth + aside,
               s = a - forth + aside;
    put({p, q, r});
    put({p, r, s});
  }

  void put(const std::array<Vec3, 3>& triangle) {
    if (corners_.size() + 3 > kBatch) draw();
    const double depth = window_.hi[2] - window_.lo[2];
    for (const Vec3& p : triangle) {
      corners_.push_back({static_cast<float>(2 * p[0] / window_.width),
                          static_cast<float>(2 * p[1] / window_.height),
                          static_cast<float>(2 * (p[2] - lift_ - window_.lo[2]) / depth - 1),
                          colour_});
    }
  }

  const Window& window_;
  GLuint buffer_;
  std::vector<Corner> corners_;
  std::uint32_t colour_ = 0;
  double lift_ = 0;
};

// Averages samples x samples texels for each pixel. The first row of `texels` is the bottom row.
Image filtered(const std::vector<Rgba>& texels, int width, int height, int samples) {
  Image out(width, height, {0, 0, 0, 0});
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      unsigned r = 0, g = 0, b = 0, covered = 0;
      for (int j = 0; j < samples; ++j) {
        const std::size_t row = static_cast<std::size_t>(height - 1 - y) * samples + j;
        const Rgba* texel = &texels[(row * width + x) * samples];
        for (int i = 0; i < samples; ++i, ++texel) {
          if (texel->a == 0) continue;
          r += texel->r, g += texel->g, b += texel->b, ++covered;
        }
      }
      if (covered == 0) continue;
      const unsigned all = static_cast<unsigned>(samples * samples);
      const auto mean = [](unsigned sum, unsigned of) {
        return static_cast<std::uint8_t>((sum + of / 2) / of);
      };
      out.at(x, y) = {mean(r, covered), mean(g, covered), mean(b, covered),
                      mean(255 * covered, all)};
    }
  }
  return out;
}

// Returns the window with its depth range extended to contain all triangles, even those outside the
// window.
Window deepened(Window window, const Scene& scene, std::span<const PictureTriangle> triangles) {
  const Window before = window;
  for (const PictureTriangle& t : triangles) {
    for (const Vec3& corner : scene.corners(t.triangle)) {
      const double z = to_pixel(before, corner).p[2];
      if (!std::isfinite(z)) continue;
      window.lo[2] = std::min(window.lo[2], z - 1);
      window.hi[2] = std::max(window.hi[2], z + 1);
    }
  }
  return window;
}

}  // namespace

Image draw_picture(const GlContext& context, const Scene& scene, const Window& window,
                   std::span<const PictureTriangle> triangles, int samples) {
  const int width = window.width * samples, height = window.height * samples;
  const std::string size = std::to_string(width) + " x " + std::to_string(height) + " samples";
  if (samples < 1) throw std::logic_error("draw_picture: no samples");
  const GlCurrent current(context);
  if (std::max(width, height) >
      std::min(context.info().max_texture_size, context.info().max_viewport)) {
    throw Error("GL picture", "the device has no room for " + size,
                "choose a smaller picture or another {device}");
  }
  const GlProgram program = gl_program("picture", {},
                                       {{GL_VERTEX_SHADER, {"#define FAR_VERTEX\n", kTriangles}},
                                        {GL_FRAGMENT_SHADER, {kTriangles}}});
  const GlVertexArray vertex_array = gl_make<GlVertexArray>(glGenVertexArrays);
  const GlBuffer buffer = gl_make<GlBuffer>(glGenBuffers);
  const GlTexture colours = gl_texture(GL_RGBA8, width, height);
  const GlTexture depths = gl_texture(GL_DEPTH_COMPONENT32F, width, height);
  const GlFramebuffer frame = gl_make<GlFramebuffer>(glGenFramebuffers);
  glBindFramebuffer(GL_FRAMEBUFFER, frame);
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, colours, 0);
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, depths, 0);
  const GLenum status = glCheckFramebufferStatus(GL_FRAMEBUFFER);
  check_gl("picture of " + size);
  if (status != GL_FRAMEBUFFER_COMPLETE) {
    throw Error("GL picture", "the device refuses a target of " + size,
                "choose a smaller picture or another {device}");
  }
  glViewport(0, 0, width, height);
  glDisable(GL_CULL_FACE);
  glDisable(GL_BLEND);
  glEnable(GL_DEPTH_CLAMP);  // draws lifted triangles even outside the depth range
  glEnable(GL_DEPTH_TEST);
  glDepthMask(GL_TRUE);
  glDepthRange(0, 1);
  glDepthFunc(GL_LEQUAL);
  glClearDepth(1);
  glClearColor(0, 0, 0, 0);
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  glUseProgram(program);
  glBindVertexArray(vertex_array);

  const Window deep = deepened(window, scene, triangles);
  Batch batch(deep, buffer);
  for (const PictureTriangle& t : triangles) batch.add(scene.corners(t.triangle), t);
  batch.draw();

  std::vector<Rgba> texels(static_cast<std::size_t>(width) * height);
  glPixelStorei(GL_PACK_ALIGNMENT, 4);
  glReadPixels(0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, texels.data());
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  check_gl("picture");
  return filtered(texels, window.width, window.height, samples);
}

}  // namespace farcull
