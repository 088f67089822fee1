# nanobind from the Python that runs this build: `pip install nanobind`, or pip's build isolation.
find_package(Python 3.10 REQUIRED COMPONENTS Interpreter Development.Module)
execute_process(
  COMMAND "${Python_EXECUTABLE}" -m nanobind --cmake_dir
  OUTPUT_VARIABLE nanobind_ROOT OUTPUT_STRIP_TRAILING_WHITESPACE
  RESULT_VARIABLE nanobind_missing ERROR_QUIET)
if(nanobind_missing)
  message(FATAL_ERROR "nanobind is needed: ${Python_EXECUTABLE} -m pip install nanobind")
endif()
find_package(nanobind CONFIG REQUIRED)

# Where the wheel keeps the Kokkos library, seen from the root of site-packages.
set(PECLET_LIBRARY_FOLDER peclet/_lib)

# peclet_add_python_module(name library package): the extension module <package>/_<name> and its type stub.
function(peclet_add_python_module name library package)
  file(GLOB sources CONFIGURE_DEPENDS "${PECLET_SOURCE_DIR}/python/bindings/${name}.cpp"
       "${PECLET_SOURCE_DIR}/python/bindings/${name}_*.cpp")
  nanobind_add_module(_${name} NB_STATIC NB_DOMAIN peclet NB_SUPPRESS_WARNINGS NOMINSIZE ${sources}
                      "${PECLET_SOURCE_DIR}/python/bindings/runtime.cpp")
  target_link_libraries(_${name} PRIVATE ${library})

  string(REGEX REPLACE "[^/]+" ".." to_root "${package}")
  set_target_properties(
    _${name} PROPERTIES LIBRARY_OUTPUT_DIRECTORY "${CMAKE_BINARY_DIR}/${package}"
                        INSTALL_RPATH "$ORIGIN/${to_root}/${PECLET_LIBRARY_FOLDER}"
                        INSTALL_RPATH_USE_LINK_PATH $<STREQUAL:${PECLET_BACKEND},cuda>)
  install(TARGETS _${name} LIBRARY DESTINATION ${package})

  # The stub is written by importing the module, which a machine without the GPU's driver cannot do.
  if(NOT PECLET_BACKEND STREQUAL "cuda")
    nanobind_add_stub(
      _${name}_stub MODULE _${name} PYTHON_PATH "$<TARGET_FILE_DIR:_${name}>" DEPENDS _${name}
      OUTPUT "${CMAKE_BINARY_DIR}/${package}/_${name}.pyi")
    install(FILES "${CMAKE_BINARY_DIR}/${package}/_${name}.pyi" DESTINATION ${package})
  endif()
endfunction()

# peclet_link_python_files(modules...): the Python files of these modules, and those that belong to no module,
# appear in the build tree, so that it can be imported as it is; links, so that an edited file needs no build.
function(peclet_link_python_files)
  set(geom_folders core|geom)
  set(flow_folders flow)
  set(dem_folders dem)
  file(GLOB_RECURSE files CONFIGURE_DEPENDS RELATIVE "${PECLET_SOURCE_DIR}/python"
       "${PECLET_SOURCE_DIR}/python/peclet/*.py" "${PECLET_SOURCE_DIR}/python/peclet/py.typed")
  foreach(module geom flow dem)
    if(NOT module IN_LIST ARGN)
      list(FILTER files EXCLUDE REGEX "^peclet/(${${module}_folders})/")
    endif()
  endforeach()
  foreach(file IN LISTS files)
    get_filename_component(parent "${CMAKE_BINARY_DIR}/${file}" DIRECTORY)
    file(MAKE_DIRECTORY "${parent}")
    file(CREATE_LINK "${PECLET_SOURCE_DIR}/python/${file}" "${CMAKE_BINARY_DIR}/${file}" COPY_ON_ERROR SYMBOLIC)
  endforeach()
endfunction()

# peclet_write_build_facts(): peclet/_build.py, what the Python side must know about the compiled code.
function(peclet_write_build_facts)
  separate_arguments(flags NATIVE_COMMAND "${CMAKE_CXX_FLAGS}")
  execute_process(
    COMMAND "${CMAKE_CXX_COMPILER}" ${flags} ${PECLET_ARCHITECTURE_FLAGS} -dM -E -x c++ /dev/null
    OUTPUT_VARIABLE macros ERROR_QUIET)
  # Names of compiler macros, without underscores, beside those of the same features in /proc/cpuinfo.
  set(features SSE4_2=sse4_2 AVX=avx AVX2=avx2 FMA=fma BMI2=bmi2 AVX512F=avx512f AVX512VL=avx512vl AVX512DQ=avx512dq
               AVX512BW=avx512bw AVX512VNNI=avx512_vnni)
  set(required)
  foreach(feature IN LISTS features)
    string(REPLACE "=" ";" feature "${feature}")
    list(GET feature 0 macro)
    list(GET feature 1 name)
    if(macros MATCHES "#define __${macro}__ ")
      list(APPEND required "\"${name}\"")
    endif()
  endforeach()
  list(JOIN required ", " required)
  set(file "${CMAKE_BINARY_DIR}/peclet/_build.py")
  file(CONFIGURE OUTPUT "${file}" CONTENT [=["""Facts about the compiled modules; written by the build."""

backend = "@PECLET_BACKEND@"
instruction_sets = frozenset([@required@])
]=] @ONLY)
  install(FILES "${file}" DESTINATION peclet)
endfunction()

# peclet_bundle_kokkos(): the Kokkos library inside the wheel, under the one name by which the modules ask for it.
function(peclet_bundle_kokkos)
  install(FILES "$<TARGET_FILE:Kokkos::kokkoscore>" DESTINATION ${PECLET_LIBRARY_FOLDER}
          RENAME "$<TARGET_SONAME_FILE_NAME:Kokkos::kokkoscore>")
endfunction()
