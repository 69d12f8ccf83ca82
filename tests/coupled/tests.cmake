# SPDX-License-Identifier: Apache-2.0
if(TARGET bw_coupling)
  add_executable(coupled_dummy coupled/dummy.cpp coupled/solid.cpp coupled/fluid.cpp)
  add_executable(coupled_piston coupled/piston.cpp)
  add_executable(coupled_simple_wave coupled/simple_wave.cpp)
  target_link_libraries(coupled_simple_wave PRIVATE bw_coupling)
  target_link_libraries(coupled_dummy PRIVATE bw_coupling)
  target_link_libraries(coupled_piston PRIVATE bw_coupling)
  foreach(group exchange messages accidents starts)
    add_test(NAME coupled_${group} COMMAND /usr/bin/python3 ${CMAKE_CURRENT_SOURCE_DIR}/coupled/pairs.py $<TARGET_FILE_DIR:coupled_dummy> ${group})
  endforeach()
  foreach(scheme fluid_first box1 concurrent)
    set(pair -n 1 $<TARGET_FILE:coupled_piston>)
    add_test(NAME coupled_order_${scheme} COMMAND mpirun ${pair} solid ${scheme} : ${pair} fluid ${scheme})
    set_tests_properties(coupled_order_${scheme} PROPERTIES ENVIRONMENT
      "OMPI_ALLOW_RUN_AS_ROOT=1;OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1;OMPI_MCA_rmaps_base_oversubscribe=1;OMPI_MCA_hwloc_base_binding_policy=none;OMPI_MCA_mpi_yield_when_idle=1;OMP_WAIT_POLICY=passive")
  endforeach()
  if(TARGET csd)
    add_test(NAME coupled_simple_wave COMMAND /usr/bin/python3 ${CMAKE_CURRENT_SOURCE_DIR}/coupled/simple_wave.py
             $<TARGET_FILE_DIR:csd> ${CMAKE_CURRENT_BINARY_DIR}/simple_wave)
  endif()
  if(TARGET csd AND TARGET cfd)
    add_test(NAME coupled_failures COMMAND /usr/bin/python3 ${CMAKE_CURRENT_SOURCE_DIR}/coupled/failures.py ${CMAKE_BINARY_DIR} --ranks 2+2 --only "kill -9")
    add_test(NAME coupled_disk_full COMMAND /usr/bin/python3 ${CMAKE_CURRENT_SOURCE_DIR}/coupled/failures.py ${CMAKE_BINARY_DIR} --only "disk full")
    add_test(NAME coupled_replay COMMAND /usr/bin/python3 ${CMAKE_CURRENT_SOURCE_DIR}/coupled/replay.py ${CMAKE_BINARY_DIR}
             ${CMAKE_CURRENT_BINARY_DIR}/replay)
    add_test(NAME coupled_programs COMMAND /usr/bin/python3 ${CMAKE_CURRENT_SOURCE_DIR}/coupled/programs.py
             $<TARGET_FILE_DIR:csd> ${CMAKE_SOURCE_DIR}/run/cases/piston/case.toml ${CMAKE_CURRENT_BINARY_DIR}/programs)
  endif()
endif()
if(TARGET breakwave_coupling)
  add_test(NAME coupled_other_fluids COMMAND /usr/bin/python3 ${CMAKE_CURRENT_SOURCE_DIR}/coupled/other_fluids.py
           ${CMAKE_BINARY_DIR} ${CMAKE_SOURCE_DIR} ${CMAKE_CURRENT_BINARY_DIR}/other_fluids)
  find_program(OMPI_SERVER ompi-server)
  if(OMPI_SERVER AND TARGET csd AND TARGET cfd)
    add_test(NAME coupled_ports COMMAND /usr/bin/python3 ${CMAKE_CURRENT_SOURCE_DIR}/coupled/ports.py
             ${CMAKE_BINARY_DIR} ${CMAKE_SOURCE_DIR} ${CMAKE_CURRENT_BINARY_DIR}/ports)
  endif()
  add_test(NAME coupled_fsi_check COMMAND /usr/bin/python3 ${CMAKE_CURRENT_SOURCE_DIR}/coupled/fsi_check.py
           ${CMAKE_BINARY_DIR} ${CMAKE_SOURCE_DIR} ${CMAKE_CURRENT_BINARY_DIR}/fsi_check)
endif()
