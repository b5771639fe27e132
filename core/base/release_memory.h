#pragma once

namespace adamas::inline core {

/// Empties a vector and gives its memory back, which `vector = {}` does not: that is an assignment of no
/// elements.
template <class Vector>
void release_memory(Vector& vector) {
  Vector().swap(vector);
}

}  // namespace adamas::inline core
