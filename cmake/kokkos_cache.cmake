# PECLET_CACHE_DIR: where downloads and our own Kokkos builds are kept between builds.
if(DEFINED ENV{XDG_CACHE_HOME} AND NOT "$ENV{XDG_CACHE_HOME}" STREQUAL "")
  set(cache_default "$ENV{XDG_CACHE_HOME}/peclet-resolved")
elseif(DEFINED ENV{HOME})
  set(cache_default "$ENV{HOME}/.cache/peclet-resolved")
else()
  set(cache_default "${CMAKE_BINARY_DIR}/peclet-cache")
endif()
set(PECLET_CACHE_DIR "${cache_default}" CACHE PATH "Downloads and Kokkos builds that are used again")

execute_process(
  COMMAND "${CMAKE_COMMAND}" -E make_directory "${PECLET_CACHE_DIR}"
  COMMAND "${CMAKE_COMMAND}" -E touch "${PECLET_CACHE_DIR}/lock"
  RESULT_VARIABLE not_writable OUTPUT_QUIET ERROR_QUIET)
if(not_writable)
  message(STATUS "${PECLET_CACHE_DIR} cannot be written; downloads stay in the build folder")
  set(PECLET_CACHE_DIR "${CMAKE_BINARY_DIR}/peclet-cache")
  file(MAKE_DIRECTORY "${PECLET_CACHE_DIR}")
endif()
