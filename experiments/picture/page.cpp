// Makes HTML pages that show a scene in a browser. A page contains the files of web/, JSON data and
// blocks of packed numbers (packed_numbers()). The JSON data refers to the blocks by name.
#include "experiments/picture/picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>

#include "commit.h"
#include "core/base/bytes.h"
#include "embedded/clash_html.h"
#include "embedded/clash_js.h"
#include "embedded/frame_html.h"
#include "embedded/page_css.h"
#include "embedded/page_html.h"
#include "embedded/page_js.h"
#include "embedded/page_view_js.h"
#include "experiments/record/output.h"
#include "experiments/record/tables.h"
#include "experiments/scenes/mesh/scene_build.h"
#include "experiments/scenes/mesh/text.h"
#include "experiments/system/text_table.h"
#include "verify/contact.h"

#if FARCULL_WITH_THREE

// Embeds the bytes of the file `path` between the symbols farcull_NAME and farcull_NAME_end. Uses
// the assembler, since a compiler would need minutes for an array of these bytes.
#define FARCULL_EMBED(name, path)          \
  asm(".pushsection .rodata\n"             \
      "farcull_" #name ": .incbin \"" path \
      "\"\n"                               \
      "farcull_" #name                     \
      "_end:\n"                            \
      ".popsection\n");                    \
  extern "C" const char farcull_##name[], farcull_##name##_end[];

FARCULL_EMBED(three, FARCULL_THREE)
FARCULL_EMBED(three_controls, FARCULL_THREE_CONTROLS)
FARCULL_EMBED(three_licence, FARCULL_THREE_LICENCE)

#endif

