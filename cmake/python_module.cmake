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
                        INSTALL_RPATH "$ORIGIN/${to_root}/${PECLET_LIBRARY_FOLDER}")
  install(TARGETS _${name} LIBRARY DESTINATION ${package})

  # The stub is written by importing the module, which a machine without the GPU's driver cannot do.
  if(NOT PECLET_BACKEND STREQUAL "cuda")
    nanobind_add_stub(
      _${name}_stub MODULE _${name} PYTHON_PATH "$<TARGET_FILE_DIR:_${name}>" DEPENDS _${name}
      OUTPUT "${CMAKE_BINARY_DIR}/${package}/_${name}.pyi")
    install(FILES "${CMAKE_BINARY_DIR}/${package}/_${name}.pyi" DESTINATION ${package})
  endif()
endfunction()

# peclet_link_python_files(folders...): the Python files of python/<folder> appear in the build tree, so that it
# can be imported as it is; links, so that an edited file needs no build.
function(peclet_link_python_files)
  foreach(folder IN LISTS ARGN)
    file(GLOB_RECURSE files CONFIGURE_DEPENDS RELATIVE "${PECLET_SOURCE_DIR}/python"
         "${PECLET_SOURCE_DIR}/python/${folder}/*.py" "${PECLET_SOURCE_DIR}/python/${folder}/py.typed")
    foreach(file IN LISTS files)
      get_filename_component(parent "${CMAKE_BINARY_DIR}/${file}" DIRECTORY)
      file(MAKE_DIRECTORY "${parent}")
      file(CREATE_LINK "${PECLET_SOURCE_DIR}/python/${file}" "${CMAKE_BINARY_DIR}/${file}" COPY_ON_ERROR SYMBOLIC)
    endforeach()
  endforeach()
endfunction()
