// SPDX-License-Identifier: Apache-2.0
#include "cfd/adapt.h"

#include <algorithm>

#include "cfd/amr/transfer.h"
#include "common/app/timers.h"
#include "common/parallel/loop.h"

namespace bw::cfd {
namespace {

const Burn* burn_of(const Model& m) { return m.setup.burn ? &*m.setup.burn : nullptr; }

/// Changes the leaves; the origins of the new ones if any changed on any rank.
std::vector<Origin> change_leaves(Model& m, const std::vector<Asks>* asks) {
  exchange_state(m.forest, m.state);
  const RefineInput in{m.forest, m.state, m.setup.boundary, m.setup.medium, burn_of(m), m.walls ? &*m.walls : nullptr, asks};
  std::vector<int8_t> wishes;
  {
    Timed timed("looking");
    wishes = refine_wishes(in, *m.refine);
  }
  const auto any = [&](bool mine) { return m.forest.comm().max(int64_t(mine)) > 0; };
  if (!any(std::any_of(wishes.begin(), wishes.end(), [](int8_t w) { return w != 0; }))) return {};
  std::vector<Origin> origins = m.forest.adapt(wishes);
  if (!any(std::any_of(origins.begin(), origins.end(), [](const Origin& o) { return o.change != 0; }))) return {};
  return origins;
}

/// Traces of materials that averaging left are removed and booked; what is known of the new blocks.
void admit(Model& m, const std::vector<int>& blocks) {
  parallel_for_dynamic(int64_t(blocks.size()), [&](int64_t i) {
    const int b = blocks[size_t(i)];
    const std::vector<uint8_t> blocked = blocked_cells(m, b);
    UpdateInput in{&m.setup.medium, burn_of(m), false, m.state.t, m.state.t, true};
    in.blocked = blocked.empty() ? nullptr : blocked.data();
    const int materials = m.setup.medium.count();
    Patch patch(m.forest.shape(b), materials);
    patch.lower = m.forest.lower(b);
    std::vector<uint8_t> marks;
    m.state.info[size_t(b)] = update_block(in, patch, m.state.block(b), BlockChange(m.forest.shape(b), materials),
                                           m.state.spare(b), marks, m.state.booked[size_t(b)])
                                  .info;
    m.state.flip(b);
  });
}

}  // namespace

bool adapt(Model& m, Sweep& sweep, Books& books) {
  if (!m.refine || m.state.step % m.refine->every != 0) return false;
  Timed timed("regrid");
  const std::vector<Origin> origins = change_leaves(m, sweep.asks());
  if (m.forest.comm().max(int64_t(origins.size())) == 0) return false;
  Timed moving("carrying over");
  transfer_state(m.forest, {m.setup.medium, m.setup.boundary, burn_of(m)}, origins, m.state);
  if (m.forest.settle())
    move_state(m.forest, m.state);
  else
    m.state.fit(m.forest);
  std::vector<int> all, changed;
  for (int b = 0; b < m.forest.local_blocks(); ++b) {
    all.push_back(b);
    if (m.state.info[size_t(b)].rate < 0) changed.push_back(b);
  }
  admit(m, changed);
  sweep.fit();
  books.fit(m);
  books.refresh(m, all);
  return true;
}

bool adapt_unpainted(Model& m) {
  const std::vector<Origin> origins = change_leaves(m, nullptr);
  if (m.forest.comm().max(int64_t(origins.size())) == 0) return false;
  m.forest.settle();
  m.state.fit(m.forest);
  return true;
}

}  // namespace bw::cfd
