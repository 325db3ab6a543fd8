// The parts that all pages share: blocks of data, the triangles of a scene, and the final scripts.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "core/scene/scene.h"

namespace farcull {

/// Blocks of a page, each a script element that browsers do not run.
class PageBlocks {
 public:
  /// Returns the name of the new block.
  std::string add(const std::string& text);
  const std::string& text() const { return text_; }

 private:
  std::string text_;
  int count_ = 0;
};

/// Throws Error naming --html if a page cannot hold the scene.
void require_page_size(const Scene& scene);

/// The size of the box for the reader: its corners, and its extents relative to the largest.
nlohmann::json page_box(const Box& box);
/// The vertices, rounded in the box.
nlohmann::json page_vertices(const Scene& scene, const Box& box, PageBlocks& blocks);
/// Adds the objects and the triangles to page_vertices().
void add_page_triangles(const Scene& scene, PageBlocks& blocks, nlohmann::json& frame);

/// A page: web/frame.html with the title, the body, the style, the blocks, three.js, page_view.js,
/// the page's own script and its data.
std::string framed_page(std::string_view title, std::string_view body, const PageBlocks& blocks,
                        const nlohmann::json& about, std::string_view script);

}  // namespace farcull
