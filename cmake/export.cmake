# The FMUs' libraries for all platforms, by zig's C compiler, which brings every libc: an archive for each core and
# platform, of which both versions of an FMU are linked.
execute_process(COMMAND ${Python_EXECUTABLE} -c "import ziglang; print(ziglang.__path__[0])"
  OUTPUT_STRIP_TRAILING_WHITESPACE OUTPUT_VARIABLE zig RESULT_VARIABLE no_zig ERROR_QUIET)
if(no_zig)
  message(FATAL_ERROR "There is no zig: pip install \"motionfmu[export]\", or make export, which does")
endif()
find_program(zig_program zig PATHS ${zig} NO_DEFAULT_PATH REQUIRED)
execute_process(COMMAND ${PACK} platforms OUTPUT_VARIABLE rows COMMAND_ERROR_IS_FATAL ANY)
string(REGEX MATCHALL "[^\n]+" rows "${rows}")
set(platforms)
foreach(row ${rows})
  string(REPLACE " " ";" row "${row}")
  list(GET row 0 platform)
  list(APPEND platforms ${platform})
  list(GET row 1 target_${platform})
  list(GET row 2 suffix_${platform})
endforeach()
# No path of this machine in a binary.
set(cross_flags -std=c11 -O2 -Wall -Wextra -Wpedantic -Werror ${exact} -fPIC -fvisibility=hidden
  -ffile-prefix-map=${PROJECT_SOURCE_DIR}=. -ffile-prefix-map=${CMAKE_BINARY_DIR}=.)

# Compile one C file for a platform; it sees the headers that a target of this machine does.
function(cross_object platform like file object)
  set(seen "$<TARGET_PROPERTY:${like},INCLUDE_DIRECTORIES>")
  add_custom_command(OUTPUT ${object} DEPENDS ${file} ${ARGN} DEPFILE ${object}.d
    COMMAND ${zig_program} cc -target ${target_${platform}} ${cross_flags} "-I$<JOIN:${seen},;-I>"
      -MD -MT ${object} -MF ${object}.d -c ${file} -o ${object}
    VERBATIM COMMAND_EXPAND_LISTS)
endfunction()

# The archive of a core, once for each platform.
function(cross_core platform core result)
  set(archive ${CMAKE_BINARY_DIR}/cross/${platform}/lib${core}.a)
  set(${result} ${archive} PARENT_SCOPE)
  get_property(there GLOBAL PROPERTY cross_${platform}_${core})
  if(there)
    return()
  endif()
  set_property(GLOBAL PROPERTY cross_${platform}_${core} ON)
  set(objects)
  foreach(file ${${core}_files})
    get_filename_component(stem ${file} NAME_WE)
    set(object ${CMAKE_BINARY_DIR}/cross/${platform}/${core}/${stem}.o)
    cross_object(${platform} ${core} ${file} ${object})
    list(APPEND objects ${object})
  endforeach()
  add_custom_command(OUTPUT ${archive} DEPENDS ${objects} COMMAND ${CMAKE_COMMAND} -E rm -f ${archive}
    COMMAND ${zig_program} ar rcsD ${archive} ${objects} VERBATIM)
endfunction()

# All libraries of one version of an FMU: appends them to `made` as platform=file, and sets `needs`.
function(cross_fmu name fmi)
  set(gen ${CMAKE_BINARY_DIR}/gen/${name})
  file(STRINGS ${PROJECT_SOURCE_DIR}/fmus/${name}/fmu.toml identifier REGEX "^name ")
  string(REGEX MATCH "[A-Za-z0-9_]+\"" identifier "${identifier}")
  string(REPLACE "\"" "" identifier "${identifier}")
  set(made)
  foreach(platform ${platforms})
    set(folder ${CMAKE_BINARY_DIR}/cross/${platform}/${name}.fmi${fmi})
    set(files)
    foreach(file ${gen}/fmi${fmi}/fmu_main.c ${${name}_plant})
      get_filename_component(stem ${file} NAME_WE)
      cross_object(${platform} ${name}_fmi${fmi} ${file} ${folder}/${stem}.o ${name}_generated)
      list(APPEND files ${folder}/${stem}.o)
    endforeach()
    foreach(core ${${name}_all_cores})
      cross_core(${platform} ${core} archive)
      list(APPEND files ${archive})
    endforeach()
    set(library ${folder}/${identifier}${suffix_${platform}})
    set(options -lm)
    if(platform MATCHES "darwin")
      list(APPEND options -Wl,-install_name,@rpath/${identifier}.dylib)
    endif()
    add_custom_command(OUTPUT ${library} DEPENDS ${files}
      COMMAND ${zig_program} cc -target ${target_${platform}} -shared -s -o ${library} ${files} ${options} VERBATIM)
    list(APPEND made ${platform}=${library})
    list(APPEND needs_of ${library})
  endforeach()
  set(made ${made} PARENT_SCOPE)
  set(needs ${needs_of} PARENT_SCOPE)
endfunction()
