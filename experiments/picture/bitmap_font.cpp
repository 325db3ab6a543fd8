// Each letter is a table of 5 x 9 dots; strokes join neighbouring dots, and every pixel is covered
// by its distance to the nearest stroke.
#include "experiments/picture/bitmap_font.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <utility>
#include <vector>

namespace farcull {
namespace {

constexpr int kColumns = 5;  // of a letter's dots
constexpr int kAdvance = 6;  // columns from letter to letter
constexpr int kCapital = 7;  // rows above the baseline; up to two more are below it
constexpr double kPen = 0.42, kBoldPen = 0.62;  // radius of the stroke in dots

// From blank to ~, rows from the top of a capital letter; rows that are not there are empty.
// clang-format off
constexpr std::array<std::string_view, 95> kLetters = {
    "",                                                               // blank
    "..#../..#../..#../..#../..#../...../..#..",                      // !
    ".#.#./.#.#.",                                                    // "
    ".#.#./.#.#./#####/.#.#./#####/.#.#./.#.#.",                      // #
    "..#../.####/#.#../.###./..#.#/####./..#..",                      // $
    "##..#/##..#/...#./..#../.#.../#..##/#..##",                      // %
    ".##../#..#./#.#../.#.../#.#.#/#..#./.##.#",                      // &
    "..#../..#..",                                                    // '
    "...#./..#../.#.../.#.../.#.../..#../...#.",                      // (
    ".#.../..#../...#./...#./...#./..#../.#...",                      // )
    "...../..#../#.#.#/.###./#.#.#/..#..",                            // *
    "...../..#../..#../#####/..#../..#..",                            // +
    "...../...../...../...../...../..#../..#../.#...",                // ,
    "...../...../...../.###.",                                        // -
    "...../...../...../...../...../...../..#..",                      // .
    "....#/....#/...#./..#../.#.../#..../#....",                      // /
    ".##../#..#./#..#./#..#./#..#./#..#./.##..",                      // 0
    "..#../.##../..#../..#../..#../..#../.###.",                      // 1
    ".###./#...#/....#/...#./..#../.#.../#####",                      // 2
    ".###./#...#/....#/..##./....#/#...#/.###.",                      // 3
    "...#./..##./.#.#./#..#./#####/...#./...#.",                      // 4
    "#####/#..../####./....#/....#/#...#/.###.",                      // 5
    "..##./.#.../#..../####./#...#/#...#/.###.",                      // 6
    "#####/....#/...#./..#../..#../.#.../.#...",                      // 7
    ".###./#...#/#...#/.###./#...#/#...#/.###.",                      // 8
    ".###./#...#/#...#/.####/....#/...#./.##..",                      // 9
    "...../...../..#../...../...../...../..#..",                      // :
    "...../...../..#../...../...../..#../..#../.#...",                // ;
    "...../...#./..#../.#.../..#../...#.",                            // <
    "...../...../#####/...../#####",                                  // =
    "...../.#.../..#../...#./..#../.#...",                            // >
    ".###./#...#/....#/...#./..#../...../..#..",                      // ?
    ".###./#...#/#.###/#.#.#/#.##./#..../.###.",                      // @
    "..#../.#.#./#...#/#...#/#####/#...#/#...#",                      // A
    "####./#...#/#...#/####./#...#/#...#/####.",                      // B
    ".###./#...#/#..../#..../#..../#...#/.###.",                      // C
    "####./#...#/#...#/#...#/#...#/#...#/####.",                      // D
    "#####/#..../#..../####./#..../#..../#####",                      // E
    "#####/#..../#..../####./#..../#..../#....",                      // F
    ".###./#...#/#..../#.###/#...#/#...#/.###.",                      // G
    "#...#/#...#/#...#/#####/#...#/#...#/#...#",                      // H
    ".###./..#../..#../..#../..#../..#../.###.",                      // I
    "...##/....#/....#/....#/....#/#...#/.###.",                      // J
    "#...#/#..#./#.#../##.../#.#../#..#./#...#",                      // K
    "#..../#..../#..../#..../#..../#..../#####",                      // L
    "#...#/##.##/#.#.#/#.#.#/#...#/#...#/#...#",                      // M
    "#...#/#...#/##..#/#.#.#/#..##/#...#/#...#",                      // N
    ".###./#...#/#...#/#...#/#...#/#...#/.###.",                      // O
    "####./#...#/#...#/####./#..../#..../#....",                      // P
    ".###./#...#/#...#/#...#/#.#.#/#..#./.##.#",                      // Q
    "####./#...#/#...#/####./#.#../#..#./#...#",                      // R
    ".####/#..../#..../.###./....#/....#/####.",                      // S
    "#####/..#../..#../..#../..#../..#../..#..",                      // T
    "#...#/#...#/#...#/#...#/#...#/#...#/.###.",                      // U
    "#...#/#...#/#...#/#...#/#...#/.#.#./..#..",                      // V
    "#...#/#...#/#...#/#.#.#/#.#.#/#.#.#/.#.#.",                      // W
    "#...#/#...#/.#.#./..#../.#.#./#...#/#...#",                      // X
    "#...#/#...#/.#.#./..#../..#../..#../..#..",                      // Y
    "#####/....#/...#./..#../.#.../#..../#####",                      // Z
    ".###./.#.../.#.../.#.../.#.../.#.../.###.",                      // [
    "#..../#..../.#.../..#../...#./....#/....#",                      // backslash
    ".###./...#./...#./...#./...#./...#./.###.",                      // ]
    "..#../.#.#./#...#",                                              // ^
    "...../...../...../...../...../...../...../#####",                // _
    ".#.../..#..",                                                    // `
    "...../...../.###./....#/.####/#...#/.####",                      // a
    "#..../#..../####./#...#/#...#/#...#/####.",                      // b
    "...../...../.###./#...#/#..../#...#/.###.",                      // c
    "....#/....#/.####/#...#/#...#/#...#/.####",                      // d
    "...../...../.###./#...#/#####/#..../.###.",                      // e
    "..##./.#.../####./.#.../.#.../.#.../.#...",                      // f
    "...../...../.####/#...#/#...#/#...#/.####/....#/.###.",          // g
    "#..../#..../####./#...#/#...#/#...#/#...#",                      // h
    "..#../...../.##../..#../..#../..#../.###.",                      // i
    "...#./...../..##./...#./...#./...#./...#./...#./.##..",          // j
    "#..../#..../#..#./#.#../##.../#.#../#..#.",                      // k
    ".##../..#../..#../..#../..#../..#../.###.",                      // l
    "...../...../####./#.#.#/#.#.#/#.#.#/#.#.#",                      // m
    "...../...../####./#...#/#...#/#...#/#...#",                      // n
    "...../...../.###./#...#/#...#/#...#/.###.",                      // o
    "...../...../####./#...#/#...#/#...#/####./#..../#....",          // p
    "...../...../.####/#...#/#...#/#...#/.####/....#/....#",          // q
    "...../...../#.##./##..#/#..../#..../#....",                      // r
    "...../...../.####/#..../.###./....#/####.",                      // s
    ".#.../.#.../####./.#.../.#.../.#.../..##.",                      // t
    "...../...../#...#/#...#/#...#/#...#/.####",                      // u
    "...../...../#...#/#...#/#...#/.#.#./..#..",                      // v
    "...../...../#...#/#.#.#/#.#.#/#.#.#/.#.#.",                      // w
    "...../...../#...#/.#.#./..#../.#.#./#...#",                      // x
    "...../...../#...#/#...#/#...#/#...#/.####/....#/.###.",          // y
    "...../...../#####/...#./..#../.#.../#####",                      // z
    "...##/..#../..#../.#.../..#../..#../...##",                      // {
    "..#../..#../..#../..#../..#../..#../..#..",                      // |
    "##.../..#../..#../...#./..#../..#../##...",                      // }
    "...../...../.#.../#.#.#/...#.",                                  // ~
};
// clang-format on

struct Stroke {
  double x0, y0, x1, y1;  // dots; y down from the top row
};

bool dot(std::string_view letter, int column, int row) {
  if (column < 0 || column >= kColumns || row < 0) return false;
  const std::size_t at = static_cast<std::size_t>(row) * (kColumns + 1) + column;
  return at < letter.size() && letter[at] == '#';
}

// From each dot to the next ones to the right and below, and across where no such way leads round.
std::vector<Stroke> strokes_of(std::string_view letter) {
  std::vector<Stroke> out;
  for (int y = 0; y < kCapital + 2; ++y) {
    for (int x = 0; x < kColumns; ++x) {
      if (!dot(letter, x, y)) continue;
      out.push_back({x + 0.0, y + 0.0, x + 0.0, y + 0.0});
      if (dot(letter, x + 1, y)) out.push_back({x + 0.0, y + 0.0, x + 1.0, y + 0.0});
      if (dot(letter, x, y + 1)) out.push_back({x + 0.0, y + 0.0, x + 0.0, y + 1.0});
      for (const int side : {-1, 1}) {
        if (dot(letter, x + side, y + 1) && !dot(letter, x + side, y) && !dot(letter, x, y + 1))
          out.push_back({x + 0.0, y + 0.0, x + side + 0.0, y + 1.0});
      }
    }
  }
  return out;
}

double distance_to(const Stroke& s, double x, double y) {
  const double dx = s.x1 - s.x0, dy = s.y1 - s.y0;
  const double length2 = dx * dx + dy * dy;
  const double t =
      length2 > 0 ? std::clamp(((x - s.x0) * dx + (y - s.y0) * dy) / length2, 0.0, 1.0) : 0.0;
  return std::hypot(x - s.x0 - t * dx, y - s.y0 - t * dy);
}

double dot_size(const TextStyle& style) { return style.height / kCapital; }

// The letters to draw, as places in kLetters.
std::vector<std::size_t> letters_of(const std::string& text) {
  std::vector<std::size_t> out;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if ((byte & 0xc0) == 0x80) continue;
    out.push_back(byte >= ' ' && byte <= '~' ? byte - ' ' : '?' - ' ');
  }
  return out;
}

}  // namespace

