# peclet_add_library(name DEPENDS targets...): one of the three C++ libraries, from the .cpp files beside
# the calling CMakeLists.txt.
function(peclet_add_library name)
  cmake_parse_arguments(PARSE_ARGV 1 library "" "" "DEPENDS")
  file(GLOB sources CONFIGURE_DEPENDS "${CMAKE_CURRENT_SOURCE_DIR}/*.cpp")
  if(sources)
    add_library(${name} STATIC ${sources})
    target_link_libraries(${name} PUBLIC Kokkos::kokkoscore peclet_options ${library_DEPENDS})
  else()
    add_library(${name} INTERFACE)
    target_link_libraries(${name} INTERFACE Kokkos::kokkoscore peclet_options ${library_DEPENDS})
  endif()
endfunction()
