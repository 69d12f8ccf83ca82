// SPDX-License-Identifier: Apache-2.0
#include "common/app/summary.h"

#include "common/app/log.h"
#include "common/app/machine.h"
#include "common/app/version.h"
#include "common/io/file.h"

namespace bw {

namespace {

JsonObject object(const Summary::Numbers& numbers) {
  JsonObject json;
  for (const auto& [name, value] : numbers) json.add(name, value);
  return json;
}

}  // namespace

std::string Summary::json(const Timers& times) const {
  JsonObject all;
  all.add("program", program_name());
  all.add("version", version());
  all.add("git", git_version());
  all.add("case", case_file);
  all.add("title", title);
  all.add("status", status);
  all.add("message", message);
  all.add("ranks", ranks);
  all.add("threads", threads);
  all.add("peak_memory_bytes", peak_memory());
  all.add("steps", steps);
  all.add("t", t);
  all.add("wall_seconds", times.wall());
  all.add("cpu_seconds", times.cpu());
  all.add("waiting_share", times.waiting_share());
  all.add("rates", object(rates));
  all.add("energies", object(energies));
  all.add("masses", object(masses));
  all.add("momenta", object(momenta));
  all.add("counts", object(counts));
  all.add("values", object(values));
  all.add("timers", times.json());
  return all.text() + "\n";
}

void Summary::write(const std::string& path, const Timers& times) const { write_atomically(path, json(times)); }

}  // namespace bw
