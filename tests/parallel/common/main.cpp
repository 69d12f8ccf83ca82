// SPDX-License-Identifier: Apache-2.0
// Runs the tests on every rank; `--fail=<kind>` instead lets rank 1 fail while rank 0 waits for it.
#include <gtest/gtest.h>

#include <string>

#include "common/app/guarded.h"
#include "common/app/log.h"

using namespace bw;

namespace {

int fail(const Comm& world, const std::string& kind) {
  if (world.rank() == 0) world.barrier();  // never met
  if (kind == "input") throw InputError("case.toml:1: x: wrong");
  if (kind == "physics") throw PhysicsError("element 3 inverted");
  if (kind == "silent") return 1;
  if (kind == "coded") throw CodedError(66, "the peer fell silent");
  throw std::logic_error("a bug");
}

}  // namespace

int main(int argc, char** argv) {
  Session session(argc, argv);
  const Comm world = session.world();
  set_speaker("test", world.root());
  const std::string mark = "--fail=", option = argc > 1 ? argv[1] : "";
  if (option.starts_with(mark)) return guarded(session, [&] { return fail(world, option.substr(mark.size())); });
  testing::InitGoogleTest(&argc, argv);
  if (!world.root())
    delete testing::UnitTest::GetInstance()->listeners().Release(
        testing::UnitTest::GetInstance()->listeners().default_result_printer());
  const int64_t failures = world.sum(int64_t(RUN_ALL_TESTS() != 0));
  return failures > 0 ? 1 : 0;
}
