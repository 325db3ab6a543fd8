// The JSON of `farcull check --frames`.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "experiments/system/output_file.h"

namespace farcull {

/// A record whose frames are added one by one; its text is that of ordered_json::dump(2).
class FrameChecks {
 public:
  using Json = nlohmann::ordered_json;

  explicit FrameChecks(std::string path) : output_(std::move(path)) {}
  void add(const Json& frame, const Json& summary) {
    const std::string before = std::exchange(begun_, true) ? ",\n    " : "{\n  \"frames\": [\n    ";
    output_.add(before + indented(frame, "    "),
                "\n  ],\n  \"summary\": " + indented(summary, "  ") + "\n}\n");
  }
  void finish() { output_.finish(); }

 private:
  static std::string indented(const Json& json, const std::string& by) {
    std::string out;
    for (const char c : json.dump(2)) {
      out += c;
      if (c == '\n') out += by;
    }
    return out;
  }

  GrowingOutput output_;
  bool begun_ = false;
};

}  // namespace farcull
