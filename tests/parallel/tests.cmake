# SPDX-License-Identifier: Apache-2.0
# Tests that run under mpirun: tests/parallel/<room>/*.cpp -> bin/parallel_<room>, each on 1, 2 and 3 ranks.
file(GLOB parallel_common_sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_LIST_DIR}/common/*.cpp)
add_executable(parallel_common ${parallel_common_sources})
target_link_libraries(parallel_common PRIVATE bw_common GTest::gtest)
foreach(ranks 1 2 3)
  add_test(NAME parallel_common_${ranks} COMMAND ${MPIEXEC_EXECUTABLE} -n ${ranks} $<TARGET_FILE:parallel_common>)
  set_tests_properties(parallel_common_${ranks} PROPERTIES TIMEOUT 120 ENVIRONMENT
    "OMPI_ALLOW_RUN_AS_ROOT=1;OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1;OMPI_MCA_rmaps_base_oversubscribe=1;OMPI_MCA_hwloc_base_binding_policy=none;OMPI_MCA_mpi_yield_when_idle=1;OMP_WAIT_POLICY=passive")
endforeach()
# an error on one rank ends all ranks at once, with its code, though the others wait
foreach(failure "input;2" "physics;3" "coded;66" "bug;1" "silent;1")
  list(GET failure 0 kind)
  list(GET failure 1 code)
  add_test(NAME parallel_error_${kind} COMMAND sh -c
    "timeout 30 ${MPIEXEC_EXECUTABLE} -n 2 $<TARGET_FILE:parallel_common> --fail=${kind}; test $? -eq ${code}")
  set_tests_properties(parallel_error_${kind} PROPERTIES ENVIRONMENT
    "OMPI_ALLOW_RUN_AS_ROOT=1;OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1;OMPI_MCA_rmaps_base_oversubscribe=1;OMPI_MCA_hwloc_base_binding_policy=none;OMPI_MCA_mpi_yield_when_idle=1")
endforeach()
# csd on ranks and threads, bit for bit
if(TARGET csd AND TARGET cfd)
  foreach(group cracks rigid contact bar loaded static local coupled errors)
    add_test(NAME parallel_csd_${group} COMMAND /usr/bin/python3 ${CMAKE_CURRENT_LIST_DIR}/csd.py ${CMAKE_BINARY_DIR} ${group})
    set_tests_properties(parallel_csd_${group} PROPERTIES TIMEOUT 900)
  endforeach()
endif()
# csd goes on from checkpoints
if(TARGET csd)
  add_test(NAME parallel_csd_restart COMMAND /usr/bin/python3 ${CMAKE_CURRENT_LIST_DIR}/restart_csd.py ${CMAKE_BINARY_DIR})
  set_tests_properties(parallel_csd_restart PROPERTIES TIMEOUT 600)
endif()
# cfd likewise, with levels
if(TARGET csd AND TARGET cfd)
  add_test(NAME parallel_cfd_levels COMMAND /usr/bin/python3 ${CMAKE_CURRENT_LIST_DIR}/cfd.py ${CMAKE_BINARY_DIR})
  set_tests_properties(parallel_cfd_levels PROPERTIES TIMEOUT 900)
  add_test(NAME parallel_pair_restart COMMAND /usr/bin/python3 ${CMAKE_CURRENT_LIST_DIR}/restart_pair.py ${CMAKE_BINARY_DIR})
  set_tests_properties(parallel_pair_restart PROPERTIES TIMEOUT 600)
  add_test(NAME parallel_cfd_restart COMMAND /usr/bin/python3 ${CMAKE_CURRENT_LIST_DIR}/restart.py ${CMAKE_BINARY_DIR})
  set_tests_properties(parallel_cfd_restart PROPERTIES TIMEOUT 900)
endif()
