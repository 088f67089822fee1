# CUDA 13 changed the arguments of three functions that Kokkos 4.5.01 calls. Both forms are kept, chosen by the
# version of the toolkit that compiles the header.
function(peclet_adapt_kokkos_to_cuda13 source)
  set(file "${source}/core/src/Cuda/Kokkos_Cuda_Instance.hpp")
  file(READ "${file}" text)
  string(
    REPLACE
      "    return cudaGraphAddDependencies(graph, from, to, numDependencies);\n"
      "#if CUDART_VERSION >= 13000
    return cudaGraphAddDependencies(graph, from, to, nullptr, numDependencies);
#else
    return cudaGraphAddDependencies(graph, from, to, numDependencies);
#endif
"
      adapted "${text}")
  string(
    REPLACE
      "    return cudaMemAdvise(devPtr, count, advice, device);\n"
      "#if CUDART_VERSION >= 13000
    return cudaMemAdvise(devPtr, count, advice, cudaMemLocation{cudaMemLocationTypeDevice, device});
#else
    return cudaMemAdvise(devPtr, count, advice, device);
#endif
"
      adapted "${adapted}")
  string(
    REPLACE
      "    return cudaMemPrefetchAsync(devPtr, count, dstDevice,
                                get_input_stream(stream));\n"
      "#if CUDART_VERSION >= 13000
    return cudaMemPrefetchAsync(devPtr, count, cudaMemLocation{cudaMemLocationTypeDevice, dstDevice}, 0,
                                get_input_stream(stream));
#else
    return cudaMemPrefetchAsync(devPtr, count, dstDevice, get_input_stream(stream));
#endif
"
      adapted "${adapted}")
  string(REGEX MATCHALL "CUDART_VERSION >= 13000" sites "${adapted}")
  list(LENGTH sites number_of_sites)
  if(NOT number_of_sites EQUAL 3)
    message(FATAL_ERROR "${file}: expected three calls to adapt to CUDA 13, found ${number_of_sites}")
  endif()
  file(WRITE "${file}" "${adapted}")
endfunction()
