// SPDX-License-Identifier: Apache-2.0
#include "common/app/version.h"

namespace bw {

const char* version() { return BREAKWAVE_VERSION; }
const char* git_version() { return BREAKWAVE_GIT; }

}  // namespace bw
