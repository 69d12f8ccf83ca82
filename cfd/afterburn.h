// SPDX-License-Identifier: Apache-2.0
// Products that burn on: how far they are after a step.
#pragma once
#include "cfd/build.h"

namespace bw::cfd {

/// Sets when it begins if it follows the programmed burn; InputError if it would begin before that is over.
void begin_afterburn(Model& m);
/// Part of the further energy that is released at the end of a step of dt; 0 without [fluid.afterburn]. Collective.
double share_after(const Model& m, double dt);
/// Energy per mass released in a step that ends with `share` [J/kg].
double afterburn_energy(const Model& m, double share);

}  // namespace bw::cfd
