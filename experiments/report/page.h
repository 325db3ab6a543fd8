// The report as one page of HTML that needs nothing else: figures as SVG within it, pictures as
// data, no script, nothing from a network.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "experiments/report/chapters/chapter.h"

namespace farcull {

struct DrawnPicture {
  Picture picture;
  std::string png;       // empty: there is none
  bool page = false;     // whether there is a page of it, pages/NAME.html
  std::string left_out;  // why
};

/// A chapter with all that was made for it.
struct DrawnChapter {
  Chapter chapter;
  StoredStudy stored;
  std::vector<std::string> svgs;  // one for each figure
  std::vector<DrawnPicture> pictures;
};

struct Page {
  std::string store;    // its path, as given
  std::string commit;   // of the program that reports
  std::string written;  // UTC, ISO 8601
  std::vector<std::pair<std::int64_t, Provenance>> runs;
  std::vector<DrawnChapter> chapters;
};

/// Marks index.html as written by this program.
inline constexpr const char* kPageMark = "<meta name=\"generator\" content=\"farcull report\">";

std::string page_html(const Page& page);

}  // namespace farcull
