# nanobind from the Python that runs this build: `pip install nanobind`, or pip's build isolation.
find_package(Python 3.10 REQUIRED COMPONENTS Interpreter Development.Module)
execute_process(
  COMMAND "${Python_EXECUTABLE}" -m nanobind --cmake_dir
  OUTPUT_VARIABLE nanobind_ROOT OUTPUT_STRIP_TRAILING_WHITESPACE
  RESULT_VARIABLE nanobind_missing)
if(nanobind_missing)
  message(FATAL_ERROR "nanobind is needed: ${Python_EXECUTABLE} -m pip install nanobind")
endif()
find_package(nanobind CONFIG REQUIRED)

# peclet_add_python_module(name library package): the extension module <package>/_<name>, with its type stub.
function(peclet_add_python_module name library package)
  file(GLOB sources CONFIGURE_DEPENDS "${CMAKE_CURRENT_SOURCE_DIR}/bindings/${name}.cpp"
       "${CMAKE_CURRENT_SOURCE_DIR}/bindings/${name}_*.cpp" "${CMAKE_CURRENT_SOURCE_DIR}/bindings/runtime.cpp")
  nanobind_add_module(_${name} NB_STATIC NB_DOMAIN peclet ${sources})
  target_link_libraries(_${name} PRIVATE ${library})
  set_target_properties(_${name} PROPERTIES LIBRARY_OUTPUT_DIRECTORY "${CMAKE_BINARY_DIR}/${package}")
endfunction()
