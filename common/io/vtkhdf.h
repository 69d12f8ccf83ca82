// SPDX-License-Identifier: Apache-2.0
// Field files that ParaView 5.11 and newer open directly: one VTKHDF 1.0 file per output time, and a .vtkhdf.series of
// true times. Every rank of the Comm calls; files appear under their name only when they are complete.
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "common/io/hdf5.h"
#include "common/math/tensor.h"

namespace bw {

/// Values of one name on cells or points: `components` numbers each (1: scalar, 3: vector, 6: symmetric tensor).
/// Doubles are stored as 32-bit floats unless `exact`.
struct VtkField {
  std::string name;
  int components = 1;
  std::variant<std::span<const double>, std::span<const float>, std::span<const int64_t>, std::span<const int32_t>,
               std::span<const uint8_t>>
      values;
  bool exact = false;

  static VtkField scalars(std::string name, std::span<const double> values) { return {std::move(name), 1, values}; }
  static VtkField vectors(std::string name, std::span<const Vec3> values) {
    return {std::move(name), 3, std::span<const double>(&values.data()->x, 3 * values.size())};
  }
  static VtkField integers(std::string name, std::span<const int64_t> values) { return {std::move(name), 1, values}; }
  static VtkField integers(std::string name, std::span<const int32_t> values) { return {std::move(name), 1, values}; }
};

enum class VtkCell : uint8_t { vertex = 1, line = 3, triangle = 5, quad = 9, tetrahedron = 10, hexahedron = 12 };

/// This rank's part of an unstructured grid; node numbers count within the part.
struct VtkMesh {
  std::span<const Vec3> points;
  std::vector<int64_t> connectivity;
  std::vector<int64_t> offsets{0};  ///< [cells + 1] into connectivity
  std::vector<VtkCell> types;       ///< [cells]

  void add_cell(VtkCell type, std::span<const int64_t> nodes);
  /// `count` hexahedra of 8 node numbers each, convertible to int64_t.
  template <class Hexes>
  void add_hexahedra(const Hexes& hexes) {
    for (const auto& hex : hexes) {
      for (const auto& node : hex) connectivity.push_back(int64_t(node));
      offsets.push_back(int64_t(connectivity.size()));
      types.push_back(VtkCell::hexahedron);
    }
  }
};

void write_vtkhdf(const std::string& path, const VtkMesh& mesh, const std::vector<VtkField>& point_fields,
                  const std::vector<VtkField>& cell_fields, const Comm& comm = {});

/// One level of nested uniform grids. Level 0 covers the whole domain; cells under a finer level hold restricted
/// values.
struct VtkLevel {
  Vec3 spacing;
  /// This rank's boxes of cells in the level's own counting: ilo, ihi, jlo, jhi, klo, khi, both ends belong to the box.
  std::vector<std::array<int32_t, 6>> boxes;
  /// Cell values, box after box, i fastest. The same names on every level.
  std::vector<VtkField> fields;
};

/// `origin`: lower corner of cell (0, 0, 0) of every level.
void write_vtkhdf(const std::string& path, const Vec3& origin, const std::vector<VtkLevel>& levels,
                  const Comm& comm = {});

/// Names the field files of one run and keeps their times: <folder>/<stem>_000012.vtkhdf and
/// <folder>/<stem>.vtkhdf.series.
class VtkSeries {
 public:
  VtkSeries(std::string folder, std::string stem) : folder_(std::move(folder)), stem_(std::move(stem)) {}
  /// Where the next file goes.
  std::string next_path() const;
  /// That file is complete: it enters the series with its time [s]. Call it on every rank; the root writes.
  void add(double t, const Comm& comm = {});
  /// After a restart: goes on with the series on disk, dropping entries later than t.
  void resume(double t);
  int count() const { return int(times_.size()); }

 private:
  std::string name_of(int i) const;
  std::string folder_, stem_;
  std::vector<double> times_;
};

}  // namespace bw
