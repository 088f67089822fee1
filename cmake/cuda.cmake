# The CUDA toolkit, the GPU to compile for and, on a machine without the driver, something to link against.
include_guard(GLOBAL)

if(NOT PECLET_CUDA_ARCH)
  # Names by which Kokkos calls compute capabilities.
  set(names 7.0=VOLTA70 7.5=TURING75 8.0=AMPERE80 8.6=AMPERE86 8.9=ADA89 9.0=HOPPER90)
  execute_process(
    COMMAND nvidia-smi --query-gpu=compute_cap --format=csv,noheader
    OUTPUT_VARIABLE capability OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE no_gpu)
  string(REGEX MATCH "^[0-9.]+" capability "${capability}")
  if(NOT no_gpu AND "${names}" MATCHES "${capability}=([A-Z0-9]+)")
    set(PECLET_CUDA_ARCH ${CMAKE_MATCH_1} CACHE STRING "" FORCE)
  else()
    message(FATAL_ERROR "PECLET_CUDA_ARCH: expected the Kokkos name of the GPU to compile for (VOLTA70, TURING75, "
                        "AMPERE80, AMPERE86, ADA89, HOPPER90), found none, and no GPU to ask")
  endif()
endif()

# The driver library comes with the driver. Without it, a library of the same name with the few functions that
# Kokkos calls makes linking possible; as it lacks the name libcuda.so.1, no program ever loads it.
find_package(CUDAToolkit QUIET)
if(NOT CUDAToolkit_FOUND)
  message(FATAL_ERROR "PECLET_BACKEND=cuda: expected the CUDA toolkit, with nvcc on the PATH or in CUDAToolkit_ROOT, "
                      "found none")
endif()
if(NOT CUDA_cuda_driver_LIBRARY)
  set(folder "${PECLET_CACHE_DIR}/cuda-driver-for-linking")
  set(source "${folder}/driver.c")
  file(WRITE "${source}" "int cuStreamGetCtx(void) { return 3; }\n"
                         "int cuCtxPushCurrent_v2(void) { return 3; }\n"
                         "int cuCtxGetDevice(void) { return 3; }\n")
  execute_process(
    COMMAND "${CMAKE_CXX_COMPILER}" -x c -shared -fPIC -Wl,-soname,libcuda.so.1 -o "${folder}/libcuda.so" "${source}"
    COMMAND_ERROR_IS_FATAL ANY)
  set(CUDA_cuda_driver_LIBRARY "${folder}/libcuda.so" CACHE FILEPATH "" FORCE)
  message(STATUS "CUDA: no driver on this machine; linking against ${CUDA_cuda_driver_LIBRARY}")
endif()
message(STATUS "CUDA: toolkit ${CUDAToolkit_VERSION} in ${CUDAToolkit_BIN_DIR}, compiling for ${PECLET_CUDA_ARCH}")
