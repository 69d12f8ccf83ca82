// SPDX-License-Identifier: Apache-2.0
// Flows of three and more materials: what a contact keeps, what a box keeps, and that neither the order in which
// materials are named nor their splitting into copies matters.
#include <algorithm>
#include <cmath>

#include "tests/unit/cfd/whole_flow.h"

namespace bw::cfd {
namespace {

struct Named {
  std::string name, eos;
};
const Named tnt{"products", "library = \"TNT\"\n"}, water{"water", "library = \"water\"\n"},
    air{"air", "library = \"air\"\n"}, dense{"dense", "eos = {kind = \"noble_abel\", gamma = 1.27, covolume = 1e-3}\n"};

std::string materials(const std::vector<Named>& list) {
  std::string text;
  for (const Named& m : list) text += "[[fluid.material]]\nname = \"" + m.name + "\"\n" + m.eos;
  return text;
}
std::string region(const std::string& shape, const std::string& name, double density, double pressure,
                   const std::string& velocity = "[0, 0, 0]") {
  return fmt::format(
      "[[fluid.region]]\nshape = {{{}}}\nmaterial = \"{}\"\ndensity = {}\npressure = {}\nvelocity = {}\n", shape, name,
      density, pressure, velocity);
}
std::string between(double from, double to) {
  return fmt::format("kind = \"box\", lower = [{}, -1, -1], upper = [{}, 2, 2]", from, to);
}
std::string ball(double x, double y, double z, double radius) {
  return fmt::format("kind = \"sphere\", centre = [{}, {}, {}], radius = {}", x, y, z, radius);
}
const std::string everywhere = "kind = \"everywhere\"";

/// Where material `name` stands in the flow (an explosive that burns is moved to the front).
int place_of(const Flow& f, const std::string& name) {
  const auto& names = f.m.setup.medium.names;
  return int(std::find(names.begin(), names.end(), name) - names.begin());
}
/// Sums over cells of all ranks of the mass of a material.
double mass_of(const Flow& f, const std::string& name) { return f.sums().U[Cons::arho(place_of(f, name))]; }

/// Largest departure of sum alpha from 1.
double volume_error(const Flow& f) {
  double worst = 0;
  for (int b : f.all())
    for (int c = 0; c < f.m.forest.shape().cells(); ++c) {
      double sum = 0;
      for (int k = 0; k < f.m.setup.medium.count(); ++k) sum += f.m.state.block(b, Cons::alpha(k))[c];
      worst = std::max(worst, std::abs(sum - 1));
    }
  return worst;
}
/// Most materials in one cell.
int most_in_a_cell(const Flow& f) {
  int most = 0;
  for (int b : f.all())
    for (int c = 0; c < f.m.forest.shape().cells(); ++c) {
      int here = 0;
      for (int k = 0; k < f.m.setup.medium.count(); ++k) here += f.m.state.block(b, Cons::alpha(k))[c] > 0;
      most = std::max(most, here);
    }
  return most;
}
/// Largest difference of two flows' p and rho over the cells, in their own size.
double difference(const Flow& a, const Flow& b) {
  double worst = 0;
  for (int block : a.all())
    for (int c = 0; c < a.m.forest.shape().cells(); ++c) {
      const auto state = [&](const Flow& f, double& rho, double& p) {
        double U[Cons::most], W[Prim::most];
        for (int q = 0; q < f.m.state.rows(); ++q) U[q] = f.m.state.block(block, q)[c];
        std::visit([&](const auto& mix) { mix.to_primitive(U, W, Floors{}); }, f.m.setup.medium.mixture);
        rho = f.m.setup.medium.density(U), p = W[Prim::p];
      };
      double rho_a, rho_b, p_a, p_b;
      state(a, rho_a, p_a), state(b, rho_b, p_b);
      worst = std::max({worst, std::abs(rho_a / rho_b - 1), std::abs(p_a / p_b - 1)});
    }
  return worst;
}

/// A layer of products one and a half cells wide between water and air, all carried along: no cell sees two alone.
std::string carried(const std::vector<Named>& list) {
  const std::string v = "[500, 300, 0]";
  return grid("[64, 16, 1]", "[1, 0.25, 0.1]", periodic_sides) + materials(list) +
         region(everywhere, "air", 1.225, 101325, v) + region(between(0.2, 0.5), "water", 1000, 101325, v) +
         region(between(0.5, 0.523), "products", 50, 101325, v) + region(between(0.523, 0.55), "dense", 300, 101325, v);
}

TEST(ManyMaterials, ContactsKeepPressureAndVelocity) {
  Flow f(carried({tnt, water, air, dense}));
  f.steps(150);
  const Departure worst = departure(f, 500, 500);
  EXPECT_LT(worst.p, 1e-8);  // water's 2.6e9 Pa cancel to 1e5: round-off of 3e-12 a step
  EXPECT_LT(worst.v, 1e-10);
  EXPECT_LT(volume_error(f), 1e-13);
  EXPECT_GE(most_in_a_cell(f), 4);
}

/// Products in air beside water, bursting, in a closed box.
std::string burst(const std::vector<Named>& list, const std::string& amr = "") {
  return grid("[24, 16, 16]", "[0.6, 0.4, 0.4]") + amr + materials(list) + region(everywhere, "air", 1.225, 101325) +
         region(between(0.33, 1), "water", 1000, 101325) + region(ball(0.25, 0.2, 0.18, 0.07), "products", 400, 2e8);
}

TEST(ManyMaterials, OrderDoesNotMatter) {
  Flow first(burst({tnt, water, air})), second(burst({air, tnt, water})), third(burst({water, air, tnt}));
  for (Flow* f : {&first, &second, &third}) f->steps(25, 1e-6);
  EXPECT_EQ(most_in_a_cell(first), 3);
  EXPECT_LT(difference(first, second), 1e-9);
  EXPECT_LT(difference(first, third), 1e-9);
}

TEST(ManyMaterials, WhatIsAbsentChangesNothing) {
  const auto text = [](const std::vector<Named>& list) {
    return grid("[24, 16, 16]", "[0.6, 0.4, 0.4]") + materials(list) + region(everywhere, "air", 1.225, 101325) +
           region(ball(0.25, 0.2, 0.18, 0.07), "products", 400, 2e8);
  };
  Flow two(text({tnt, air})), more(text({tnt, air, water, dense})), last(text({water, dense, air, tnt}));
  for (Flow* f : {&two, &more, &last}) f->steps(25, 2e-6);
  EXPECT_LT(difference(two, more), 1e-9);
  EXPECT_LT(difference(two, last), 1e-9);
}

/// Until a wave comes to where a copy meets its original: beyond, each is limited apart.
TEST(ManyMaterials, CopiesAreTheSameMaterial) {
  const Named copy{"more air", "library = \"air\"\n"};
  const std::string tube = grid("[100, 1, 1]", "[1, 0.1, 0.1]"), left = region(between(-1, 0.3), "products", 400, 2e7);
  Flow two(tube + materials({tnt, air}) + region(everywhere, "air", 1.2, 1e5) + left);
  Flow three(tube + materials({tnt, air, copy}) + region(everywhere, "air", 1.2, 1e5) +
             region(between(0.81, 2), "more air", 1.2, 1e5) + left);
  two.steps(50, 1e-6), three.steps(50, 1e-6);
  EXPECT_LT(difference(two, three), 1e-9);
  EXPECT_GT(mass_of(three, "more air"), 0);
}

TEST(ManyMaterials, ClosedBoxWithLevelsKeepsEachMass) {
  Flow f(burst({tnt, water, air}, "amr = {levels = 1, every = 2, refine = 0.5, coarsen = 0.2}\n"));
  const FluidSums before = f.sums();
  f.steps(30);
  const FluidSums after = f.sums();
  const Booked b = f.books.booked(f.m);
  for (int q : {Cons::arho(0), Cons::arho(1), Cons::arho(2), int(Cons::rhoE)})
    EXPECT_NEAR(after.U[q] + b.cleaned[q] - (q == Cons::rhoE ? b.floor_energy : 0), before.U[q], 1e-13 * std::abs(before.U[q])) << q;
  EXPECT_LT(volume_error(f), 1e-13);
  EXPECT_EQ(most_in_a_cell(f), 3);
}

TEST(ManyMaterials, LevelsKeepAContact) {
  const std::string v = "[500, 300, 0]";
  Flow f(grid("[32, 16, 1]", "[1, 0.5, 0.1]", periodic_sides) + "amr = {levels = 1, every = 2, refine = 0.3, coarsen = 0.1}\n" +
         materials({tnt, water, air}) + region(everywhere, "air", 1.225, 101325, v) +
         region(between(0.3, 0.6), "water", 1000, 101325, v) + region(ball(0.6, 0.25, 0, 0.07), "products", 50, 101325, v));
  f.steps(60);
  const Departure worst = departure(f, 500, 500);
  EXPECT_LT(worst.p, 1e-8);
  EXPECT_LT(worst.v, 1e-10);
  EXPECT_EQ(most_in_a_cell(f), 3);
}

TEST(ManyMaterials, OneGasAloneIsStillOne) {
  const std::string below = "kind = \"box\", lower = [-1, -1, 0.6], upper = [2, 2, 3]";
  const std::string text = grid("[16, 16, 160]", "[0.2, 0.2, 2]") + materials({tnt, water, air}) +
                           region(everywhere, "air", 1.225, 101325) + region(below, "water", 1000, 101325) +
                           region(ball(0.1, 0.1, 0.53, 0.04), "products", 400, 2e8);
  Flow f(text);
  f.steps(2);
  std::vector<int> of(4, 0);
  for (int b : f.all()) ++of[size_t(f.m.state.info[size_t(b)].material)];
  EXPECT_GT(of[2], 0);
  EXPECT_GT(of[3], 0);
  expect_rest_is_skipped(text, 4);
  expect_equal_on_threads(text, 4);
}

/// A charge in water with a layer of air around it, along a radius: closed, lit at the centre.
TEST(ManyMaterials, ChargeInWaterAlongARadius) {
  const std::string text =
      "[fluid]\ngeometry = \"spherical\"\nradius = 1\ncells = [100, 1, 1]\n" + materials({air, water, tnt}) +
      region(everywhere, "air", 1.225, 101325) + region(ball(0, 0, 0, 0.7), "water", 1000, 101325) +
      "[[fluid.region]]\nshape = {" + ball(0, 0, 0, 0.1) +
      "}\nmaterial = \"products\"\nunburnt = true\npressure = 101325\n[[fluid.burn]]\nmaterial = \"products\"\npoints = [[0, 0, 0]]\n";
  Flow f(text);
  EXPECT_EQ(place_of(f, "products"), 0);
  const FluidSums before = f.sums();
  const double stored = f.m.setup.burn->q * before.U[Cons::arho1];
  f.steps(150);
  const FluidSums after = f.sums();
  const Booked b = f.books.booked(f.m);
  for (int k = 0; k < 3; ++k)
    EXPECT_NEAR(after.U[Cons::arho(k)] + b.cleaned[Cons::arho(k)], before.U[Cons::arho(k)], 1e-13 * before.U[Cons::arho(k)]) << k;
  EXPECT_GT(f.m.state.t, f.m.setup.burn->t_all);
  EXPECT_NEAR(after.U[Cons::rhoE] + b.cleaned[Cons::rhoE] - b.floor_energy - before.U[Cons::rhoE], stored, 1e-11 * stored);
}

TEST(ManyMaterials, BadInput) {
  const std::string still = region(everywhere, "air", 1.225, 101325), line = grid("[16, 1, 1]", "[1, 1, 1]");
  std::vector<Named> seven;
  for (int i = 0; i < most_materials + 1; ++i) seven.push_back({i == 0 ? "air" : fmt::format("gas {}", i), air.eos});
  expect_wrong(line + materials(seven) + still, "one to 6");
  expect_wrong(line + materials({air, water, air}) + still, "two \"air\"");
  expect_wrong(line + "scheme = {interface = \"sharp\"}\n" + materials({tnt, water, air}) + still, "smooth");
  expect_wrong(line + materials({tnt, water, air}) + region(everywhere, "oil", 1.225, 101325), "products, water, air");
}

}  // namespace
}  // namespace bw::cfd
