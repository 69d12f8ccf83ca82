# SPDX-License-Identifier: Apache-2.0
# libbreakwave_coupling and fsi-check for other programs, and what `cmake --install` puts where: programs, library, header, CMake package, pkg-config
# file, Python module, protocol.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

# the rooms that the shared library is made of; the kernels of csd and cfd are not among them
foreach(part bw_common bw_coupling)
  set_target_properties(${part} PROPERTIES POSITION_INDEPENDENT_CODE ON)
  target_compile_options(${part} PRIVATE -fno-semantic-interposition)
endforeach()
file(GLOB c_api CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/coupling/c_api/*.cpp)
add_library(breakwave_coupling SHARED ${c_api})
target_link_libraries(breakwave_coupling PRIVATE bw_coupling)
target_link_options(breakwave_coupling PRIVATE -Wl,--exclude-libs,ALL -Wl,--as-needed -Wl,--gc-sections)
target_include_directories(breakwave_coupling INTERFACE $<BUILD_INTERFACE:${CMAKE_SOURCE_DIR}/coupling>
                                                        $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
file(STRINGS ${CMAKE_SOURCE_DIR}/coupling/breakwave_coupling.h abi REGEX "#define FSI_ABI ")
string(REGEX REPLACE "#define FSI_ABI " "" abi ${abi})
set_target_properties(breakwave_coupling PROPERTIES
  VERSION ${abi}.${PROJECT_VERSION} SOVERSION ${abi} LIBRARY_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/lib
  PUBLIC_HEADER ${CMAKE_SOURCE_DIR}/coupling/breakwave_coupling.h)

file(GLOB check CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/coupling/check/*.cpp)
add_executable(fsi-check ${check})
target_link_libraries(fsi-check PRIVATE bw_coupling)

set_target_properties(csd cfd fsi-check breakwave_coupling PROPERTIES INSTALL_RPATH_USE_LINK_PATH ON)
install(TARGETS csd cfd fsi-check RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
install(TARGETS breakwave_coupling EXPORT breakwave_coupling LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}
        PUBLIC_HEADER DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
set(package ${CMAKE_INSTALL_LIBDIR}/cmake/breakwave_coupling)
install(EXPORT breakwave_coupling NAMESPACE breakwave:: DESTINATION ${package} FILE breakwave_coupling-config.cmake)
write_basic_package_version_file(${CMAKE_BINARY_DIR}/breakwave_coupling-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_BINARY_DIR}/breakwave_coupling-config-version.cmake DESTINATION ${package})
file(RELATIVE_PATH include_from_lib ${CMAKE_INSTALL_FULL_LIBDIR} ${CMAKE_INSTALL_FULL_INCLUDEDIR})
configure_file(${CMAKE_CURRENT_LIST_DIR}/breakwave_coupling.pc.in ${CMAKE_BINARY_DIR}/breakwave_coupling.pc @ONLY)
install(FILES ${CMAKE_BINARY_DIR}/breakwave_coupling.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
install(FILES ${CMAKE_SOURCE_DIR}/coupling/python/breakwave_coupling.py DESTINATION ${CMAKE_INSTALL_DATADIR}/breakwave/python)
install(FILES ${CMAKE_SOURCE_DIR}/coupling/PROTOCOL.md DESTINATION ${CMAKE_INSTALL_DOCDIR})
