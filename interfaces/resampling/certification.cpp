#include "interfaces/resampling/resampler.h"

namespace adamas {

void Resampler::certify() {}

}  // namespace adamas
