// SPDX-License-Identifier: Apache-2.0
// The programmed burn on the grid as painted: where it is lit, which way it goes, when it is over.
#pragma once
#include "cfd/build.h"

namespace bw::cfd {

/// Checks that the burn begins in explosive, finds ways around corners if straight lines leave the explosive (path =
/// "auto"), and sets when everything is burnt. InputError otherwise. Collective.
void light(Model& m, const Case& cs);

}  // namespace bw::cfd
