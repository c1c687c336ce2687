#pragma once

#include <compare>

namespace biotomy::bridge {

/// A length or an absolute axis position in micrometres.
struct Micrometres {
  double value = 0.0;

  friend auto operator<=>(Micrometres, Micrometres) = default;
  friend Micrometres operator+(Micrometres a, Micrometres b) { return {a.value + b.value}; }
  friend Micrometres operator-(Micrometres a, Micrometres b) { return {a.value - b.value}; }
  friend Micrometres operator*(double factor, Micrometres a) { return {factor * a.value}; }
};

}  // namespace biotomy::bridge
