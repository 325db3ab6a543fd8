// A contestant in C++ (docs/ask.md). Replace meets() by a call of your library.
#include <algorithm>
#include <array>
#include <cstdlib>
#include <iostream>
#include <sstream>
#include <string>
#include <vector>

using Point = std::array<double, 3>;
using Triangle = std::array<Point, 3>;

static Point minus(const Point& a, const Point& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
static Point cross(const Point& a, const Point& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
static double dot(const Point& a, const Point& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

// False if one of 17 directions separates the triangles, in rounded doubles.
static bool meets(const Triangle& a, const Triangle& b) {
  const auto edges = [](const Triangle& t) {
    return Triangle{minus(t[1], t[0]), minus(t[2], t[1]), minus(t[0], t[2])};
  };
  const Triangle ea = edges(a), eb = edges(b);
  const Point na = cross(ea[0], ea[1]), nb = cross(eb[0], eb[1]);
  std::vector<Point> directions = {na, nb};
  for (int i = 0; i < 3; ++i) {
    directions.insert(directions.end(), {cross(na, ea[i]), cross(nb, eb[i])});
    for (int k = 0; k < 3; ++k) directions.push_back(cross(ea[i], eb[k]));
  }
  return std::none_of(directions.begin(), directions.end(), [&](const Point& d) {
    const auto [a0, a1] = std::minmax({dot(d, a[0]), dot(d, a[1]), dot(d, a[2])});
    const auto [b0, b1] = std::minmax({dot(d, b[0]), dot(d, b[1]), dot(d, b[2])});
    return a1 < b0 || b1 < a0;
  });
}

int main() {
  for (std::string line; std::getline(std::cin, line);) {
    std::istringstream fields(line);
    std::string number, question, shared, word;
    fields >> number >> question;
    if (question == "card") {
      for (const char* row :
           {"card\tname\tseparate-cpp", "card\tlibrary\tan example", "card\tanswers\tpair", "done"})
        std::cout << number << '\t' << row << '\n';
    } else if (question == "pair") {
      fields >> shared;
      std::array<Triangle, 2> both;
      for (int i = 0; i < 18 && fields >> word; ++i)
        both[i / 9][i % 9 / 3][i % 3] = std::strtod(word.c_str(), nullptr);
      std::cout << number << '\t' << (meets(both[0], both[1]) ? 1 : 0) << '\n';
    } else {
      std::cout << number << "\trefused\tit answers pairs alone\n";
    }
    std::cout.flush();
  }
}
