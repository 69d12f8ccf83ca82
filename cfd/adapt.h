// SPDX-License-Identifier: Apache-2.0
// The grid follows the flow.
#pragma once
#include "cfd/books.h"

namespace bw::cfd {

/// Splits and joins blocks as the case's rules want and carries the state over; true if any block changed. Between
/// steps; cheap when nothing is to be done, nothing at all without [fluid.amr]. Collective.
bool adapt(Model& m, Sweep& sweep, Books& books);

/// At the start: the same without a state to carry over. True if the grid changed: paint it again.
bool adapt_unpainted(Model& m);

}  // namespace bw::cfd
