# SPDX-License-Identifier: Apache-2.0
# The quick gate: every case of run/verify that takes seconds.
if(TARGET csd AND TARGET cfd)
  add_test(NAME verification_quick COMMAND /usr/bin/python3 ${CMAKE_SOURCE_DIR}/run/verify --quick --json ${CMAKE_BINARY_DIR}/verify_quick.json)
  set_tests_properties(verification_quick PROPERTIES ENVIRONMENT "BREAKWAVE_BUILD=${CMAKE_BINARY_DIR}" TIMEOUT 900)
endif()
