// SPDX-License-Identifier: Apache-2.0
#include "coupling/record.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <filesystem>

#include "common/app/error.h"
#include "common/io/file.h"

namespace bw::coupling {
namespace {

template <class T>
std::span<const uint8_t> bytes_of(const T& block) {
  return {reinterpret_cast<const uint8_t*>(&block), sizeof block};
}
std::span<const double> flat(const std::vector<Vec3>& a) { return {a.empty() ? nullptr : &a[0].x, 3 * a.size()}; }
std::span<const int32_t> flat(const std::vector<std::array<int32_t, 4>>& a) {
  return {a.empty() ? nullptr : a[0].data(), 4 * a.size()};
}
std::vector<Vec3> points(const std::vector<double>& a) {
  std::vector<Vec3> x(a.size() / 3);
  for (size_t i = 0; i < x.size(); ++i) x[i] = {a[3 * i], a[3 * i + 1], a[3 * i + 2]};
  return x;
}
template <class Block>
std::vector<Block> blocks(const h5::Group& root, const std::string& name) {
  const std::vector<uint8_t> bytes = root.read<uint8_t>(name);
  std::vector<Block> all(bytes.size() / sizeof(Block));
  std::memcpy(static_cast<void*>(all.data()), bytes.data(), all.size() * sizeof(Block));
  return all;
}

/// A file that grows gets its name at once; one of that name stays readable until then.
std::string unfinished(const std::string& path) {
  if (const std::string folder = std::filesystem::path(path).parent_path().string(); !folder.empty())
    make_folder(folder);
  return path + ".new";
}

/// How many windows of an earlier record come before that one: none if the file is missing or another run's.
int64_t windows_before(const std::string& path, int64_t window) {
  if (!std::filesystem::exists(path)) return 0;
  const Record before(path);
  const int64_t first = before.steps().front().window, windows = window - first;
  return windows > 0 && windows <= int64_t(before.loads().size()) ? windows : 0;
}

}  // namespace

Recorder::Recorder(const std::string& path, const HelloBlock& solid, const HelloBlock& fluid)
    : file_(unfinished(path)) {
  file_.table<uint8_t>("hello", sizeof(HelloBlock));
  file_.table<uint8_t>("step", sizeof(StepBlock)), file_.table<uint8_t>("load", sizeof(LoadBlock));
  file_.table<uint8_t>("bye", sizeof(ByeBlock));
  for (const char* name : {"x", "v", "traction"}) file_.table<double>(name, 3);
  for (const char* name : {"p", "impedance"}) file_.table<double>(name, 1);
  for (const char* name : {"node_id", "node_parent", "face_id"}) file_.table<int64_t>(name, 1);
  for (const char* name : {"body", "flags"}) file_.table<int32_t>(name, 1);
  file_.table<int32_t>("quads", 4);
  file_.start();
  const int64_t before = solid.restart_id ? windows_before(path, solid.restart_window) : 0;
  if (before > 0) {
    take_over(path, before);
  } else {
    file_.append("hello", bytes_of(solid)), file_.append("hello", bytes_of(fluid));
    file_.flush();
  }
  std::filesystem::rename(unfinished(path), path);
}

void Recorder::take_over(const std::string& path, int64_t windows) {
  const Record before(path);
  file_.append("hello", bytes_of(before.solid())), file_.append("hello", bytes_of(before.fluid()));
  file_.flush();
  for (size_t i = 0; i < size_t(windows); ++i) {
    asked(before.steps()[i], before.surface(i));
    answered(before.loads()[i], before.load(i));
  }
}

void Recorder::asked(const StepBlock& step, const WetSurface& surface) {
  file_.append("x", flat(surface.x)), file_.append("v", flat(surface.v));
  if (step.flags & step_connectivity) {
    file_.append("quads", flat(surface.quads));
    file_.append("node_id", std::span<const int64_t>(surface.node_id));
    file_.append("node_parent", std::span<const int64_t>(surface.node_parent));
    file_.append("face_id", std::span<const int64_t>(surface.face_id));
    file_.append("body", std::span<const int32_t>(surface.body));
    file_.append("flags", std::span<const int32_t>(surface.flags));
  }
  file_.flush();  // first the rows, then the block that counts them
  file_.append("step", bytes_of(step));
  file_.flush();
}

void Recorder::answered(const LoadBlock& load, const Loads& loads) {
  file_.append("p", std::span<const double>(loads.p));
  file_.append("traction", flat(loads.traction));
  file_.append("impedance", std::span<const double>(loads.impedance));
  file_.flush();
  file_.append("load", bytes_of(load));
  file_.flush();
}

void Recorder::finished(const ByeBlock& bye) {
  file_.append("bye", bytes_of(bye));
  file_.flush();
}

Record::Record(const std::string& path) try : path_(path), file_(h5::File::open(path)) {
  const h5::Group root = file_.root();
  const auto hello = blocks<HelloBlock>(root, "hello");
  if (hello.size() != 2) throw InputError(fmt::format("{}: the record of a run that had not begun", path));
  solid_ = hello[0], fluid_ = hello[1];
  steps_ = blocks<StepBlock>(root, "step"), loads_ = blocks<LoadBlock>(root, "load");
  is_finished_ = root.shape("bye")[0] > 0;
  if (steps_.empty()) throw InputError(fmt::format("{}: the record of a run without a window", path));
  int64_t node = 0, face = 0, traction = 0, impedance = 0, topology_node = 0, topology_face = 0;
  for (size_t i = 0; i < steps_.size(); ++i) {
    first_node_.push_back(node), node += steps_[i].n_nodes;
    if (steps_[i].flags & step_connectivity) {
      topology_nodes_.push_back(topology_node), topology_node += steps_[i].n_nodes;
      topology_faces_.push_back(topology_face), topology_face += steps_[i].n_faces;
    }
    topology_.push_back(int64_t(topology_nodes_.size()) - 1);
    if (i >= loads_.size()) continue;
    const auto rows = [&](uint32_t flag) { return loads_[i].flags & flag ? steps_[i].n_faces : 0; };
    first_face_.push_back(face), face += steps_[i].n_faces;
    first_traction_.push_back(traction), traction += rows(load_traction);
    first_impedance_.push_back(impedance), impedance += rows(load_impedance);
  }
  if (node > root.shape("x")[0] || face > root.shape("p")[0] || topology_face > root.shape("quads")[0])
    throw InputError(fmt::format("{}: the record is damaged: rows are missing", path));
} catch (const std::runtime_error& e) {
  if (dynamic_cast<const InputError*>(&e)) throw;
  throw InputError(fmt::format("{}: no record of a coupled run: {}", path, e.what()));
}

double Record::agreed_end() const {
  if (solid_.t_end > 0 && fluid_.t_end > 0) return std::min(solid_.t_end, fluid_.t_end);
  return std::max(solid_.t_end, fluid_.t_end);
}

std::optional<size_t> Record::window_at(double t) const {
  const auto after =
      std::upper_bound(steps_.begin(), steps_.end(), t, [](double a, const StepBlock& s) { return a < s.t0; });
  if (after == steps_.begin()) return {};
  return size_t(after - steps_.begin()) - 1;
}

WetSurface Record::surface(size_t i) const {
  const h5::Group root = file_.root();
  const StepBlock& step = steps_[i];
  WetSurface s;
  s.topo_version = step.topo_version;
  s.x = points(root.read<double>("x", first_node_[i], step.n_nodes));
  s.v = points(root.read<double>("v", first_node_[i], step.n_nodes));
  const int64_t node = topology_nodes_.at(size_t(topology_[i])), face = topology_faces_[size_t(topology_[i])];
  const std::vector<int32_t> quads = root.read<int32_t>("quads", face, step.n_faces);
  s.quads.resize(size_t(step.n_faces));
  std::memcpy(s.quads.data(), quads.data(), quads.size() * sizeof quads[0]);
  s.node_id = root.read<int64_t>("node_id", node, step.n_nodes);
  s.node_parent = root.read<int64_t>("node_parent", node, step.n_nodes);
  s.face_id = root.read<int64_t>("face_id", face, step.n_faces);
  s.body = root.read<int32_t>("body", face, step.n_faces);
  s.flags = root.read<int32_t>("flags", face, step.n_faces);
  return s;
}

std::vector<double> Record::pressures(size_t i) const {
  return file_.root().read<double>("p", first_face_.at(i), steps_[i].n_faces);
}

Loads Record::load(size_t i) const {
  const h5::Group root = file_.root();
  const LoadBlock& block = loads_.at(i);
  const int64_t n = steps_[i].n_faces;
  Loads loads;
  loads.t1 = block.t1;
  loads.stop = block.flags & load_stop;
  loads.p = pressures(i);
  if (block.flags & load_traction) loads.traction = points(root.read<double>("traction", first_traction_[i], n));
  if (block.flags & load_impedance) loads.impedance = root.read<double>("impedance", first_impedance_[i], n);
  loads.totals = totals_of(block);
  return loads;
}

}  // namespace bw::coupling