double text_width(const std::string& text, const TextStyle& style) {
  const std::size_t letters = letters_of(text).size();
  if (letters == 0) return 0;
  return dot_size(style) * (static_cast<double>(letters) * kAdvance - (kAdvance - kColumns));
}

void draw_text(Image& image, double x, double baseline, const std::string& text,
               const TextStyle& style) {
  const double unit = dot_size(style);
  const double pen = style.bold ? kBoldPen : kPen;
  double left = x;
  for (const std::size_t letter : letters_of(text)) {
    const std::vector<Stroke> strokes = strokes_of(kLetters[letter]);
    // The middle of the first dot.
    const double ox = left + 0.5 * unit, oy = baseline - (kCapital - 0.5) * unit;
    const int x0 = std::max(0, static_cast<int>(left - unit));
    const int x1 = std::min(image.width, static_cast<int>(left + kAdvance * unit + 1));
    const int y0 = std::max(0, static_cast<int>(oy - unit - 1));
    const int y1 = std::min(image.height, static_cast<int>(baseline + 3 * unit));
    for (int py = y0; !strokes.empty() && py < y1; ++py) {
      for (int px = x0; px < x1; ++px) {
        const double u = (px + 0.5 - ox) / unit, v = (py + 0.5 - oy) / unit;
        double nearest = HUGE_VAL;
        for (const Stroke& s : strokes) nearest = std::min(nearest, distance_to(s, u, v));
        const double coverage = std::clamp((pen - nearest) * unit + 0.5, 0.0, 1.0);
        if (coverage > 0) blend(image.at(px, py), style.colour, coverage);
      }
    }
    left += kAdvance * unit;
  }
}

std::string text_that_fits(const std::string& text, const TextStyle& style, double width) {
  if (text_width(text, style) <= width) return text;
  std::string cut = text;
  while (!cut.empty() && text_width(cut + "..", style) > width) cut.pop_back();
  return cut + "..";
}

}  // namespace farcull
