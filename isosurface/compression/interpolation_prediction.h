#pragma once

#include <algorithm>
#include <array>

#include "core/base/simd.h"
#include "isosurface/compression/interpolation_cells.h"

namespace adamas {

/// Predicts the samples of a page from those of the next coarser LOD, in three sets: points on edges by
/// cubic interpolation along them, then those on faces, then those in centres, from all round them. Loops run
/// over all cells from the first one that is wanted to the last, those between the rows that are wanted too,
/// and every step fits in a Value, so that a processor works at many cells at once.
template <class Depth>
class InterpolationPrediction {
 public:
  using Cells = InterpolationCells<Depth>;
  using Value = typename Cells::Value;

  /// Fills `values` and `activity` of the set's parities from those of the sets before, of the first `planes`
  /// of the page's 8 planes of cells.
  static void predict(int set, int planes, Cells& cells) {
    if (set == 0) return predict_all_edges(planes, cells);
    if (set == 2) return predict_centres(planes, cells);
    predict_faces<0, 1>(planes, cells);
    predict_faces<0, 2>(planes, cells);
    predict_faces<1, 2>(planes, cells);
  }

 private:
  static constexpr Value kLeast = Depth::value(0), kGreatest = Depth::value(Depth::kGreatest);
  static constexpr int kI = Cells::kStride[0], kJ = Cells::kStride[1], kK = Cells::kStride[2];

  // The cells that loops run over: the first one is (1, 1, 1). Beside the edges and faces round the page's
  // own points those that lie between are looked at, which is why each set reaches farther than the one
  // after.
  static constexpr int kFirst = kI + kJ + kK;

  static constexpr Value value(Value x) { return x; }
  template <class Wide>
  static constexpr Value value(Wide x) {
    return static_cast<Value>(x);
  }
  static constexpr Value within(Value least, Value x, Value greatest) {
    return std::min(std::max(x, least), greatest);
  }

  static void predict_all_edges(int planes, Cells& cells) {
    measure_gradient<0>(planes, cells);
    measure_gradient<1>(planes, cells);
    measure_gradient<2>(planes, cells);
    add_gradients(planes, cells);
    predict_edges<0>(planes, cells);
    predict_edges<1>(planes, cells);
    predict_edges<2>(planes, cells);
  }

  template <int kAxis>
  static void measure_gradient(int planes, Cells& cells) {
    constexpr int kStep = Cells::kStride[kAxis];
    const int end = (planes + 3) * kK - kStep;
    const Value* const p = cells.values[0].data();
    Value* const g = cells.gradients[kAxis].data();
    ADAMAS_INDEPENDENT
    for (int n = 0; n < end; ++n) {
      g[n] = value(std::max(p[n], p[n + kStep]) - std::min(p[n], p[n + kStep]));
    }
  }

  /// All steps to and from each point.
  static void add_gradients(int planes, Cells& cells) {
    const int end = (planes + 2) * kK;
    const Value *const gi = cells.gradients[0].data(), *const gj = cells.gradients[1].data(),
                       *const gk = cells.gradients[2].data();
    Value* const steps = cells.steps.data();
    ADAMAS_INDEPENDENT
    for (int n = kK; n < end; ++n) {
      steps[n] = value(gi[n] + gi[n - kI] + gj[n] + gj[n - kJ] + gk[n] + gk[n - kK]);
    }
  }

  template <int kAxis>
  static void predict_edges(int planes, Cells& cells) {
    constexpr int kStep = Cells::kStride[kAxis];
    const int end = (planes + (kAxis == 2 ? 1 : 2)) * kK;
    const Value* const p = cells.values[0].data();
    const Value *const g = cells.gradients[kAxis].data(), *const steps = cells.steps.data();
    Value *const to = cells.values[1 << kAxis].data(), *const activity = cells.activity[kAxis].data();
    ADAMAS_INDEPENDENT
    for (int n = kFirst; n < end; ++n) {
      // (9 ends - beyond + 8) / 16, rounded down, by steps that need few bits; so below.
      const Value ends = value(p[n] + p[n + kStep]), beyond = value(p[n - kStep] + p[n + 2 * kStep]);
      const Value bend = value(ends - beyond + 8), two = value(ends + (bend >> 3));
      to[n] = within(kLeast, value(two >> 1), kGreatest);
      activity[n] = value(steps[n] + steps[n + kStep] + 2 * g[n] + g[n - kStep] + g[n + kStep]);
    }
  }

