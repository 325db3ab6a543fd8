// An assembly of which every answer is known.
#pragma once

#include "experiments/method/clash.h"
#include "tests/lab/parts.h"

namespace farcull::lab {

/// 31 parts, and what is to be said about each pair that is not clear at a clearance of 2.
struct Assembly {
  Parts parts;
  std::map<ObjectPair, ClashVerdict> expected;
  std::map<ObjectPair, double> distances, depths;

  Assembly() {
    using enum ClashVerdict;
    const std::uint32_t lower = parts.add_box("lower", {0, 0, 0}, {100, 60, 5});
    const std::uint32_t upper = parts.add_box("upper", {0, 0, 5}, {100, 60, 10});
    expected[{lower, upper}] = touch;
    for (int k = 0; k < 8; ++k) {
      // A bolt goes through both plates, and has a washer around it.
      const double x = 15 + 22 * (k % 4), y = 15 + 30 * (k / 4);
      const std::string number = std::to_string(k);
      const std::uint32_t bolt =
          parts.add_box("bolt" + number, {x - 2, y - 2, -7}, {x + 2, y + 2, 17});
      const std::uint32_t washer =
          parts.add_ring("washer" + number, {x - 4, y - 4, 10}, {x + 4, y + 4, 11},
                         {x - 2.125, y - 2.125, 10}, {x + 2.125, y + 2.125, 11});
      expected[{lower, bolt}] = expected[{upper, bolt}] = clash;
      depths[{lower, bolt}] = depths[{upper, bolt}] = 12;
      expected[{upper, washer}] = touch;
      expected[{bolt, washer}] = near;
      distances[{bolt, washer}] = 0.125;
    }
    const std::uint32_t block = parts.add_box("block", {200, 0, 0}, {240, 40, 40});
    const std::uint32_t buried = parts.add_box("buried", {210, 10, 10}, {220, 20, 20});
    expected[{block, buried}] = contained;
    depths[{block, buried}] = 20;
    parts.box({300, 0, 0}, {340, 40, 40});
    parts.box({305, 5, 5}, {335, 35, 35}, true);
    parts.end("housing");
    parts.add_box("housed", {310, 10, 10}, {320, 20, 20});
    const std::uint32_t row = parts.add_box("row0", {400, 0, 0}, {410, 10, 10});
    parts.add_box("row1", {410.1, 0, 0}, {420, 10, 10});
    parts.add_box("row2", {422, 0, 0}, {430, 10, 10});
    parts.add_box("row3", {432.0000001, 0, 0}, {440, 10, 10});
    expected[{row, row + 1}] = expected[{row + 1, row + 2}] = near;
    distances[{row, row + 1}] = 410.1 - 410;
    distances[{row + 1, row + 2}] = 2;
    const std::uint32_t flush = parts.add_box("flush0", {500, 0, 0}, {520, 10, 10});
    parts.add_box("flush1", {510, 0, 0}, {530, 10, 10});
    expected[{flush, flush + 1}] = clash;
    depths[{flush, flush + 1}] = 10;
    const std::uint32_t tip = parts.add_tetrahedron(
        "tip0", {Vec3(600, 10, 10), Vec3(604, 10, 10), Vec3(600, 14, 10), Vec3(600, 10, 14)});
    parts.add_tetrahedron(
        "tip1", {Vec3(600, 10, 10), Vec3(596, 10, 10), Vec3(600, 6, 10), Vec3(600, 10, 6)});
    expected[{tip, tip + 1}] = touch;
    parts.box({570, -20, -20}, {630, 40, 40}, false, true);
    const std::uint32_t cover = parts.end("cover");
    expected[{tip, cover}] = expected[{tip + 1, cover}] = unknown;
  }
};

}  // namespace farcull::lab
