# SPDX-License-Identifier: Apache-2.0
if(TARGET bw_coupling)
  add_executable(coupled_dummy coupled/dummy.cpp coupled/solid.cpp coupled/fluid.cpp)
  target_link_libraries(coupled_dummy PRIVATE bw_coupling)
  foreach(group exchange messages accidents starts)
    add_test(NAME coupled_${group} COMMAND /usr/bin/python3 ${CMAKE_CURRENT_SOURCE_DIR}/coupled/pairs.py $<TARGET_FILE_DIR:coupled_dummy> ${group})
  endforeach()
endif()
