// SPDX-License-Identifier: Apache-2.0
// The modules of a run. What a case doesn't use is absent: an empty list or optional costs one test per step.
#pragma once
#include <optional>
#include <vector>

#include "csd/cracks.h"
#include "csd/element/elements.h"
#include "csd/element/filter.h"
#include "csd/element/time_step.h"
#include "csd/energy.h"
#include "csd/fragments/contact.h"
#include "csd/fragments/rigid.h"
#include "csd/load/conditions/list.h"
#include "csd/load/loads.h"
#include "csd/load/mass_scaling.h"
#include "csd/load/relaxation.h"

namespace bw::csd {

struct Physics {
  Elements elements;
  TimeStep time_step;
  BulkViscosity viscosity;
  Resting resting;
  std::optional<PressureFilter> filter;
  std::optional<Loads> loads;
  std::vector<ConditionKind> conditions;
  std::optional<Relaxation> relaxation;
  std::optional<MassScaling> mass_scaling;
  std::optional<Cracks> cracks;
  std::optional<Rigid> rigid;
  std::optional<Contact> contact;
  EnergyBooks energy;
};

/// [node] Held by a condition: all but rigid walls, springs and drag.
std::vector<char> held_nodes(const Physics& ph, const Mesh& mesh);

}  // namespace bw::csd
