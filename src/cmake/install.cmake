# What `cmake --install build --prefix P` gives to programs in C and C++: libraries and headers of all cores, as CMake
# targets (motionfmu::station brings what it uses) and as pkg-config packages (motionfmu-station). And the FMUs.
include(CMakePackageConfigHelpers)
include(GNUInstallDirs)
set(CMAKE_INSTALL_DEFAULT_COMPONENT_NAME development)

# The headers as they are installed, in one folder.
set(header_folder ${CMAKE_BINARY_DIR}/include)
set(header_stamp ${CMAKE_BINARY_DIR}/headers.stamp)
add_custom_command(OUTPUT ${header_stamp} DEPENDS ${core_headers} ${generator} ${CMAKE_BINARY_DIR}/core_files.txt
  COMMAND ${PACK} headers ${PROJECT_SOURCE_DIR}/src ${header_folder}/motionfmu
  COMMAND ${CMAKE_COMMAND} -E touch ${header_stamp} VERBATIM)
add_custom_target(headers ALL DEPENDS ${header_stamp})
install(DIRECTORY ${header_folder}/motionfmu DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})

# Cores have short names: their libraries get a folder of their own, and what they show gets the project's prefix, so
# that a program may have a queue_push of its own.
install(TARGETS ${cores} EXPORT motionfmu ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}/motionfmu)
install(CODE "foreach(core ${cores})
    execute_process(COMMAND \"${CMAKE_OBJCOPY}\" --redefine-syms=${CMAKE_BINARY_DIR}/include/symbols.txt
      \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_LIBDIR}/motionfmu/lib\${core}.a\" COMMAND_ERROR_IS_FATAL ANY)
  endforeach()")
set(package ${CMAKE_INSTALL_LIBDIR}/cmake/motionfmu)
install(EXPORT motionfmu NAMESPACE motionfmu:: FILE motionfmuConfig.cmake DESTINATION ${package})
write_basic_package_version_file(${CMAKE_BINARY_DIR}/motionfmuConfigVersion.cmake VERSION ${version}
  COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_BINARY_DIR}/motionfmuConfigVersion.cmake DESTINATION ${package})

set(pkgconfig ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
file(RELATIVE_PATH to_prefix /${pkgconfig} /)
foreach(core ${cores})
  list(TRANSFORM core_${core}_uses PREPEND motionfmu- OUTPUT_VARIABLE requires)
  list(JOIN requires " " requires)
  configure_file(src/cmake/core.pc.in ${CMAKE_BINARY_DIR}/pkgconfig/motionfmu-${core}.pc @ONLY)
  install(FILES ${CMAKE_BINARY_DIR}/pkgconfig/motionfmu-${core}.pc DESTINATION ${pkgconfig})
endforeach()

if(MOTIONFMU_FMUS)
  install(FILES ${fmu_files} DESTINATION ${CMAKE_INSTALL_DATADIR}/motionfmu/fmus COMPONENT fmus)
endif()
