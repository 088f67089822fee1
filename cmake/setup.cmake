# Everything that the libraries share. The root includes it once; core/, flow/ and dem/ include it
# themselves when they are configured alone.
include_guard(GLOBAL)

get_filename_component(PECLET_SOURCE_DIR "${CMAKE_CURRENT_LIST_DIR}/.." ABSOLUTE)
list(PREPEND CMAKE_MODULE_PATH "${CMAKE_CURRENT_LIST_DIR}")

include(options)
include(kokkos)
include(library)
