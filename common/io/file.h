// SPDX-License-Identifier: Apache-2.0
// Files as a whole.
#pragma once
#include <cstdint>
#include <string>

namespace bw {

/// The file holds either its old text or all of the new one, whenever the program or machine dies: temporary name,
/// sync, rename. Throws std::runtime_error with the system's reason.
void write_atomically(const std::string& path, const std::string& text);

/// Gives a finished temporary file its name (sync, rename).
void rename_finished(const std::string& temporary, const std::string& path);

/// Room on the disk for a file of `size` bytes, which it becomes unless it is larger: 0, or errno of what stands
/// against it. 0 too where the file system can't tell.
int reserve_file(const std::string& path, uint64_t size);

/// Creates the folder and those around it. Throws InputError with the system's reason.
void make_folder(const std::string& path);

}  // namespace bw
