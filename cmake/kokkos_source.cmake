# The sources of Kokkos 4.5.01, from the first of
#   1. the folder FETCHCONTENT_SOURCE_DIR_KOKKOS,
#   2. the official archive of the release,
#   3. a source distribution on the Python package index that carries the same files.
# They also bring GoogleTest in one file for our unit tests.
set(FETCHCONTENT_SOURCE_DIR_KOKKOS "" CACHE PATH "Kokkos sources to build instead of a download")

set(kokkos_version 4.5.01)
set(kokkos_archive_url
    "https://github.com/kokkos/kokkos/releases/download/${kokkos_version}/kokkos-${kokkos_version}.tar.gz")
set(kokkos_archive_sha256 52d003ffbbe05f30c89966e4009c017efb1662b02b2b73190670d3418719564c)
set(kokkos_sdist pycompadre==1.7.6)
set(kokkos_sdist_sha256 c766ec4d445ce076069be4b8c51a23ffac4ee79ea949ca86446bfd8c299b154c)

# Download into file; sets out to an empty string or to what went wrong.
function(peclet_download_kokkos_archive file out)
  file(DOWNLOAD "${kokkos_archive_url}" "${file}" STATUS status TIMEOUT 60 INACTIVITY_TIMEOUT 10)
  list(GET status 0 code)
  list(GET status 1 problem)
  if(code EQUAL 0)
    set(problem)
  endif()
  set(${out} "${problem}" PARENT_SCOPE)
endfunction()

function(peclet_download_kokkos_sdist file out)
  find_package(Python 3.10 QUIET COMPONENTS Interpreter)
  if(NOT Python_Interpreter_FOUND)
    set(${out} "no Python 3.10 or newer was found" PARENT_SCOPE)
    return()
  endif()
  execute_process(
    COMMAND "${Python_EXECUTABLE}" "${PECLET_SOURCE_DIR}/cmake/download_sdist.py" "${kokkos_sdist}" "${file}"
    TIMEOUT 300 RESULT_VARIABLE failed OUTPUT_VARIABLE problem ERROR_VARIABLE problem)
  if(NOT failed)
    set(problem)
  endif()
  set(${out} "${problem}" PARENT_SCOPE)
endfunction()

# Fetch by the given route ("archive" or "sdist") into folder; sets out to an empty string or the problem.
function(peclet_fetch_kokkos route folder out)
  set(file "${folder}-download.tar.gz")
  cmake_language(CALL peclet_download_kokkos_${route} "${file}" problem)
  if(NOT problem)
    file(SHA256 "${file}" found)
    if(NOT found STREQUAL kokkos_${route}_sha256)
      set(problem "SHA-256: expected ${kokkos_${route}_sha256}, found ${found}")
    endif()
  endif()
  if(NOT problem)
    set(unpacked "${folder}-unpacked")
    file(REMOVE_RECURSE "${unpacked}" "${folder}")
    file(ARCHIVE_EXTRACT INPUT "${file}" DESTINATION "${unpacked}")
    file(GLOB found "${unpacked}/kokkos-*/core/src/Kokkos_Core.hpp" "${unpacked}/*/kokkos/core/src/Kokkos_Core.hpp")
    string(REPLACE "/core/src/Kokkos_Core.hpp" "" found "${found}")
    file(RENAME "${found}" "${folder}")
    file(REMOVE_RECURSE "${unpacked}")
  endif()
  file(REMOVE "${file}")
  set(${out} "${problem}" PARENT_SCOPE)
endfunction()

function(peclet_kokkos_source out)
  if(FETCHCONTENT_SOURCE_DIR_KOKKOS)
    if(NOT EXISTS "${FETCHCONTENT_SOURCE_DIR_KOKKOS}/core/src/Kokkos_Core.hpp")
      message(FATAL_ERROR "FETCHCONTENT_SOURCE_DIR_KOKKOS: expected a folder of Kokkos sources, "
                          "found ${FETCHCONTENT_SOURCE_DIR_KOKKOS}")
    endif()
    message(STATUS "Kokkos: sources in ${FETCHCONTENT_SOURCE_DIR_KOKKOS}")
    set(${out} "${FETCHCONTENT_SOURCE_DIR_KOKKOS}" PARENT_SCOPE)
    return()
  endif()

  set(folder "${PECLET_CACHE_DIR}/kokkos-${kokkos_version}-source")
  set(${out} "${folder}" PARENT_SCOPE)
  file(LOCK "${PECLET_CACHE_DIR}/lock" GUARD FUNCTION TIMEOUT 1800)
  if(EXISTS "${folder}/core/src/Kokkos_Core.hpp")
    message(STATUS "Kokkos: sources in ${folder}")
    return()
  endif()
  foreach(route archive sdist)
    set(origin_archive "the official archive ${kokkos_archive_url}")
    set(origin_sdist "the copy inside ${kokkos_sdist} on the Python package index")
    peclet_fetch_kokkos(${route} "${folder}" problem)
    if(NOT problem)
      message(STATUS "Kokkos: sources from ${origin_${route}}")
      include(kokkos_cuda13)
      peclet_adapt_kokkos_to_cuda13("${folder}")
      return()
    endif()
    string(STRIP "${problem}" problem)
    message(STATUS "Kokkos: ${origin_${route}} is not available: ${problem}")
    string(APPEND problems "\n  ${origin_${route}}:\n    ${problem}")
  endforeach()
  message(FATAL_ERROR "No Kokkos was found and none could be fetched:${problems}\n"
                      "Install Kokkos 4.5 or newer as a shared library and set Kokkos_ROOT, or unpack its sources and "
                      "set -DFETCHCONTENT_SOURCE_DIR_KOKKOS=<folder>.")
endfunction()
