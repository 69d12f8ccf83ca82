// SPDX-License-Identifier: Apache-2.0
#include "cfd/start/profile.h"

#include <fmt/format.h>

#include <filesystem>

#include "cfd/output.h"
#include "common/app/error.h"
#include "common/io/hdf5.h"

namespace bw::cfd {
namespace {

constexpr const char* kind = "breakwave profile along a radius, 1";

double shift_of(const EosChoice& eos) {
  const Jwl* jwl = std::get_if<Jwl>(&eos);
  return jwl ? jwl->e_shift : 0;
}

}  // namespace

std::vector<double> probe_materials(const Medium& medium) {
  std::vector<double> values;
  for (int m = 0; m < medium.count(); ++m)
    std::visit(
        [&](const auto& eos) {
          const double dense = eos.range().rho_max / 1.7;
          for (const double rho : {dense, 0.1 * dense, 1e-3 * dense})
            for (const double p : {1e5, 1e9}) values.push_back(internal_energy(eos, rho, p) + shift_of(medium.eos[m]));
        },
        medium.eos[m]);
  return values;
}

double Profile::reach() const {
  const auto& last = U.back();
  const int rows = Cons::rows(int(materials.size()));
  double size[Cons::most] = {};
  for (const auto& u : U)
    for (int q = 0; q < rows; ++q) size[q] = std::max(size[q], std::abs(u[size_t(q)]));
  double rho = last[0] + last[1];
  for (size_t k = 2; k < materials.size(); ++k) rho += last[size_t(Cons::arho(int(k)))];
  const double energy = std::abs(last[Cons::rhoE]);
  size_t i = U.size();
  const auto differs = [&](size_t shell) {
    for (int q = 0; q < rows; ++q) {
      const double least = 1e-9 * (q == Cons::mom                       ? std::sqrt(rho * energy)
                                   : q == Cons::rhoE                    ? energy
                                   : q > Cons::mom && q < Cons::rhoE    ? 0
                                   : Cons::is_alpha(q)                  ? 1
                                                                        : rho);
      if (std::abs(U[shell][size_t(q)] - last[size_t(q)]) > least) return true;
    }
    return false;
  };
  while (i > 0 && !differs(i - 1)) --i;
  return i == 0 ? r[1] : r[i];
}

void write_profile(const std::string& path, const Model& m) {
  const Forest& forest = m.forest;
  const BlockShape& s = forest.shape();
  std::vector<double> rows;
  for (int b = 0; b < forest.local_blocks(); ++b)
    for (int i = 0; i < s.n[0]; ++i) {
      const int64_t number = forest.first_cell(b)[0] + i;
      for (const int64_t face : {number, number + 1}) rows.push_back(forest.size().lower.x + double(face) * s.h.x);
      for (int q = 0; q < m.state.rows(); ++q) {
        double u = m.state.block(b, q)[i];
        if (q == Cons::rhoE)
          for (int k = 0; k < std::max(m.setup.medium.count(), 2); ++k) u += m.state.block(b, Cons::arho(k))[i] * shift_of(m.setup.medium.eos[k]);
        rows.push_back(u);
      }
    }
  const auto& burn = m.setup.burn;
  const bool burning = burn && m.state.t < burn->t_all && stored_energy(m) > 1e-9 * burn->q * m.explosive_mass;
  const h5::File file = h5::File::create(path, forest.comm());
  const h5::Group root = file.root();
  std::string names;
  for (const std::string& name : m.setup.medium.names) names += (names.empty() ? "" : "\n") + name;
  root.attribute("kind", std::string(kind));
  root.attribute("materials", names);
  root.attribute("geometry", int32_t(s.geometry));
  root.attribute("time", m.state.t);
  root.attribute("burning", int32_t(burning));
  root.attribute("probes", std::span<const double>(probe_materials(m.setup.medium)));
  root.write("shells", rows, 2 + m.state.rows());
}

Profile read_profile(const std::string& path, const std::string& place) {
  const auto wrong = [&](const std::string& text) { return InputError(fmt::format("{}: {}", place, text)); };
  if (!std::filesystem::exists(path))
    throw wrong(fmt::format("expected a file fluid_profile.h5, there is no {}", path));
  Profile p;
  p.file = path;
  std::vector<double> rows;
  try {
    const h5::File file = h5::File::open(path);
    const h5::Group root = file.root();
    if (root.read_text_attribute("kind") != kind) throw std::runtime_error("it is of another kind");
    if (root.read_attribute<int32_t>("burning").at(0))
      throw std::runtime_error(fmt::format("its explosive is not burnt through at its end, {:g} s: run it longer",
                                           root.read_attribute<double>("time").at(0)));
    p.geometry = Geometry(root.read_attribute<int32_t>("geometry").at(0));
    p.t = root.read_attribute<double>("time").at(0);
    p.probes = root.read_attribute<double>("probes");
    const std::string names = root.read_text_attribute("materials");
    for (size_t at = 0; at <= names.size();) {
      const size_t end = std::min(names.find('\n', at), names.size());
      p.materials.push_back(names.substr(at, end - at));
      at = end + 1;
    }
    if (p.materials.size() > size_t(most_materials)) throw std::runtime_error("it has too many materials");
    if (root.shape("shells")[1] != 2 + Cons::rows(int(p.materials.size()))) throw std::runtime_error("its rows have another length");
    rows = root.read<double>("shells");
  } catch (const std::runtime_error& e) {
    throw wrong(fmt::format("expected the profile that a run along a radius leaves, {}: {}", path, e.what()));
  }
  p.r.push_back(rows.at(0));
  const size_t variables = size_t(Cons::rows(int(p.materials.size())));
  for (size_t i = 0; i < rows.size(); i += 2 + variables) {
    p.r.push_back(rows[i + 1]);
    std::copy_n(rows.begin() + ptrdiff_t(i) + 2, variables, p.U.emplace_back().begin());
  }
  return p;
}

}  // namespace bw::cfd
