# SPDX-License-Identifier: Apache-2.0
add_test(NAME style_rules COMMAND /usr/bin/python3 ${CMAKE_SOURCE_DIR}/tests/style/rules.py)
add_test(NAME style_format COMMAND bash ${CMAKE_SOURCE_DIR}/tests/style/format.sh)
add_test(NAME style_equations COMMAND /usr/bin/python3 ${CMAKE_SOURCE_DIR}/tests/style/equations.py)
