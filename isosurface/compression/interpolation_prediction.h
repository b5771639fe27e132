#pragma once

#include <algorithm>
#include <limits>

#include "isosurface/compression/interpolation_cells.h"

namespace adamas {

/// Predicts the samples of a page from those of the next coarser level, in three sets: points on edges by
/// cubic interpolation along them, then those on faces, then those in centres, from all round them. Loops run
/// over whole planes of cells, those between the rows that are wanted too: no work is as cheap as work
/// without branches.
template <class Word>
class InterpolationPrediction {
 public:
  using Cells = InterpolationCells<Word>;
  using Value = typename Cells::Value;

  /// Fills `values` and `activity` of the set's parities from those of the sets before.
  void predict(int set, Cells& cells) {
    if (set == 0) {
      measure_gradients(cells);
      for (int axis = 0; axis < 3; ++axis) predict_edges(axis, cells);
    } else if (set == 1) {
      predict_faces(0, 1, cells.activity[0], cells);
      predict_faces(0, 2, cells.activity[1], cells);
      predict_faces(1, 2, cells.activity[2], cells);
    } else {
      predict_centres(cells);
    }
  }

 private:
  static constexpr Value kGreatest = std::numeric_limits<Word>::max();

  static constexpr Value within(Value least, Value value, Value greatest) {
    return std::min(std::max(value, least), greatest);
  }
  static constexpr int stride(int axis) { return Cells::kStride[static_cast<std::size_t>(axis)]; }
  static constexpr std::size_t parity(int a) { return std::size_t{1} << a; }

  /// f for the cell (1, 1) and the last one of every plane of cells from place 1 on. Faces look at edges up
  /// to 12 cells further on, and centres at faces and edges: what they take is always defined.
  template <class F>
  static void for_each_plane(bool odd_along_k, int last, F&& f) {
    for (int k = 1; k <= (odd_along_k ? 8 : 9); ++k) f(k * Cells::kPlane + 12, k * Cells::kPlane + last);
  }
  static constexpr int kLastOfEdges = 120, kLastOfFaces = 9 * 12, kLastOfCentres = 8 * 12;

  void measure_gradients(const Cells& cells) {
    const Value* const p = cells.values[0].data();
    for (int axis = 0; axis < 3; ++axis) {
      Value* const g = gradient_[static_cast<std::size_t>(axis)].data();
      const int step = stride(axis);
      for (int n = 0; n < Cells::kCells - step; ++n) {
        g[n] = static_cast<Value>(std::max(p[n], p[n + step]) - std::min(p[n], p[n + step]));
      }
    }
    const Value *const gi = gradient_[0].data(), *const gj = gradient_[1].data(),
                       *const gk = gradient_[2].data();
    constexpr int kRow = stride(1), kPlane = Cells::kPlane;
    Value* const around = around_.data();
    for (int n = kPlane; n < Cells::kCells - kPlane; ++n) {
      around[n] = static_cast<Value>(gi[n] + gi[n - 1] + gj[n] + gj[n - kRow] + gk[n] + gk[n - kPlane]);
    }
  }

  void predict_edges(int axis, Cells& cells) const {
    const int step = stride(axis);
    const Value* const p = cells.values[0].data();
    const Value* const g = gradient_[static_cast<std::size_t>(axis)].data();
    const Value* const around = around_.data();
    Value* const to = cells.values[parity(axis)].data();
    Value* const activity = cells.activity[static_cast<std::size_t>(axis)].data();
    for_each_plane(axis == 2, kLastOfEdges, [=](int first, int last) {
      for (int n = first; n <= last; ++n) {
        const Value inner = static_cast<Value>(p[n] + p[n + step]);
        const Value outer = static_cast<Value>(p[n - step] + p[n + 2 * step]);
        to[n] = within(0, static_cast<Value>((9 * inner - outer + 8) >> 4), kGreatest);
        activity[n] = static_cast<Value>(around[n] + around[n + step] + 2 * g[n] + g[n - step] + g[n + step]);
      }
    });
  }

