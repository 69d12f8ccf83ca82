// SPDX-License-Identifier: Apache-2.0
#include "csd/element/levels.h"

#include <algorithm>
#include <cmath>

#include "common/parallel/loop.h"
#include "csd/element/time_step.h"

namespace bw::csd {
namespace {

/// [block] the largest bound of an element's frequency [1/s].
std::vector<double> frequencies(const Elements& el, const TimeStep& time_step, const State& s) {
  std::vector<double> omega(size_t(el.blocks.block_count()));
  for_blocks(el.blocks, [&](int block, int) {
    double worst = 0;
    for (int l = 0; l < lanes; ++l) worst = std::fmax(worst, time_step.omega2(s, SlotId(block * lanes + l)));
    omega[size_t(block)] = std::sqrt(worst);
  });
  return omega;
}

/// level = at most `step` above the lowest around each node.
void limit_to_neighbours(const Blocks& blocks, size_t nodes, int step, std::vector<uint8_t>& level) {
  std::vector<uint8_t> lowest(nodes, 255);
  const auto for_corners_of = [&](const auto& visit) {
    for (int block = 0; block < blocks.block_count(); ++block)
      for (int i = 0; i < 8 * lanes; ++i) visit(level[size_t(block)], lowest[size_t(blocks.nodes_of(block)[i])]);
  };
  for_corners_of([](uint8_t own, uint8_t& at_node) { at_node = std::min(at_node, own); });
  for_corners_of([&](uint8_t& own, uint8_t at_node) { own = uint8_t(std::min<int>(own, at_node + step)); });
}

}  // namespace

std::vector<uint8_t> choose_levels(const Elements& el, const TimeStep& time_step, const State& s) {
  const int most = s.local.most;
  constexpr double to_stay = 1.02, to_rise = 1.15;  // times the longer step
  const std::vector<double> omega = frequencies(el, time_step, s);
  const double worst = *std::max_element(omega.begin(), omega.end());
  std::vector<uint8_t> level(omega.size());
  for (size_t block = 0; block < omega.size(); ++block) {
    const double ratio = omega[block] > 0 ? worst / omega[block] : 1e300;  // of its step to the shortest
    const auto within = [&](double margin) {
      return std::clamp(int(std::floor(std::log2(std::fmax(ratio / margin, 1)))), 0, most);
    };
    level[block] = uint8_t(std::max(within(to_rise), std::min(s.local.level_of_block(int(block)), within(to_stay))));
  }
  limit_to_neighbours(el.blocks, s.x.size(), 0, level);
  for (int i = 1; i < most; ++i) limit_to_neighbours(el.blocks, s.x.size(), 1, level);
  return level;
}

}  // namespace bw::csd
