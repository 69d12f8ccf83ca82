// SPDX-License-Identifier: Apache-2.0
// The three ways to fail, and the exit codes of both programs (DESIGN 7).
#pragma once
#include <stdexcept>
#include <string>

namespace bw {

enum ExitCode {
  exit_ok = 0,
  exit_bug = 1,
  exit_input = 2,
  exit_physics = 3
};  // 64-79: coupling, see coupling/PROTOCOL.md

/// The user's input is wrong. what() reads "file:line: key: what was expected".
struct InputError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The run itself failed: inverted element, NaN, negative density. what() names element or cell, place and time.
struct PhysicsError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Ends the program with a code of its own: the coupling's 64-79.
struct CodedError : std::runtime_error {
  CodedError(int exit_code, const std::string& what) : std::runtime_error(what), code(exit_code) {}
  int code;
};

[[noreturn]] void check_failed(const char* condition, const char* file, int line);

}  // namespace bw

/// A bug if it fails: always on, for set-up code. In kernels use assert().
#define BW_CHECK(condition) ((condition) ? (void)0 : ::bw::check_failed(#condition, __FILE__, __LINE__))
