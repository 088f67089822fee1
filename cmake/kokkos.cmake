# Kokkos as the imported target Kokkos::kokkoscore, always a shared library, so that the three modules share
# one thread pool and one device. Taken from the first of
#   1. an installed Kokkos 4.5 to 5.x (Kokkos_ROOT or CMAKE_PREFIX_PATH point to it) with the wanted backend,
#   2. our own build of the sources that cmake/kokkos_source.cmake provides.
# Our own build is kept in the user's cache folder, one for each set of options, and is used again by the next
# build anywhere on the machine.
include(kokkos_cache)
include(kokkos_source)

set(PECLET_CUDA_ARCH "" CACHE STRING "Kokkos name of the GPU, for instance AMPERE80 or HOPPER90 (cuda only)")

# Look for an installed Kokkos in a process of its own, because a Kokkos that turns out to be unusable could not
# be unloaded again. Sets PECLET_KOKKOS_DIR, or leaves it empty and says why in PECLET_KOKKOS_REJECTED.
function(peclet_find_installed_kokkos)
  set(result "${CMAKE_BINARY_DIR}/kokkos_probe/result.cmake")
  execute_process(
    COMMAND "${CMAKE_COMMAND}" -S "${PECLET_SOURCE_DIR}/cmake/kokkos_probe" -B "${CMAKE_BINARY_DIR}/kokkos_probe"
            -G "${CMAKE_GENERATOR}" "-DCMAKE_MAKE_PROGRAM=${CMAKE_MAKE_PROGRAM}"
            "-DCMAKE_CXX_COMPILER=${CMAKE_CXX_COMPILER}" "-DCMAKE_PREFIX_PATH=${CMAKE_PREFIX_PATH}"
            "-DKokkos_ROOT=${Kokkos_ROOT}" "-DKokkos_DIR=${Kokkos_DIR}" "-DPECLET_BACKEND=${PECLET_BACKEND}"
            "-DPECLET_PROBE_RESULT=${result}"
    OUTPUT_VARIABLE output ERROR_VARIABLE output RESULT_VARIABLE failed)
  if(failed)
    message(FATAL_ERROR "Looking for an installed Kokkos failed:\n${output}")
  endif()
  include("${result}")
  set(PECLET_KOKKOS_DIR "${PECLET_KOKKOS_DIR}" PARENT_SCOPE)
  set(PECLET_KOKKOS_REJECTED "${PECLET_KOKKOS_REJECTED}" PARENT_SCOPE)
endfunction()

# Configure options of our own Kokkos for the chosen backend.
function(peclet_kokkos_options out)
  set(options -DCMAKE_BUILD_TYPE=Release -DBUILD_SHARED_LIBS=ON -DCMAKE_CXX_STANDARD=20 -DKokkos_ENABLE_SERIAL=ON
              "-DCMAKE_CXX_COMPILER=${CMAKE_CXX_COMPILER}"
              "-DCMAKE_CXX_FLAGS=${CMAKE_CXX_FLAGS}" -DCMAKE_INSTALL_RPATH=$ORIGIN -DCMAKE_INSTALL_LIBDIR=lib)
  if(NOT PECLET_BACKEND STREQUAL "serial")
    list(APPEND options -DKokkos_ENABLE_OPENMP=ON)
  endif()
  if(PECLET_BACKEND STREQUAL "cuda")
    list(APPEND options -DKokkos_ENABLE_CUDA=ON -DCMAKE_INSTALL_RPATH_USE_LINK_PATH=ON "-DKokkos_ARCH_${PECLET_CUDA_ARCH}=ON"
         "-DCUDA_cuda_driver_LIBRARY=${CUDA_cuda_driver_LIBRARY}" "-DCUDAToolkit_ROOT=${CUDAToolkit_BIN_DIR}/..")
  endif()
  set(${out} "${options}" PARENT_SCOPE)
endfunction()