  static void predict_faces(int a, int b, typename Cells::Cells& activities, Cells& cells) {
    const int sa = stride(a), sb = stride(b);
    const Value* const p = cells.values[0].data();
    const Value *const ea = cells.values[parity(a)].data(), *const eb = cells.values[parity(b)].data();
    const Value *const ra = cells.residuals[parity(a)].data(), *const rb = cells.residuals[parity(b)].data();
    Value* const to = cells.values[parity(a) | parity(b)].data();
    Value* const activity = activities.data();
    for_each_plane(b == 2, kLastOfFaces, [=](int first, int last) {
      for (int n = first; n <= last; ++n) {
        const Value e0 = ea[n], e1 = ea[n + sb], e2 = eb[n], e3 = eb[n + sa];
        const Value c0 = p[n], c1 = p[n + sa], c2 = p[n + sb], c3 = p[n + sa + sb];
        const Value edges = static_cast<Value>(e0 + e1 + e2 + e3);
        const Value corners = static_cast<Value>(c0 + c1 + c2 + c3);
        const Value e_least = std::min(std::min(e0, e1), std::min(e2, e3));
        const Value e_most = std::max(std::max(e0, e1), std::max(e2, e3));
        const Value c_least = std::min(std::min(c0, c1), std::min(c2, c3));
        const Value c_most = std::max(std::max(c0, c1), std::max(c2, c3));
        to[n] = within(std::min(e_least, c_least), static_cast<Value>((5 * edges - corners + 8) >> 4),
                       std::max(e_most, c_most));
        const Value errors = static_cast<Value>(ra[n] + ra[n + sb] + rb[n] + rb[n + sa]);
        activity[n] = static_cast<Value>(2 * (e_most - e_least) + (c_most - c_least) + 2 * errors);
      }
    });
  }

  static void predict_centres(Cells& cells) {
    constexpr int kI = stride(0), kJ = stride(1), kK = stride(2);
    const Value *const p = cells.values[0].data(), *const ei = cells.values[1].data(),
                       *const ej = cells.values[2].data(), *const ek = cells.values[4].data(),
                       *const fij = cells.values[3].data(), *const fik = cells.values[5].data(),
                       *const fjk = cells.values[6].data();
    const Value *const rij = cells.residuals[3].data(), *const rik = cells.residuals[5].data(),
                       *const rjk = cells.residuals[6].data();
    Value* const to = cells.values[7].data();
    Value* const activity = cells.activity[0].data();
    for_each_plane(true, kLastOfCentres, [=](int first, int last) {
      for (int n = first; n <= last; ++n) {
        const Value f0 = fjk[n], f1 = fjk[n + kI], f2 = fik[n], f3 = fik[n + kJ], f4 = fij[n],
                    f5 = fij[n + kK];
        const Value least = std::min(std::min(std::min(f0, f1), std::min(f2, f3)), std::min(f4, f5));
        const Value most = std::max(std::max(std::max(f0, f1), std::max(f2, f3)), std::max(f4, f5));
        const Value faces = static_cast<Value>(f0 + f1 + f2 + f3 + f4 + f5);
        const Value edges = static_cast<Value>(ei[n] + ei[n + kJ] + ei[n + kK] + ei[n + kJ + kK] + ej[n] +
                                               ej[n + kI] + ej[n + kK] + ej[n + kI + kK] + ek[n] +
                                               ek[n + kI] + ek[n + kJ] + ek[n + kI + kJ]);
        const Value corners = static_cast<Value>(p[n] + p[n + kI] + p[n + kJ] + p[n + kK] + p[n + kI + kJ] +
                                                 p[n + kI + kK] + p[n + kJ + kK] + p[n + kI + kJ + kK]);
        to[n] = within(least, static_cast<Value>((8 * faces - 2 * edges + corners + 16) >> 5), most);
        const Value errors =
            static_cast<Value>(rjk[n] + rjk[n + kI] + rik[n] + rik[n + kJ] + rij[n] + rij[n + kK]);
        activity[n] = static_cast<Value>(2 * (most - least) + 2 * errors);
      }
    });
  }

  std::array<typename Cells::Cells, 3> gradient_;
  typename Cells::Cells around_;
};

}  // namespace adamas