namespace farcull {
namespace {

using nlohmann::json;

// The files of three.js, a WebGL library for browsers (Debian's libjs-three), as embedded in the
// program. All members are empty if the program was built without three.js.
struct ThreeJs {
  std::string_view library;   // three.min.js
  std::string_view controls;  // OrbitControls.js: moves the camera by mouse and touch
  std::string_view licence;   // copyright and licence of three.js, as Debian gives them
};

ThreeJs three_js() {
#if FARCULL_WITH_THREE
  return {.library = {farcull_three, farcull_three_end},
          .controls = {farcull_three_controls, farcull_three_controls_end},
          .licence = {farcull_three_licence, farcull_three_licence_end}};
#else
  return {};
#endif
}

std::string base64_of(const std::string& bytes) {
  return to_base64({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
}

json colour(const Rgba& c) { return {c.r, c.g, c.b}; }

json vector(const Vec3& v) { return {v[0], v[1], v[2]}; }

Error too_large(const std::string& what, std::uint64_t count, std::uint64_t most) {
  return Error("--html",
               fmt::format("the scene has {} {}, and a page holds at most {}", grouped(count), what,
                           grouped(most)),
               "leave objects out, or draw the flat picture alone, with -o");
}

// Returns JSON text for a script element. Escapes '<', since "</script>" would end the element.
std::string for_script(const json& data) {
  std::string out;
  for (const char c : data.dump(-1, ' ', true, json::error_handler_t::replace))
    out += c == '<' ? std::string("\\u003c") : std::string(1, c);
  return out;
}

void require_size(const Scene& scene) {
  if (scene.triangles.empty())
    throw Error(scene.name, "it has no triangles to draw", "give a scene that has some");
  if (scene.triangles.size() > kMostPageTriangles)
    throw too_large("triangles", scene.triangles.size(), kMostPageTriangles);
  if (scene.objects.size() > kMostPageObjects)
    throw too_large("objects", scene.objects.size(), kMostPageObjects);
}

// Data blocks of a page. Each block is a script element of type text/plain, which is not executed.
struct PageBlocks {
  // Adds a block and returns its name.
  std::string add(const std::string& block) {
    const std::string name = fmt::format("block-{}", count++);
    text += fmt::format("<script type=\"text/plain\" id=\"{}\">", name) + block + "</script>\n";
    return name;
  }

  std::string text;
  int count = 0;
};

json page_box(const Box& box) {
  const Vec3 extent = 0.5 * box.hi - 0.5 * box.lo;
  const double largest = extent.maxCoeff();
  return {{"lo", vector(box.lo)},
          {"hi", vector(box.hi)},
          {"ratio", vector(largest > 0 ? Vec3(extent / largest) : Vec3(1, 1, 1))}};
}

// Returns vertices (rounded by quantized()), triangles and objects as JSON. Adds blocks for arrays.
json frame_of(const Scene& scene, const Box& box, PageBlocks& blocks) {
  json objects = json::array();
  for (const Object& object : scene.objects)
    objects.push_back({object.name, object.first_triangle, object.triangle_count});
  std::vector<std::uint32_t> corners;
  for (const auto& triangle : scene.triangles)
    corners.insert(corners.end(), triangle.begin(), triangle.end());
  const std::string positions = blocks.add(packed_numbers(quantized(scene.vertices, box)));
  return {{"vertices", scene.vertices.size()},
          {"positions", positions},
          {"objects", objects},
          {"triangles", scene.triangles.size()},
          {"corners", blocks.add(packed_numbers(corners))}};
}

void put(std::string& page, const std::string& mark, std::string_view text) {
  const std::size_t at = page.find(mark);
  if (at == std::string::npos) throw std::logic_error("page without " + mark);
  page.replace(at, mark.size(), text);
}

// Returns a page. Fills web/frame.html with the title, the body, the style, the blocks, three.js,
// page_view.js, the script and the data.
std::string framed_page(std::string_view title, std::string_view body, const PageBlocks& blocks,
                        const json& about, std::string_view script) {
  const ThreeJs three = three_js();
  std::string page = embedded::frame_html;
  put(page, "<!--TITLE-->", title);
  put(page, "<!--BODY-->", body);
  put(page, "/*STYLE*/", embedded::page_css);
  put(page, "<!--BLOCKS-->", blocks.text);
  put(page, "<!--LICENCE-->", three.licence);
  put(page, "/*THREE*/", three.library);
  put(page, "/*CONTROLS*/", three.controls);
  put(page, "/*VIEW*/", embedded::page_view_js);
  put(page, "/*PAGE*/", script);
  put(page, "{/*ABOUT*/}", for_script(about));
  return page;
}

class PageMaker {
 public:
  PageMaker(const PageArguments& arguments, MeasurementContext& lab)
      : arguments_(arguments), lab_(lab) {
    const Scene& scene = open_scene(arguments_.picture, lab_);
    require_size(scene);
    box_ = bounds(scene);
    const std::vector<TrianglePair>& pairs = lab_.truth().pairs;
    if (pairs.size() > kMostPagePairs)
      throw too_large("colliding pairs", pairs.size(), kMostPagePairs);
    frame_ = frame_of(scene, box_, blocks_);
    std::vector<std::uint32_t> a, b;
    for (const TrianglePair& pair : pairs) {
      a.push_back(pair.a);
      b.push_back(pair.b);
    }
    // One byte per pair: the kind of contact, as an index into the JSON array `contacts`.
    std::string contacts;
    for (const ContactKind kind : contact_kinds(scene, pairs)) contacts += static_cast<char>(kind);
    frame_["a"] = blocks_.add(packed_numbers(a));
    frame_["b"] = blocks_.add(packed_numbers(b));
    frame_["contacts"] = blocks_.add(packed_bytes(contacts));
    for (const RunOptions& options : arguments_.steps) {
      require_scene(scene, options.method);
      step(scene, options, pairs);
    }
  }

  PageResult finish(const PictureResult& flat) {
    const View view = camera(arguments_.picture);
    json objects = json::array();
    for (const Rgba& c : kObjectColours) objects.push_back(colour(c));
    json contacts = json::array();
    for (const ContactKind kind : kContactKinds) contacts.push_back(name_of(kind));
    json about = {{"title", flat.scene},
                  {"hash", flat.scene_hash},
                  {"commit", FARCULL_COMMIT},
                  {"command", command_of(arguments_.picture)},
                  {"notAsked", flat.not_asked},
                  {"forward", vector(view.rows.row(2))},
                  {"worldUp", vector(world_up())},
                  {"zoom", arguments_.picture.zoom},
                  {"contacts", contacts},
                  {"colours",
                   {{"missed", colour(kMissedColour)},
                    {"found", colour(kFoundColour)},
                    {"idle", colour(kIdleColour)},
                    {"idlePart", kIdlePart},
                    {"through", kThrough},
                    {"objects", objects}}},
                  {"frame", frame_},
                  {"steps", steps_}};
    about.update(page_box(box_));
    PageResult out;
    out.steps = results_;
    std::string body = embedded::page_html;
    put(body, "FLAT", "data:image/png;base64," + base64_of(to_png(flat.image, flat.texts)));
    out.html = framed_page("Collisions by farcull", body, blocks_, about, embedded::page_js);
    return out;
  }

 private:
  // Returns the direction that stays upward on the screen while the reader rotates the scene.
  Vec3 world_up() const {
    const View view = camera(arguments_.picture);
    const std::string& up = arguments_.picture.up;
    const Vec3 given = parse_view(up.empty() ? "y" : up).rows.row(2);
    // If `given` is parallel to the viewing direction, camera() has chosen another up direction.
    return given.cross(Vec3(view.rows.row(2))).norm() < 1e-6 ? Vec3(view.rows.row(1)) : given;
  }

  void step(const Scene& scene, const RunOptions& options, const std::vector<TrianglePair>& pairs) {
    const MethodAnswer answer = answer_of(options, scene, lab_);
    const PanelResult& result = answer.result;
    json entry = {{"method", method_title(options)},
                  {"resolution", draws(options.method) ? resolution_of(options) : 0},
                  {"title", result.title},
                  {"headline", result.headline},
                  {"missedPairs", result.missed},
                  {"missedTriangles", result.missed_triangles},
                  {"culls", culls(options.method)},
                  {"idle", result.idle},
                  {"device", result.device}};
    if (!answer.missed.empty()) {
      std::vector<std::uint32_t> lost;
      for (const TrianglePair& pair : answer.missed) {
        const auto at = std::lower_bound(pairs.begin(), pairs.end(), pair);
        lost.push_back(static_cast<std::uint32_t>(at - pairs.begin()));
      }
      entry["missed"] = blocks_.add(packed_numbers(lost));
    }
    if (!answer.idle.empty())
      entry["kept"] = blocks_.add(packed_bytes(bits_of(answer.idle, scene.triangles.size())));
    steps_.push_back(entry);
    results_.push_back(result);
  }

  const PageArguments& arguments_;
  MeasurementContext& lab_;
  Box box_ = Box::empty();
  PageBlocks blocks_;
  json frame_, steps_ = json::array();
  std::vector<PanelResult> results_;
};

// Returns the JSON data of a row. Appends the end points of the row's line segments to `segments`.
json row_of(const Scene& scene, const ClashRow& row, const Box& box, std::vector<Vec3>& segments) {
  // If the parts do not intersect, adds the segment between two nearest points of the parts.
  std::vector<std::array<Vec3, 2>> lines = row.segments;
  if (row.squared && !row.inner) lines.push_back(row.witness);
  const std::size_t first = segments.size();
  for (const auto& ends : lines) segments.insert(segments.end(), ends.begin(), ends.end());
  const std::vector<Vec3> corners = {row.box.lo, row.box.hi};
  json out = {{"a", row.objects.a},
              {"b", row.objects.b},
              {"verdict", to_string(row.verdict)},
              {"exact", to_string(row.exact)},
              {"ignored", row.ignored},
              {"what", clash_words(scene, row)},
              {"depth", nullptr},
              {"curve", row.curve},
              {"distance", row.squared ? json(row.distance) : json(nullptr)},
              {"at", point_json(row.witness[0])},
              {"inner", json_of(row.inner)},
              {"box", quantized(corners, box)},
              {"segments", {first / 2, lines.size()}}};
  if (row.depth) out["depth"] = {row.depth->lo, row.depth->hi};
  return out;
}

}  // namespace

std::string packed_bytes(std::string_view bytes) { return base64_of(gzip(bytes)); }

std::string packed_numbers(std::span<const std::uint32_t> numbers) {
  const std::size_t n = numbers.size();
  std::string planes(4 * n, '\0');
  std::uint32_t before = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const std::uint32_t difference = numbers[i] - before;
    before = numbers[i];
    const std::uint32_t sign = difference >> 31 != 0 ? ~std::uint32_t{0} : 0;
    const std::uint32_t zigzag = difference << 1 ^ sign;
    for (std::size_t byte = 0; byte < 4; ++byte)
      planes[byte * n + i] = static_cast<char>(zigzag >> 8 * byte & 255);
  }
  return packed_bytes(planes);
}

std::string bits_of(std::span<const std::uint32_t> numbers, std::size_t count) {
  std::string out((count + 7) / 8, '\0');
  for (const std::uint32_t number : numbers)
    out[number / 8] = static_cast<char>(out[number / 8] | 1 << number % 8);
  return out;
}

std::vector<std::uint32_t> quantized(std::span<const Vec3> points, const Box& box) {
  constexpr double kSteps = 65535;
  std::vector<std::uint32_t> out;
  out.reserve(3 * points.size());
  for (int axis = 0; axis < 3; ++axis) {
    // Halves all values, since the extent of the box may exceed the largest double.
    const double lo = 0.5 * box.lo[axis], extent = 0.5 * box.hi[axis] - lo;
    for (const Vec3& p : points) {
      const double part = extent > 0 ? std::clamp((0.5 * p[axis] - lo) / extent, 0.0, 1.0) : 0;
      out.push_back(static_cast<std::uint32_t>(std::lround(kSteps * part)));
    }
  }
  return out;
}

std::vector<RunOptions> at_resolutions(const std::vector<RunOptions>& panels,
                                       std::vector<int> resolutions) {
  std::sort(resolutions.begin(), resolutions.end());
  resolutions.erase(std::unique(resolutions.begin(), resolutions.end()), resolutions.end());
  std::vector<RunOptions> out;
  std::set<std::string> titles;
  for (RunOptions options : panels) {
    std::vector<int> of_method = {options.resolution};
    if (draws(options.method)) of_method = resolutions;
    for (const int resolution : of_method) {
      options.resolution = resolution;
      if (titles.insert(panel_title(options)).second) out.push_back(options);
    }
  }
  return out;
}

void require_three() {
  if (!three_js().library.empty()) return;
  throw Error("--html", "this farcull was built without three.js, which shows the page",
              "install libjs-three (Debian) and build farcull again, or give -o alone");
}

void require_page_size(const PageArguments& arguments, MeasurementContext& lab) {
  require_size(open_scene(arguments.picture, lab));
}

PageResult make_page(const PageArguments& arguments, const PictureResult& flat,
                     MeasurementContext& lab) {
  require_three();
  return PageMaker(arguments, lab).finish(flat);
}

void require_clash_page(const Scene& scene) {
  require_three();
  require_size(scene);
}

std::string clash_page(const Scene& scene, const ClashRecord& record, const std::string& unit) {
  require_clash_page(scene);
  const Box box = bounds(scene);
  PageBlocks blocks;
  json frame = frame_of(scene, box, blocks);
  const std::string none = blocks.add(packed_numbers({}));
  frame["a"] = frame["b"] = frame["contacts"] = none;
  json rows = json::array();
  std::vector<Vec3> segments;
  for (const ClashRow& row : record.rows) rows.push_back(row_of(scene, row, box, segments));
  json about = page_box(box);
  about.update(
      json{{"title", scene.name},
           {"commit", FARCULL_COMMIT},
           {"unit", unit},
           {"asked", record.asked},
           {"examined", record.examined},
           {"clean", is_clean(record)},
           {"forward", {-0.55, 0.7, -0.45}},
           {"worldUp", {0, 0, 1}},
           {"zoom", false},
           {"rows", rows},
           {"segments", blocks.add(packed_numbers(quantized(segments, box)))},
           {"frame", frame},
           // People with colour blindness can distinguish these colours. No colour is green.
           {"colours",
            {{"found", {0, 0, 0}},
             {"missed", {0, 0, 0}},
             {"idle", {232, 128, 16}},
             {"idlePart", 1},
             {"through", 0},
             {"objects", json(8, {60, 120, 216})}}}});
  return framed_page("Clashes by farcull", embedded::clash_html, blocks, about, embedded::clash_js);
}

}  // namespace farcull