# Build the sources once and install them under the cache folder; sets PECLET_KOKKOS_DIR.
function(peclet_build_kokkos)
  peclet_kokkos_source(source problems)
  if(problems)
    message(FATAL_ERROR "No Kokkos was found and none could be fetched:${problems}\n"
                        "Install Kokkos 4.5 or newer as a shared library and set Kokkos_ROOT, or unpack its sources "
                        "and set -DFETCHCONTENT_SOURCE_DIR_KOKKOS=<folder>.")
  endif()
  peclet_kokkos_options(options)
  string(SHA256 key "${source};${options};${CMAKE_CXX_COMPILER};${CMAKE_CXX_COMPILER_VERSION}")
  string(SUBSTRING "${key}" 0 12 key)
  set(folder "${PECLET_CACHE_DIR}")
  if(FETCHCONTENT_SOURCE_DIR_KOKKOS)
    set(folder "${CMAKE_BINARY_DIR}")  # those sources may change: not for other builds
  endif()
  set(prefix "${folder}/kokkos-${PECLET_BACKEND}-${key}")
  set(PECLET_KOKKOS_DIR "${prefix}/lib/cmake/Kokkos" PARENT_SCOPE)

  file(LOCK "${prefix}.lock" GUARD FUNCTION TIMEOUT 1800)
  if(EXISTS "${prefix}/complete")
    message(STATUS "Kokkos: our own build in ${prefix}")
    return()
  endif()
  message(STATUS "Kokkos: building ${source} (once; kept in ${prefix})")
  set(build "${prefix}-build")
  file(REMOVE_RECURSE "${build}" "${prefix}")
  set(ENV{NVCC_WRAPPER_DEFAULT_COMPILER} "${CMAKE_CXX_COMPILER}")  # the host compiler behind nvcc
  set(log "${prefix}.log")
  cmake_host_system_information(RESULT processors QUERY NUMBER_OF_LOGICAL_CORES)
  if(DEFINED ENV{CMAKE_BUILD_PARALLEL_LEVEL})
    set(processors $ENV{CMAKE_BUILD_PARALLEL_LEVEL})
  endif()
  execute_process(
    COMMAND "${CMAKE_COMMAND}" -S "${source}" -B "${build}" -G "${CMAKE_GENERATOR}"
            "-DCMAKE_MAKE_PROGRAM=${CMAKE_MAKE_PROGRAM}" "-DCMAKE_INSTALL_PREFIX=${prefix}" ${options}
    OUTPUT_FILE "${log}" ERROR_FILE "${log}" RESULT_VARIABLE failed)
  if(NOT failed)
    execute_process(
      COMMAND "${CMAKE_COMMAND}" --build "${build}" --parallel ${processors} --target install
      OUTPUT_FILE "${log}" ERROR_FILE "${log}" RESULT_VARIABLE failed)
  endif()
  if(failed)
    file(READ "${log}" output)
    message(FATAL_ERROR "Kokkos did not build (the output is also in ${log}):\n${output}")
  endif()
  file(REMOVE_RECURSE "${build}")
  file(REMOVE "${log}")
  file(TOUCH "${prefix}/complete")
endfunction()

if(PECLET_BACKEND STREQUAL "cuda")
  include(cuda)
endif()
if(FETCHCONTENT_SOURCE_DIR_KOKKOS)
  set(PECLET_KOKKOS_DIR)
else()
  peclet_find_installed_kokkos()
endif()
if(PECLET_KOKKOS_DIR)
  message(STATUS "Kokkos: installed in ${PECLET_KOKKOS_DIR}")
else()
  if(PECLET_KOKKOS_REJECTED AND (Kokkos_ROOT OR Kokkos_DIR))
    message(FATAL_ERROR "The Kokkos that was asked for cannot be used: ${PECLET_KOKKOS_REJECTED}")
  elseif(PECLET_KOKKOS_REJECTED)
    message(STATUS "Kokkos: an installed one is not used: ${PECLET_KOKKOS_REJECTED}")
  endif()
  peclet_build_kokkos()
endif()
find_package(Kokkos REQUIRED CONFIG PATHS "${PECLET_KOKKOS_DIR}" NO_DEFAULT_PATH)
