# SPDX-License-Identifier: Apache-2.0
find_package(Python3 REQUIRED COMPONENTS Interpreter)
if(TARGET csd AND TARGET cfd)
  add_test(NAME regression_bad_input COMMAND ${Python3_EXECUTABLE} ${CMAKE_SOURCE_DIR}/tests/regression/bad_input.py ${CMAKE_BINARY_DIR})
endif()
