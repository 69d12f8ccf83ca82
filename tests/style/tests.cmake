# SPDX-License-Identifier: Apache-2.0
find_package(Python3 REQUIRED COMPONENTS Interpreter)
add_test(NAME style_rules COMMAND ${Python3_EXECUTABLE} ${CMAKE_SOURCE_DIR}/tests/style/rules.py)
add_test(NAME style_format COMMAND bash ${CMAKE_SOURCE_DIR}/tests/style/format.sh)
add_test(NAME style_equations COMMAND ${Python3_EXECUTABLE} ${CMAKE_SOURCE_DIR}/tests/style/equations.py)
