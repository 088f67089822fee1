#pragma once
#include <string>

#include "core/types.hpp"

namespace peclet::dem {

/// Room for count entries, contents lost; some in reserve, so that a slowly growing number rarely allocates.
template <class T>
void make_room(Array<T>& array, const std::string& name, Index count) {
  if (static_cast<Index>(array.extent(0)) < count)
    array = Array<T>(name, static_cast<std::size_t>(count + count / 4));
}

}  // namespace peclet::dem
