#pragma once
// Checks at the border: every message names the argument, what was expected and what was found.
#include <cmath>
#include <sstream>
#include <stdexcept>
#include <string>

namespace peclet {

/// Throws std::invalid_argument("<argument>: expected <expected>, found <found>") unless ok.
template <class Found>
void require(bool ok, const std::string& argument, const std::string& expected, const Found& found) {
  if (ok) return;
  std::ostringstream message;
  message << argument << ": expected " << expected << ", found " << found;
  throw std::invalid_argument(message.str());
}

/// "name[n]"
inline std::string indexed(const std::string& name, long long n) {
  return name + "[" + std::to_string(n) + "]";
}

inline void require_finite(double value, const std::string& argument) {
  require(std::isfinite(value), argument, "a finite number", value);
}

inline void require_positive(double value, const std::string& argument) {
  require(std::isfinite(value) && value > 0, argument, "a positive finite number", value);
}

inline void require_non_negative(double value, const std::string& argument) {
  require(std::isfinite(value) && value >= 0, argument, "a non-negative finite number", value);
}

/// Wrong order of calls.
inline void require_state(bool ok, const std::string& message) {
  if (!ok) throw std::runtime_error(message);
}

}  // namespace peclet
