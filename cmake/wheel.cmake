# What a wheel has beside the Python text, as a component of the installation by itself: FMUs, what a system of them is
# compiled from on the user's machine, the bindings' library, the script of a report's plots, scenarios and projects.
function(put place kind what)
  install(${kind} ${what} DESTINATION motionfmu/${place} COMPONENT wheel EXCLUDE_FROM_ALL ${ARGN})
endfunction()

if(MOTIONFMU_PACKED)
  put(fmus DIRECTORY ${MOTIONFMU_PACKED}/fmus/ FILES_MATCHING PATTERN "*.fmu")
  put(lib DIRECTORY ${MOTIONFMU_PACKED}/lib/ FILES_MATCHING PATTERN "motionfmu_stations.so")
else()
  put(fmus FILES "${fmu_files}")
  put(lib TARGETS motionfmu_stations)
endif()

execute_process(COMMAND ${Python_EXECUTABLE} ${PROJECT_SOURCE_DIR}/cmake/wheel_places.py
  OUTPUT_STRIP_TRAILING_WHITESPACE OUTPUT_VARIABLE places COMMAND_ERROR_IS_FATAL ANY)
string(REPLACE "\n" ";" places "${places}")
list(GET places 0 fmpy)
list(GET places 1 plotly)
list(GET places 2 licence)
file(GLOB layer_files src/fmi/* ${fmpy}/c-code/fmi[23]*.h)
put(layer FILES "${layer_files}")
put(report/plotly FILES "${plotly}/package_data/plotly.min.js;${licence}")
foreach(kind scenarios examples)
  put(shipped/${kind} DIRECTORY ${kind}/ PATTERN "*.png" EXCLUDE PATTERN "__pycache__" EXCLUDE PATTERN build EXCLUDE)
endforeach()
