// Worlds of the model as docs/model.md writes them, and the lines of that page.
#pragma once

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>
#include <string>

#include "tests/core/cull/model.h"

namespace farcull::model {

/// Triangles are a, b, c ...
inline std::string letter(int t) { return {static_cast<char>('a' + t)}; }

inline std::string text_of(const View& view, int n) {
  if (!view.drawn) return " cannot be drawn";
  std::string out;
  for (int t = 0; t < n; ++t) {
    if (view.undrawable & only(t))
      out += " " + letter(t) + "?";
    else if (!(view.shown & only(t)))
      out += " " + letter(t) + "-";
    for (int u = 0; u < n; ++u) {
      if (view.behind[t] & only(u)) out += " " + letter(t) + ">" + letter(u);
    }
  }
  return out.empty() ? " nothing is seen" : out;
}

/// "{a} {b c}; view 1: a>b c?": the owners in order; a is seen against b; c is undrawable. "c-": it
/// has no point in the window.
inline std::string text_of(const World& world, int n) {
  std::string out;
  for (const Set owner : world.owners) {
    out += out.empty() ? "{" : " {";
    std::string members;
    for (int t = 0; t < n; ++t) {
      if (owner & only(t)) members += (members.empty() ? "" : " ") + letter(t);
    }
    out += members + "}";
  }
  for (std::size_t v = 0; v < world.views.size(); ++v)
    out += "; view " + std::to_string(v + 1) + ":" + text_of(world.views[v], n);
  return out;
}

/// Expects that a line of docs/model.md begins so.
inline void expect_on_page(const std::string& text) {
  std::ifstream page(FARCULL_TEST_DIR "/../docs/model.md");
  std::stringstream lines;
  lines << "\n" << page.rdbuf();
  EXPECT_NE(lines.str().find("\n" + text), std::string::npos)
      << "docs/model.md has no line that begins so:\n"
      << text;
}

}  // namespace farcull::model
