// SPDX-License-Identifier: Apache-2.0
#include "common/app/cli.h"

#include <CLI/CLI.hpp>

#include <cstdio>

#include "common/app/log.h"
#include "common/app/version.h"

namespace bw {

CommandLine read_command_line(int argc, char** argv, const std::string& program, const std::string& description) {
  CommandLine line;
  std::string end;
  CLI::App app(description, program);
  app.add_option("case", line.case_file, "the case file (TOML)");
  app.add_flag("--check", line.check, "read and check the case, build everything, stop before the first step");
  app.add_flag("--manual", line.manual, "print every key of the case file with unit, default and meaning");
  app.add_option("--threads", line.threads, "threads of this program, instead of the case file's");
  app.add_option("--output", line.output, "folder of the results, instead of the case file's");
  app.add_option("--end", end, "end time with unit (\"50 us\"), instead of the case file's");
  app.add_option("--restart", line.restart, "go on from this checkpoint, or from the latest one in this folder");
  app.add_option("--record", line.record, "keep what crosses between the two programs in this file (csd)");
  app.add_option("--replay", line.replay, "run alone against such a file, in place of the other program");
  app.set_version_flag("--version", fmt::format("{} {} ({})", program, version(), git_version()));
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& e) {  // --help, --version
    if (speaks()) app.exit(e);
    std::fflush(stdout);
    line.exit_code = exit_ok;
    return line;
  } catch (const CLI::ParseError& e) {
    throw InputError(fmt::format("command line: {} (see {} --help)", e.what(), program));
  }
  if (line.case_file.empty() && !line.manual)
    throw InputError(fmt::format("command line: a case file is missing: {} case.toml", program));
  if (line.threads < 0) throw InputError("command line: --threads: expected a positive number");
  if (!end.empty()) {
    try {
      const Quantity q = read_quantity(end);
      line.end = q.has_unit ? parse_quantity(end, dim::time) : q.value;
    } catch (const InputError& e) {
      throw InputError(fmt::format("command line: --end: \"{}\": {}", end, e.what()));
    }
    if (!(line.end > 0)) throw InputError("command line: --end: expected a positive time");
  }
  return line;
}

void CommandLine::apply(RunControl& run) const {
  if (!output.empty()) run.output.directory = output;
  if (end > 0) run.time.end = end;
}

}  // namespace bw
