# What a user may choose, and the compiler flags that follow from it.

# The environment variable of the same name is the default, so that `pip install` can be told too.
set(backend_default openmp)
if(DEFINED ENV{PECLET_BACKEND})
  set(backend_default "$ENV{PECLET_BACKEND}")
endif()
set(PECLET_BACKEND "${backend_default}" CACHE STRING "Where kernels run: openmp, serial or cuda")
set_property(CACHE PECLET_BACKEND PROPERTY STRINGS openmp serial cuda)
if(NOT PECLET_BACKEND MATCHES "^(openmp|serial|cuda)$")
  message(FATAL_ERROR "PECLET_BACKEND: expected openmp, serial or cuda, found '${PECLET_BACKEND}'")
endif()

option(PECLET_NATIVE "Use every instruction of this machine (OFF: a portable set, for wheels)" ON)
option(PECLET_WERROR "Show all warnings of our own code and treat them as errors" OFF)
option(PECLET_PYTHON "Build the Python modules" ON)
option(PECLET_TESTS "Build the C++ unit tests" OFF)
option(PECLET_DEVICE_LOOPS "Give loops on the host the form that a GPU gives them, to test it without one" OFF)

if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "" FORCE)
endif()
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_CXX_VISIBILITY_PRESET hidden)
set(CMAKE_VISIBILITY_INLINES_HIDDEN ON)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)

include(CheckCXXCompilerFlag)

# Instruction set. The portable one is x86-64-v3 (AVX2 and FMA: Intel since 2013, AMD since 2015).
if(PECLET_NATIVE)
  set(PECLET_ARCHITECTURE_FLAGS -march=native)
elseif(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
  set(PECLET_ARCHITECTURE_FLAGS -march=x86-64-v3)
else()
  set(PECLET_ARCHITECTURE_FLAGS)
endif()

# With AVX-512, vectors of one length: where the compiler mixes two, loads wait for stores.
check_cxx_compiler_flag(-mprefer-vector-width=256 PECLET_HAS_VECTOR_WIDTH)
set(PECLET_SWEEP_FLAGS)
if(PECLET_HAS_VECTOR_WIDTH)
  set(PECLET_SWEEP_FLAGS -mprefer-vector-width=256)
endif()

add_library(peclet_options INTERFACE)
# Contraction to fused multiply-add is allowed, reordering and assuming finite values are not.
target_compile_options(
  peclet_options INTERFACE ${PECLET_ARCHITECTURE_FLAGS} -ffp-contract=fast
                           -fno-math-errno -fno-trapping-math)
if(PECLET_WERROR)
  target_compile_options(peclet_options INTERFACE -Wall -Wextra -Wconversion -Werror)
endif()
if(PECLET_DEVICE_LOOPS)
  target_compile_definitions(peclet_options INTERFACE PECLET_DEVICE_LOOPS)
endif()
target_include_directories(peclet_options INTERFACE "${PECLET_SOURCE_DIR}")