  template <int kA, int kB>
  static void predict_faces(int planes, Cells& cells) {
    constexpr int kStepA = Cells::kStride[kA], kStepB = Cells::kStride[kB];
    const int end = (planes + (kB == 2 ? 0 : 1)) * kK + 9 * (kI + kJ) + 1;
    const Value* const p = cells.values[0].data();
    const Value *const ea = cells.values[1 << kA].data(), *const eb = cells.values[1 << kB].data();
    const Value *const ra = cells.residuals[1 << kA].data(), *const rb = cells.residuals[1 << kB].data();
    Value* const to = cells.values[1 << kA | 1 << kB].data();
    Value* const activity = cells.activity[kA + kB - 1].data();
    ADAMAS_INDEPENDENT
    for (int n = kFirst; n < end; ++n) {
      const Value e0 = ea[n], e1 = ea[n + kStepB], e2 = eb[n], e3 = eb[n + kStepA];
      const Value c0 = p[n], c1 = p[n + kStepA], c2 = p[n + kStepB], c3 = p[n + kStepA + kStepB];
      const Value edges = value(e0 + e1 + e2 + e3), corners = value(c0 + c1 + c2 + c3);
      const Value e_least = std::min(std::min(e0, e1), std::min(e2, e3));
      const Value e_most = std::max(std::max(e0, e1), std::max(e2, e3));
      const Value c_least = std::min(std::min(c0, c1), std::min(c2, c3));
      const Value c_most = std::max(std::max(c0, c1), std::max(c2, c3));
      // (5 edges - corners + 8) / 16.
      const Value bend = value(edges - corners + 8), four = value(edges + (bend >> 2));
      to[n] = within(std::min(e_least, c_least), value(four >> 2), std::max(e_most, c_most));
      const Value errors = value(ra[n] + ra[n + kStepB] + rb[n] + rb[n + kStepA]);
      activity[n] = value(2 * (e_most - e_least + errors) + c_most - c_least);
    }
  }

  static void predict_centres(int planes, Cells& cells) {
    const int end = planes * kK + 8 * (kI + kJ) + 1;
    const Value *const p = cells.values[0].data(), *const ei = cells.values[1].data(),
                       *const ej = cells.values[2].data(), *const ek = cells.values[4].data(),
                       *const fij = cells.values[3].data(), *const fik = cells.values[5].data(),
                       *const fjk = cells.values[6].data();
    const Value *const rij = cells.residuals[3].data(), *const rik = cells.residuals[5].data(),
                       *const rjk = cells.residuals[6].data();
    Value* const to = cells.values[7].data();
    Value* const activity = cells.activity[0].data();
    ADAMAS_INDEPENDENT
    for (int n = kFirst; n < end; ++n) {
      const Value f0 = fjk[n], f1 = fjk[n + kI], f2 = fik[n], f3 = fik[n + kJ], f4 = fij[n], f5 = fij[n + kK];
      const Value least = std::min(std::min(std::min(f0, f1), std::min(f2, f3)), std::min(f4, f5));
      const Value most = std::max(std::max(std::max(f0, f1), std::max(f2, f3)), std::max(f4, f5));
      const Value faces = value(f0 + f1 + f2 + f3 + f4 + f5);
      const Value edges =
          value(ei[n] + ei[n + kJ] + ei[n + kK] + ei[n + kJ + kK] + ej[n] + ej[n + kI] + ej[n + kK] +
                ej[n + kI + kK] + ek[n] + ek[n + kI] + ek[n + kJ] + ek[n + kI + kJ]);
      const Value corners = value(p[n] + p[n + kI] + p[n + kJ] + p[n + kK] + p[n + kI + kJ] + p[n + kI + kK] +
                                  p[n + kJ + kK] + p[n + kI + kJ + kK]);
      // (8 faces - 2 edges + corners + 16) / 32.
      const Value bend = value((corners >> 1) - edges + 8), four = value(faces + (bend >> 2));
      to[n] = within(least, value(four >> 2), most);
      const Value errors = value(rjk[n] + rjk[n + kI] + rik[n] + rik[n + kJ] + rij[n] + rij[n + kK]);
      activity[n] = value(2 * (most - least + errors));
    }
  }
};

}  // namespace adamas
