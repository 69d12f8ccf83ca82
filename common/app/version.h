// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace bw {

const char* version();      ///< "0.1.0"
const char* git_version();  ///< what `git describe` said when the build was configured

}  // namespace bw
