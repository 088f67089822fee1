find_package(Kokkos 4.5...<6 REQUIRED)
