// SPDX-License-Identifier: Apache-2.0
#include "common/app/timers.h"

#include <fmt/format.h>

#include <cstring>

#include "common/app/machine.h"

namespace bw {

void Timers::restart() {
  nodes_.assign(1, Node{"run", false, -1, {}, 0, 0});
  here_ = 0;
  start_ = Clock::now();
  cpu_start_ = cpu_seconds();
}

void Timers::enter(const char* name, bool waiting) {
  for (const int child : nodes_[size_t(here_)].inside) {
    if (nodes_[size_t(child)].name == name || std::strcmp(nodes_[size_t(child)].name, name) == 0) {
      here_ = child;
      return;
    }
  }
  const int child = int(nodes_.size());
  nodes_[size_t(here_)].inside.push_back(child);
  nodes_.push_back({name, waiting, here_, {}, 0, 0});
  here_ = child;
}

void Timers::leave(double seconds) {
  Node& node = nodes_[size_t(here_)];
  if (node.parent < 0) return;  // restarted inside the scope
  node.seconds += seconds;
  ++node.calls;
  here_ = node.parent;
}

double Timers::wall() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }
double Timers::cpu() const { return cpu_seconds() - cpu_start_; }

double Timers::waiting_share() const {
  double waited = 0;
  for (const Node& n : nodes_)
    if (n.waiting && !nodes_[size_t(n.parent)].waiting) waited += n.seconds;
  const double all = wall();
  return all > 0 ? waited / all : 0;
}

double Timers::seconds(const std::string& name) const {
  double sum = 0;
  for (const Node& n : nodes_)
    if (n.parent >= 0 && name == n.name) sum += n.seconds;
  return sum;
}

void Timers::print(int node, int depth, std::string& out) const {
  const Node& n = nodes_[size_t(node)];
  const std::string name = std::string(size_t(2 * depth), ' ') + n.name;
  out += fmt::format("  {:<36} {:>10.3f} s {:>6.1f} % {:>10}{}\n", name, n.seconds, 100 * n.seconds / wall(), n.calls,
                     n.waiting ? "  waiting" : "");
  for (const int child : n.inside) print(child, depth + 1, out);
}

std::string Timers::table() const {
  std::string out =
      fmt::format("  wall {:.3f} s, cpu {:.3f} s, waiting {:.1f} %\n", wall(), cpu(), 100 * waiting_share());
  for (const int child : nodes_[0].inside) print(child, 0, out);
  return out;
}

JsonObject Timers::json_of(int node) const {
  const Node& n = nodes_[size_t(node)];
  JsonObject json, inside;
  json.add("seconds", n.seconds);
  json.add("calls", n.calls);
  if (n.waiting) json.add("waiting", true);
  for (const int child : n.inside) inside.add(nodes_[size_t(child)].name, json_of(child));
  if (!inside.empty()) json.add("inside", inside);
  return json;
}

JsonObject Timers::json() const {
  JsonObject json;
  for (const int child : nodes_[0].inside) json.add(nodes_[size_t(child)].name, json_of(child));
  return json;
}

Timers& timers() {
  static Timers t;
  return t;
}

}  // namespace bw
