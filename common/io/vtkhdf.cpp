// SPDX-License-Identifier: Apache-2.0
#include "common/io/vtkhdf.h"

#include <fmt/format.h>

#include <cstdlib>
#include <fstream>
#include <iterator>

#include "common/app/error.h"
#include "common/io/file.h"
#include "common/io/json.h"

namespace bw {

namespace {

void write_field(const h5::Group& group, const VtkField& field) {
  std::visit(
      [&](const auto& values) {
        using T = std::remove_const_t<typename std::decay_t<decltype(values)>::element_type>;
        if constexpr (std::same_as<T, double>) {
          if (!field.exact) {
            const std::vector<float> rounded(values.begin(), values.end());
            group.write(field.name, rounded, field.components);
            return;
          }
        }
        group.write(field.name, values, field.components);
      },
      field.values);
}

size_t size_of(const VtkField& field) {
  return std::visit([](const auto& values) { return values.size(); }, field.values);
}

h5::Group write_head(const h5::File& file, const std::string& type) {
  const h5::Group root = file.root().group("VTKHDF");
  const int64_t version_1_0[2] = {1, 0};
  root.attribute("Version", std::span<const int64_t>(version_1_0));
  root.attribute("Type", type);
  return root;
}

std::array<double, 3> components(const Vec3& a) { return {a.x, a.y, a.z}; }

/// Writes under a temporary name, then gives the file its own.
template <class Write>
void write_whole(const std::string& path, const Comm& comm, const Write& write) {
  const std::string temporary = path + ".tmp";
  {
    const h5::File file = h5::File::create(temporary, comm);
    write(file);
    file.finish();
  }
  comm.barrier();
  if (comm.root()) rename_finished(temporary, path);
}

}  // namespace

void VtkMesh::add_cell(VtkCell type, std::span<const int64_t> nodes) {
  connectivity.insert(connectivity.end(), nodes.begin(), nodes.end());
  offsets.push_back(int64_t(connectivity.size()));
  types.push_back(type);
}

void write_vtkhdf(const std::string& path, const VtkMesh& mesh, const std::vector<VtkField>& point_fields,
                  const std::vector<VtkField>& cell_fields, const Comm& comm) {
  const size_t points = mesh.points.size(), cells = mesh.types.size();
  BW_CHECK(mesh.offsets.size() == cells + 1 && mesh.offsets.back() == int64_t(mesh.connectivity.size()));
  for (const auto& f : point_fields) BW_CHECK(size_of(f) == points * size_t(f.components));
  for (const auto& f : cell_fields) BW_CHECK(size_of(f) == cells * size_t(f.components));
  write_whole(path, comm, [&](const h5::File& file) {
    const h5::Group root = write_head(file, "UnstructuredGrid");
    // one part per rank, each with its own count of nodes and its own offsets
    root.write("NumberOfPoints", std::vector<int64_t>{int64_t(points)});
    root.write("NumberOfCells", std::vector<int64_t>{int64_t(cells)});
    root.write("NumberOfConnectivityIds", std::vector<int64_t>{int64_t(mesh.connectivity.size())});
    root.write("Points", std::span<const double>(points ? &mesh.points.data()->x : nullptr, 3 * points), 3);
    root.write("Connectivity", mesh.connectivity);
    root.write("Offsets", mesh.offsets);
    root.write("Types", std::span<const uint8_t>(reinterpret_cast<const uint8_t*>(mesh.types.data()), cells));
    const h5::Group point_data = root.group("PointData"), cell_data = root.group("CellData");
    for (const auto& f : point_fields) write_field(point_data, f);
    for (const auto& f : cell_fields) write_field(cell_data, f);
  });
}

void write_vtkhdf(const std::string& path, const Vec3& origin, const std::vector<VtkLevel>& levels, const Comm& comm) {
  for (const VtkLevel& level : levels) {
    size_t cells = 0;
    for (const auto& b : level.boxes)
      cells += size_t(b[1] - b[0] + 1) * size_t(b[3] - b[2] + 1) * size_t(b[5] - b[4] + 1);
    for (const auto& f : level.fields) BW_CHECK(size_of(f) == cells * size_t(f.components));
  }
  write_whole(path, comm, [&](const h5::File& file) {
    const h5::Group root = write_head(file, "OverlappingAMR");
    root.attribute("Origin", std::span<const double>(components(origin)));
    root.attribute("GridDescription", std::string("XYZ"));
    for (size_t i = 0; i < levels.size(); ++i) {
      const VtkLevel& level = levels[i];
      const h5::Group group = root.group(fmt::format("Level{}", i));
      group.attribute("Spacing", std::span<const double>(components(level.spacing)));
      group.write(
          "AMRBox",
          std::span<const int32_t>(level.boxes.empty() ? nullptr : level.boxes[0].data(), 6 * level.boxes.size()), 6);
      group.group("PointData");
      group.group("FieldData");
      const h5::Group cell_data = group.group("CellData");
      for (const auto& f : level.fields) write_field(cell_data, f);
    }
  });
}

std::string VtkSeries::name_of(int i) const { return fmt::format("{}_{:06d}.vtkhdf", stem_, i); }

std::string VtkSeries::next_path() const { return folder_ + "/" + name_of(count()); }

void VtkSeries::add(double t, const Comm& comm) {
  times_.push_back(t);
  if (!comm.root()) return;
  std::vector<JsonObject> files(times_.size());
  for (int i = 0; i < count(); ++i) {
    files[size_t(i)].add("name", name_of(i));
    files[size_t(i)].add("time", times_[size_t(i)]);
  }
  JsonObject json;
  json.add("file-series-version", "1.0");
  json.add("files", files);
  write_atomically(fmt::format("{}/{}.vtkhdf.series", folder_, stem_), json.text() + "\n");
}

void VtkSeries::resume(double t) {
  std::ifstream in(fmt::format("{}/{}.vtkhdf.series", folder_, stem_));
  const std::string text((std::istreambuf_iterator<char>(in)), {}), mark = "\"time\": ";
  times_.clear();
  for (size_t at = text.find(mark); at != std::string::npos; at = text.find(mark, at + 1)) {
    const double time = std::strtod(text.c_str() + at + mark.size(), nullptr);
    if (time <= t) times_.push_back(time);
  }
}

}  // namespace bw
